#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/ghost_filter/core/published/filter.hpp"

namespace boresight::ghosts::published {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

/// A vehicle that stands at the origin beside a guard rail 7 m to its right.
class PublishedMethod : public testing::Test {
 protected:
  PublishedMethod() {
    std::memset(static_cast<void*>(out_.get()), 0xCD, sizeof(ClassifiedScan));
    std::memset(static_cast<void*>(scan_.get()), 0, sizeof(CorrectedScan));
    std::memset(static_cast<void*>(tracks_.get()), 0, sizeof(TrackList));
    begin();
  }
  void begin(double speed_mps = 0.0) {
    scan_->header.source_id = 1;
    scan_->header.measurement_time_ns = now_;
    scan_->number_of_valid_detections = 0;
    scan_->geometry.sensor_position_vehicle_m = {3.6F, 0.0F, 0.5F};
    scan_->geometry.ego_speed_mps = static_cast<float>(speed_mps);
  }
  std::uint32_t add(double x, double y, std::uint16_t flags, double range_rate = 0.0) {
    const std::uint32_t i = scan_->number_of_valid_detections++;
    scan_->x_vehicle_m[i] = static_cast<float>(x);
    scan_->y_vehicle_m[i] = static_cast<float>(y);
    scan_->range_m[i] = static_cast<float>(std::hypot(x - 3.6, y));
    scan_->range_rate_over_ground_mps[i] = static_cast<float>(range_rate);
    const double ahead = (x - 3.6) / std::hypot(x - 3.6, y);
    scan_->range_rate_mps[i] = static_cast<float>(range_rate - scan_->geometry.ego_speed_mps * ahead);
    scan_->detection_flags[i] = flags;
    return i;
  }
  /// Reflections of a rail along y = `y` from x = 5 to 60.
  void add_rail(double y = -7.0) {
    std::normal_distribution<double> noise(0.0, 0.05);
    for (double x = 5.0; x <= 60.0; x += 1.5) add(x, y + noise(random_), corrected_flag::kStationary);
  }
  void classify() {
    filter_.classify(*scan_, *out_);
    now_ += 50 * kMillisecond;
  }
  /// A confirmed track of a car.
  void add_track(double x, double y, double vx = 10.0, double vy = 0.0) {
    tracks_->header.measurement_time_ns = now_;
    Track& t = tracks_->tracks[tracks_->number_of_tracks++];
    t.status = TrackStatus::kConfirmed;
    t.position_vehicle_m = {static_cast<float>(x), static_cast<float>(y), 0.5F};
    t.velocity_over_ground_mps = {static_cast<float>(vx), static_cast<float>(vy)};
    t.length_m = 4.5F;
    t.width_m = 1.8F;
    filter_.add_tracks(*tracks_);
  }

