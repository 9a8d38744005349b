// What users of a tracker expect of it, whichever filter is chosen: scans of a vehicle's radars in, track lists out.
#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "tests/unit/tracker/any_tracker.hpp"

namespace boresight::tracking {
namespace {

TEST_P(AnyTracker, ObjectIsConfirmedWithinHalfASecond) {
  drive(kCarAhead, 10);
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  const Track& track = list_->tracks[0];
  EXPECT_EQ(track.status, TrackStatus::kConfirmed);
  EXPECT_EQ(track.update, TrackUpdate::kMeasured);
  EXPECT_EQ(track.movement, MovementState::kMoving);
  EXPECT_EQ(track.number_of_detections, 3u);
  EXPECT_GT(track.tracking_id, 0u);
  EXPECT_GT(track.existence_probability, 0.9F);
}

TEST_P(AnyTracker, LoneDetectionIsNeverConfirmedAndIsGivenUp) {
  step(kCarAhead, 1);
  EXPECT_EQ(list().number_of_confirmed_tracks, 0u);
  for (int i = 0; i < 10; ++i) {
    step_empty();
    EXPECT_EQ(list().number_of_confirmed_tracks, 0u);
  }
  EXPECT_EQ(list().number_of_tracks, 0u);
}

TEST_P(AnyTracker, ConfirmedTracksComeFirst) {
  Moving car = drive(kCarAhead, 20);
  car = car.after(kScan_s);
  scene_.begin(now_);
  scene_.add({20.0, 10.0}, {-6.0, -6.0});  // one detection of something new
  add(car);
  take();
  const TrackList& tracks = list();
  for (std::uint32_t i = 0; i < tracks.number_of_tracks; ++i) {
    EXPECT_EQ(tracks.tracks[i].status == TrackStatus::kConfirmed, i < tracks.number_of_confirmed_tracks);
  }
}

TEST_P(AnyTracker, VehiclesThatPassEachOtherKeepTheirIdentities) {
  expect_two_identities({{25.0, 0.0}, {12.0, 0.0}}, {{95.0, 3.4}, {-14.0, 0.0}}, 80);
}

TEST_P(AnyTracker, CrossingObjectsKeepTheirIdentities) {
  expect_two_identities({{20.0, 12.0}, {8.0, -5.0}}, {{60.0, -3.0}, {-9.0, 0.0}}, 90);
}

TEST_P(AnyTracker, PeopleWhoComeTogetherAndWalkAbreastKeepTheirIdentities) {
  std::map<int, std::set<std::uint32_t>> ids;
  const auto place_m = [](int k, int side) {
    return Eigen::Vector2d(12.0 + 1.4 * kScan_s * k, side * std::max(0.8, 2.5 - 0.6 * kScan_s * k));
  };
  int two = 0;
  for (int k = 0; k < 120; ++k) {
    scene_.begin(now_);
    for (const int side : {-1, 1}) {
      add({place_m(k, side), (place_m(k + 1, side) - place_m(k, side)) / kScan_s, 0.4, 0.4}, 1.0, 2);
    }
    take();
    if (k < 20) continue;
    two += list().number_of_confirmed_tracks == 2 ? 1 : 0;
    for (const int side : {-1, 1}) {
      const Track* track = nearest(place_m(k, side));
      if (track != nullptr) ids[side].insert(track->tracking_id);
    }
  }
  EXPECT_GT(two, 95) << "of 100 scans";
  EXPECT_EQ(ids[-1].size(), 1u);
  EXPECT_EQ(ids[1].size(), 1u);
  EXPECT_NE(ids[-1], ids[1]);
}

TEST_P(AnyTracker, EstimatesPlaceVelocityAndHeading) {
  const Moving car = drive({{20.0, 8.0}, {9.0, -2.0}, 4.5, 1.8}, 60);
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  const Track& track = list_->tracks[0];
  EXPECT_NEAR(track.velocity_over_ground_mps[0], car.velocity_mps.x(), 0.5);
  EXPECT_NEAR(track.velocity_over_ground_mps[1], car.velocity_mps.y(), 1.0);
  EXPECT_NEAR(track.heading_rad, std::atan2(-2.0, 9.0), 0.15);
  EXPECT_NEAR(track.age_s, 59 * kScan_s, 1e-3);
  // Detections lie anywhere in the object here, but on the visible sides in the reflection model: its centre lies
  // behind them.
  EXPECT_NEAR(track.position_vehicle_m[0], car.position_m.x(), 2.3);
  EXPECT_NEAR(track.position_vehicle_m[1], car.position_m.y(), 1.0);
}

TEST_P(AnyTracker, VelocityOverGroundTurnsWithTheVehicle) {
  // The own vehicle turns left by 0.2 rad/s at 10 m/s; an object drives straight on.
  constexpr double kSpeed_mps = 10.0, kYawRate_radps = 0.2;
  const Moving in_world{{30.0, 0.0}, {12.0, 3.0}};
  std::set<std::uint32_t> ids;
  Eigen::Vector2d place_m, velocity_mps;
  for (int i = 0; i < 40; ++i) {
    const double t = kScan_s * i, yaw_rad = kYawRate_radps * t, radius_m = kSpeed_mps / kYawRate_radps;
    const Eigen::Vector2d ego_m(radius_m * std::sin(yaw_rad), radius_m * (1.0 - std::cos(yaw_rad)));
    const Eigen::Rotation2Dd to_vehicle(-yaw_rad);
    place_m = to_vehicle * (in_world.after(t).position_m - ego_m);
    velocity_mps = to_vehicle * in_world.velocity_mps;
    scene_.begin(now_, 1, kSpeed_mps, kYawRate_radps);
    add({place_m, velocity_mps});
    take();
    if (i < 20) continue;
    ASSERT_EQ(list().number_of_confirmed_tracks, 1u) << i;
    ids.insert(list_->tracks[0].tracking_id);
  }
  EXPECT_EQ(ids.size(), 1u);
  const Track& track = list_->tracks[0];
  EXPECT_NEAR(track.velocity_over_ground_mps[0], velocity_mps.x(), 0.6);
  EXPECT_NEAR(track.velocity_over_ground_mps[1], velocity_mps.y(), 1.2);
  EXPECT_NEAR(track.heading_rad, std::atan2(velocity_mps.y(), velocity_mps.x()), 0.15);
}

TEST_P(AnyTracker, OutputHasNothingOfTheMemoryThatItIsWrittenTo) {
  drive(kCarAhead, 10);
  ASSERT_GE(list().number_of_tracks, 1u);
  EXPECT_LE(list_->number_of_tracks, kMaxTracks);
  EXPECT_EQ(list_->dropped_tracks, 0u);
  EXPECT_EQ(list_->flags, 0u);
  EXPECT_EQ(list_->tracker_flags, 0u);
  EXPECT_GT(list_->likelihood_evaluations, 0u);
  EXPECT_LT(list_->likelihood_evaluations, 10'000u);
  for (std::uint32_t i = 0; i < list_->number_of_tracks; ++i) {
    const Track& t = list_->tracks[i];
    EXPECT_TRUE(std::isfinite(t.time_since_update_s + t.age_s + t.height_m + t.position_vehicle_m[2]));
    EXPECT_LT(t.flags, 2 * track_flag::kMerged);
    EXPECT_GE(t.mirror_probability, 0.0F);
    EXPECT_LE(t.mirror_probability, 1.0F);
    float sum = 0.0F;
    for (const float probability : t.class_probability) sum += probability;
    EXPECT_NEAR(sum, 1.0F, 1e-5F);
    EXPECT_EQ(t.class_probability[static_cast<std::size_t>(t.object_class)],
              *std::max_element(t.class_probability.begin(), t.class_probability.end()));
    const Eigen::Map<const Eigen::Matrix<float, kTrackStateSize, kTrackStateSize>> covariance(t.covariance.data());
    EXPECT_TRUE(covariance.allFinite());
    EXPECT_GT(covariance.diagonal().minCoeff(), 0.0F);
    EXPECT_EQ(covariance, covariance.transpose());
    EXPECT_GT(covariance.cast<double>().selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-6);
  }
}

TEST_P(AnyTracker, ObjectThatIsGoneIsPredictedAndThenDropped) {
  drive(kCarAhead, 20);
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  step_empty();
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u) << "one scan without it is no proof";
  EXPECT_EQ(list_->tracks[0].update, TrackUpdate::kPredicted);
  EXPECT_EQ(list_->tracks[0].number_of_detections, 0u);
  EXPECT_NEAR(list_->tracks[0].time_since_update_s, kScan_s, 1e-3);
  for (int i = 0; i < 20; ++i) step_empty();
  EXPECT_EQ(list().number_of_tracks, 0u) << "after a second";
}

TEST_P(AnyTracker, ScansOfRadarsThatDoNotSeeItDoNotCount) {
  drive({{30.0, -10.0}, {8.0, 0.0}}, 20);
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  const auto existence = list_->tracks[0].existence_probability;
  // Radar 2 looks to the left.
  for (int i = 0; i < 10; ++i) step_empty(2);
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  EXPECT_GT(list_->tracks[0].existence_probability, existence - 0.2F);
  EXPECT_EQ(list_->tracks[0].update, TrackUpdate::kPredicted);
}

TEST_P(AnyTracker, ScanOfARadarThatIsNotOfTheVehicleChangesNothing) {
  drive(kCarAhead, 20);
  const std::uint32_t id = list().tracks[0].tracking_id;
  scene_.begin(now_, 9);
  add({{30.0, 20.0}, {5.0, 5.0}});
  take();
  ASSERT_EQ(list().number_of_tracks, 1u);
  EXPECT_EQ(list_->tracks[0].tracking_id, id);
}

TEST_P(AnyTracker, RadarsOutOfStepShareOneTrackThatIsAsOldAsItIs) {
  // Both radars see it ahead on the left. The second scan of each pair comes 5 ms late.
  const Moving car{{15.0, 9.0}, {5.0, 4.0}};
  const std::int64_t start_ns = now_;
  for (int i = 0; i < 40; ++i) {
    for (const auto& [radar, offset_ms] : {std::pair{1u, 17}, std::pair{2u, 12}}) {
      scene_.begin(start_ns + (i * kScan_ms + offset_ms) * kMillisecond, radar);
      add(car.after(kScan_s * i + 1e-3 * offset_ms));
      const StepResult result = tracker_->step(*scene_.scan);
      EXPECT_EQ(result.out_of_order, radar == 2u);
      EXPECT_FALSE(result.restarted);
    }
  }
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  EXPECT_NEAR(list_->tracks[0].velocity_over_ground_mps[0], 5.0, 0.7);
  EXPECT_NEAR(list_->tracks[0].velocity_over_ground_mps[1], 4.0, 0.7);
  EXPECT_NEAR(list_->tracks[0].age_s, 39 * kScan_s, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Trackers, AnyTracker, testing::ValuesIn(tracker_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace boresight::tracking