  Filter filter_{Config{}};
  std::mt19937 random_{1};
  std::unique_ptr<CorrectedScan> scan_ = std::make_unique<CorrectedScan>();
  std::unique_ptr<ClassifiedScan> out_ = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  std::int64_t now_ = 1'000'000 * kMillisecond;
};

TEST_F(PublishedMethod, ARailBecomesASegmentAtItsPlace) {
  add_rail();
  classify();
  ASSERT_GE(out_->number_of_reflector_segments, 1u);
  double begin = 1e9, end = -1e9;
  for (std::size_t i = 0; i < out_->number_of_reflector_segments; ++i) {
    const ReflectorSegment& s = out_->reflector_segments[i];
    EXPECT_NEAR(s.start_vehicle_m[1], -7.0, 0.15);
    EXPECT_NEAR(s.end_vehicle_m[1], -7.0, 0.15);
    EXPECT_LT(s.residual_std_m, 0.15);
    begin = std::min({begin, static_cast<double>(s.start_vehicle_m[0]), static_cast<double>(s.end_vehicle_m[0])});
    end = std::max({end, static_cast<double>(s.start_vehicle_m[0]), static_cast<double>(s.end_vehicle_m[0])});
  }
  EXPECT_NEAR(begin, 5.0, 1.0);
  EXPECT_NEAR(end, 60.0, 1.0);
}

TEST_F(PublishedMethod, ACurvedRailIsFollowedByPieces) {
  for (double a = 0.0; a < 0.4; a += 0.004) {
    add(150.0 * std::sin(a), -7.0 - 150.0 * (1.0 - std::cos(a)), corrected_flag::kStationary);
  }
  classify();
  EXPECT_GE(out_->number_of_reflector_segments, 2u);
  for (std::size_t i = 0; i < out_->number_of_reflector_segments; ++i) {
    for (const auto& end : {out_->reflector_segments[i].start_vehicle_m, out_->reflector_segments[i].end_vehicle_m}) {
      EXPECT_NEAR(std::hypot(end[0], end[1] + 157.0), 150.0, 1.0);
    }
  }
}

TEST_F(PublishedMethod, BehindARailIsAType2Ghost) {
  add_rail();
  const auto ghost = add(30.0, -14.0, corrected_flag::kMoving, 8.0);
  const auto in_front = add(30.0, -3.5, corrected_flag::kMoving, 8.0);
  const auto beyond_its_end = add(110.0, -14.0, corrected_flag::kMoving, 8.0);
  classify();
  EXPECT_EQ(out_->provenance[ghost], Provenance::kGhostType2);
  EXPECT_GT(out_->ghost_probability(ghost), 0.5F);
  EXPECT_EQ(out_->provenance[in_front], Provenance::kMoving);
  EXPECT_LT(out_->ghost_probability(in_front), 0.5F);
  for (std::uint32_t i = 0; i < out_->number_of_valid_detections; ++i) {
    float sum = 0.0F;
    for (const Provenance origin : kOrigins) sum += out_->probability(origin, i);
    EXPECT_NEAR(sum, 1.0F, 1e-6F);
    EXPECT_GE(out_->probability(out_->provenance[i], i), 0.9F) << "the method has labels only";
  }
  // The line of sight to it crosses y = −7 at x ≈ 57: still the rail.
  EXPECT_EQ(out_->provenance[beyond_its_end], Provenance::kGhostType2);
  EXPECT_EQ(out_->provenance[0], Provenance::kStationary);
}

TEST_F(PublishedMethod, WhatStandsIsToldByAConstantWhateverTheCorrectorSays) {
  begin(20.0);
  const auto slow = add(30.0, 3.0, corrected_flag::kMoving, 1.9);
  const auto fast = add(30.0, -3.0, corrected_flag::kStationary, -2.1);
  const auto not_a_number = add(40.0, 3.0, corrected_flag::kStationary, std::numeric_limits<double>::quiet_NaN());
  classify();
  EXPECT_EQ(out_->provenance[slow], Provenance::kStationary);
  EXPECT_EQ(out_->provenance[fast], Provenance::kMoving);
  EXPECT_EQ(out_->provenance[not_a_number], Provenance::kMoving);
}

TEST_F(PublishedMethod, AbeamWhatStandsIsNotToldFromWhatMoves) {
  // A standing thing whose range rate is 1.6 m/s as the vehicle passes, and one at 2.4 m/s.
  begin(20.0);
  const auto abeam = add(3.6 + 0.8, 10.0, corrected_flag::kStationary);
  const auto ahead = add(3.6 + 1.2, 10.0, corrected_flag::kStationary);
  classify();
  EXPECT_EQ(out_->provenance[abeam], Provenance::kMoving);
  EXPECT_EQ(out_->provenance[ahead], Provenance::kStationary);
  // At walking pace the sector does not grow to the whole view.
  begin(1.5);
  const auto same = add(3.6 + 2.0, 10.0, corrected_flag::kStationary);
  classify();
  EXPECT_EQ(out_->provenance[same], Provenance::kStationary);
}

TEST_F(PublishedMethod, ThroughAGapInTheRailOneSeesWhatIsThere) {
  for (double x = 5.0; x <= 60.0; x += 1.0) {
    if (x < 15.0 || x > 30.0) add(x, -7.0, corrected_flag::kStationary);
  }
  const auto through = add(35.0, -14.0, corrected_flag::kMoving, 8.0);  // crosses y = −7 at x = 19.3
  classify();
  EXPECT_EQ(out_->provenance[through], Provenance::kMoving);
}

TEST_F(PublishedMethod, FartherAlongTheLineToATrackIsAType1Ghost) {
  add_track(25.0, 2.0);
  const Eigen::Vector2d sensor(3.6, 0.0), target(25.0, 2.0);
  const Eigen::Vector2d behind = sensor + 1.6 * (target - sensor);
  const auto ghost = add(behind.x(), behind.y(), corrected_flag::kMoving, 14.0);
  const auto itself = add(24.0, 2.2, corrected_flag::kMoving, 9.0);
  const auto beside = add(behind.x(), behind.y() + 8.0, corrected_flag::kMoving, 9.0);
  classify();
  EXPECT_EQ(out_->provenance[ghost], Provenance::kGhostType1);
  EXPECT_EQ(out_->provenance[itself], Provenance::kMoving);
  EXPECT_EQ(out_->provenance[beside], Provenance::kMoving);
  EXPECT_EQ(out_->flags & (pipeline_flag::kNoTracks | pipeline_flag::kTracksStale), 0u);
}

TEST_F(PublishedMethod, EvenWhatIsTrackedBehindARailIsTakenForAGhost) {
  // Le Ba Thanh's test asks for nothing but the crossing: the baseline must not be better than what was published.
  add_rail();
  add_track(30.0, -12.0);
  const auto real = add(30.5, -12.2, corrected_flag::kMoving, 8.0);
  classify();
  EXPECT_EQ(out_->provenance[real], Provenance::kGhostType2);
}

TEST_F(PublishedMethod, TracksArePredictedToTheScan) {
  add_track(25.0, 0.0, 20.0, 0.0);
  now_ += 200 * kMillisecond;  // it is at 29 m by now
  begin();
  const auto itself = add(30.5, 0.0, corrected_flag::kMoving, 20.0);
  classify();
  EXPECT_EQ(out_->provenance[itself], Provenance::kMoving) << "not a ghost behind where it was";
}

TEST_F(PublishedMethod, WithoutTracksItSaysSoAndTestsType2Only) {
  const auto far = add(60.0, 0.0, corrected_flag::kMoving, 8.0);
  classify();
  EXPECT_TRUE(out_->flags & pipeline_flag::kNoTracks);
  EXPECT_EQ(out_->provenance[far], Provenance::kMoving);
  add_track(25.0, 0.0);
  now_ += 2000 * kMillisecond;
  begin();
  const auto again = add(60.0, 0.0, corrected_flag::kMoving, 8.0);
  classify();
  EXPECT_TRUE(out_->flags & pipeline_flag::kTracksStale);
  EXPECT_EQ(out_->provenance[again], Provenance::kMoving);
}

TEST_F(PublishedMethod, ReflectorsAreRememberedAndMoveWithTheVehicle) {
  // The rail is seen by one radar only, once; 100 ms later, 1.5 m farther on, another radar's scan has the ghost.
  begin(15.0);
  add_rail();
  classify();
  now_ += 50 * kMillisecond;
  begin(15.0);
  const auto ghost = add(27.0, -14.0, corrected_flag::kMoving, 8.0);
  classify();
  EXPECT_EQ(out_->provenance[ghost], Provenance::kGhostType2);
  double begin_m = 1e9;
  for (std::size_t i = 0; i < out_->number_of_reflector_segments; ++i) {
    begin_m = std::min({begin_m, static_cast<double>(out_->reflector_segments[i].start_vehicle_m[0]),
                        static_cast<double>(out_->reflector_segments[i].end_vehicle_m[0])});
  }
  EXPECT_NEAR(begin_m, 5.0 - 0.1 * 15.0, 0.75);
  now_ += 1000 * kMillisecond;
  begin(15.0);
  const auto later = add(27.0, -14.0, corrected_flag::kMoving, 8.0);
  classify();
  EXPECT_EQ(out_->provenance[later], Provenance::kMoving) << "what was not seen for long is forgotten";
}

TEST_F(PublishedMethod, BetweenTwoSearchesTheSegmentsMoveOn) {
  // A scan 12 ms later does not search anew: the same segments, from 12 ms farther on.
  begin(20.0);
  add_rail();
  filter_.classify(*scan_, *out_);
  const ReflectorSegment before = out_->reflector_segments[0];
  now_ += 12 * kMillisecond;
  begin(20.0);
  filter_.classify(*scan_, *out_);
  EXPECT_NEAR(out_->reflector_segments[0].start_vehicle_m[0], before.start_vehicle_m[0] - 0.24F, 1e-3);
  EXPECT_NEAR(out_->reflector_segments[0].end_vehicle_m[1], before.end_vehicle_m[1], 1e-3);
}

TEST_F(PublishedMethod, RejectedAndUndecidedDetectionsAreUnknown) {
  const auto rejected = add(20.0, 0.0, corrected_flag::kMoving | corrected_flag::kOutsideRegion);
  const auto undecided = add(20.0, 0.0, corrected_flag::kAmbiguous);
  const auto not_a_number = add(std::numeric_limits<double>::quiet_NaN(), 0.0, corrected_flag::kMoving, 8.0);
  classify();
  EXPECT_EQ(out_->provenance[rejected], Provenance::kUnknown);
  EXPECT_EQ(out_->provenance[undecided], Provenance::kUnknown);
  EXPECT_EQ(out_->number_of_valid_detections, 3u);
  EXPECT_TRUE(out_->provenance[not_a_number] == Provenance::kMoving);
}

TEST_F(PublishedMethod, CopiesWhatTheTrackerNeeds) {
  const auto i = add(20.0, 3.0, corrected_flag::kMoving, 6.5);
  scan_->range_std_m[i] = 0.12F;
  scan_->azimuth_std_rad[i] = 0.003F;
  scan_->rcs_dbsm[i] = 7.0F;
  scan_->snr_db[i] = 23.0F;
  scan_->flags = pipeline_flag::kNoAlignment;
  classify();
  EXPECT_EQ(out_->x_vehicle_m[i], 20.0F);
  EXPECT_EQ(out_->range_rate_over_ground_mps[i], 6.5F);
  EXPECT_EQ(out_->range_std_m[i], 0.12F);
  EXPECT_EQ(out_->azimuth_std_rad[i], 0.003F);
  EXPECT_EQ(out_->rcs_dbsm[i], 7.0F);
  EXPECT_EQ(out_->snr_db[i], 23.0F);
  EXPECT_TRUE(out_->flags & pipeline_flag::kNoAlignment);
  EXPECT_EQ(out_->geometry.sensor_position_vehicle_m[0], 3.6F);
}

TEST_F(PublishedMethod, FullScansForAMinuteStayWithinBoundsAndAllocateNothing) {
  std::uniform_real_distribution<double> place(-80.0, 80.0);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (int round = 0; round < 240; ++round) {
      begin(15.0);
      for (std::size_t i = 0; i < kMaxDetections; ++i) {
        add(place(random_), place(random_), corrected_flag::kMoving, i % 5 == 0 ? 8.0 : 0.0);
      }
      filter_.classify(*scan_, *out_);
      now_ += 12 * kMillisecond;
      ASSERT_LE(out_->number_of_reflector_segments, kMaxReflectorSegments);
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::ghosts::published
