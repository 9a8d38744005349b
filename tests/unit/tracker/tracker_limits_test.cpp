// What every tracker does where something is beyond its limits: clocks, capacities, faulty numbers.
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/tracker/any_tracker.hpp"

namespace boresight::tracking {
namespace {

class TrackerLimits : public AnyTracker {};

TEST_P(TrackerLimits, JumpOfTheClockDropsAllTracks) {
  for (const int jump_ms : {-60'000, -1'900, 3'000}) {
    drive(kCarAhead, 10);
    ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
    const std::uint32_t id = list_->tracks[0].tracking_id;
    now_ += jump_ms * kMillisecond;
    EXPECT_TRUE(step_empty().restarted) << jump_ms;
    EXPECT_EQ(list().number_of_tracks, 0u) << jump_ms;
    EXPECT_FALSE(step_empty().restarted) << "only once";
    const Moving car = drive(kCarAhead, 10);
    ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
    EXPECT_GT(list_->tracks[0].tracking_id, id) << "an identity is never used again";
    EXPECT_NEAR(list_->tracks[0].velocity_over_ground_mps[0], car.velocity_mps.x(), 1.0);
    tracker_ = made();
  }
}

TEST_P(TrackerLimits, MoreObjectsThanAListHasRoomForAreCountedAndFlagged) {
  bool was_full = false;
  for (int i = 0; i < 10; ++i) {
    scene_.begin(now_);
    // Each object is far from the next one in place or range rate.
    for (int k = 0; k < 160; ++k) {
      scene_.add({12.0 + 5.0 * (k % 16) + 0.4 * i, -36.0 + 8.0 * (k / 16)}, {8.0, 0.0});
    }
    take();
    EXPECT_LE(list().number_of_tracks, kMaxTracks);
    const bool is_full = list_->dropped_tracks > 0;
    EXPECT_TRUE(!is_full || (list_->tracker_flags & tracker_flag::kCapacityReached) != 0u);
    was_full = was_full || is_full;
  }
  EXPECT_TRUE(was_full);
}

TEST_P(TrackerLimits, AsManyDetectionsAsAScanHoldsAreNoFault) {
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  for (int i = 0; i < 3; ++i) {
    scene_.begin(now_);
    for (std::size_t k = 0; k < kMaxDetections; ++k) {
      const double x = anywhere(random_), y = anywhere(random_);
      scene_.add({40.0 + 30.0 * x, 30.0 * y}, {10.0 * y, 10.0 * x});
    }
    take();
    EXPECT_LE(list().number_of_tracks, kMaxTracks);
    EXPECT_LE(list_->number_of_confirmed_tracks, list_->number_of_tracks);
  }
}

TEST_P(TrackerLimits, DetectionsThatAreNoNumbersAreIgnored) {
  Moving car = drive(kCarAhead, 20);
  for (int i = 0; i < 5; ++i) {
    car = car.after(kScan_s);
    scene_.begin(now_);
    add(car);
    for (int k = 0; k < 4; ++k) scene_.add({car.position_m.x(), 0.5 * k}, car.velocity_mps);
    constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
    scene_.scan->x_vehicle_m[3] = kNoNumber;
    scene_.scan->y_vehicle_m[4] = std::numeric_limits<float>::infinity();
    scene_.scan->range_rate_over_ground_mps[5] = kNoNumber;
    scene_.scan->azimuth_vehicle_rad[6] = kNoNumber;
    take();
  }
  const Track* track = nearest(car.position_m);
  ASSERT_NE(track, nullptr);
  EXPECT_NEAR(track->position_vehicle_m[0], car.position_m.x(), 3.0);
  EXPECT_TRUE(std::isfinite(track->existence_probability));
  EXPECT_TRUE(std::isfinite(track->mirror_probability));
}

TEST_P(TrackerLimits, StationaryAndUnclassifiedDetectionsMakeNoTracks) {
  for (int i = 0; i < 20; ++i) {
    scene_.begin(now_);
    for (int k = 0; k < 20; ++k) scene_.add({10.0 + 2.0 * k, 5.0}, {0.0, 0.0}, Provenance::kStationary);
    for (int k = 0; k < 20; ++k) scene_.add({10.0 + 2.0 * k, -5.0}, {8.0, 0.0}, Provenance::kUnknown);
    take();
    EXPECT_EQ(list().number_of_tracks, 0u);
  }
}

TEST_P(TrackerLimits, FlagsOfTheScanGoOn) {
  scene_.begin(now_);
  scene_.scan->flags = pipeline_flag::kNoTracks | pipeline_flag::kNoAlignment;
  tracker_->step(*scene_.scan);
  EXPECT_EQ(list().flags, pipeline_flag::kNoTracks | pipeline_flag::kNoAlignment);
}

TEST_P(TrackerLimits, DistrustedScansAreNeitherDetectionsNorEmptySpace) {
  drive(kCarAhead, 20);
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  const Track before = list_->tracks[0];
  const Moving ghost{{30.0, 6.0}, {8.0, 0.0}};
  for (int i = 1; i <= 10; ++i) {
    scene_.begin(now_);
    scene_.scan->flags = pipeline_flag::kDistrusted;
    add(ghost.after(kScan_s * i));
    take();
    EXPECT_EQ(list().number_of_tracks, 1u) << "no birth from wrong data";
  }
  const Track& track = list_->tracks[0];
  EXPECT_EQ(track.update, TrackUpdate::kPredicted);
  EXPECT_NEAR(track.position_vehicle_m[0], before.position_vehicle_m[0] + 0.5F * before.velocity_over_ground_mps[0],
              0.3);
  EXPECT_GT(track.existence_probability, before.existence_probability * std::exp(-0.5))
      << "only the life of objects counts";
  for (int i = 0; i < 10; ++i) step_empty();
  EXPECT_LT(list().number_of_confirmed_tracks == 0 ? 0.0F : list_->tracks[0].existence_probability,
            track.existence_probability)
      << "the same scans without the flag are evidence of empty space";
}

TEST_P(TrackerLimits, AllocatesNothing) {
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (int i = 0; i < 50; ++i) {
      scene_.begin(now_, 1u + static_cast<unsigned>(i) % 2u);
      for (int k = 0; k < 120; ++k) scene_.add({10.0 + k * 0.7, -30.0 + (k * 37) % 60}, {10.0, 1.0});
      tracker_->step(*scene_.scan);
      tracker_->write(*list_);
      now_ += (i == 30 ? 5000 : 25) * kMillisecond;  // a jump of the clock, too
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

TEST_P(TrackerLimits, GivesTheSameListForTheSameScans) {
  const auto run = [this] {
    random_.seed(5);
    tracker_ = made();
    now_ = 1'000'000 * kMillisecond;
    std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
    for (int i = 0; i < 20; ++i) {
      scene_.begin(now_);
      add(kCarAhead.after(kScan_s * i));
      for (int k = 0; k < 20; ++k) {
        const double x = anywhere(random_), y = anywhere(random_);
        scene_.add({40.0 + 30.0 * x, 30.0 * y}, {10.0 * y, 10.0 * x});
      }
      take();
    }
    const TrackList& tracks = list();
    std::vector<float> result = {static_cast<float>(tracks.number_of_tracks),
                                 static_cast<float>(tracks.likelihood_evaluations)};
    for (std::uint32_t i = 0; i < tracks.number_of_tracks; ++i) {
      result.push_back(tracks.tracks[i].existence_probability);
      result.push_back(tracks.tracks[i].position_vehicle_m[0]);
    }
    return result;
  };
  const std::vector<float> first = run();
  EXPECT_GT(first[0], 0.0F);
  EXPECT_EQ(run(), first);
}

INSTANTIATE_TEST_SUITE_P(Trackers, TrackerLimits, testing::ValuesIn(tracker_names()),
                         [](const auto& test) { return test.param; });

/// Sixty objects in rows, each with two detections, that are so far apart along and across.
void add_crowd(Scene& scene, int scan, double along_m, double across_m) {
  for (int k = 0; k < 120; ++k) {
    const int object = k / 2;
    scene.add({20.0 + along_m * (object % 15) + 0.4 * scan, across_m * (object / 15 - 1.5) + 0.5 * (k % 2)},
              {8.0, 0.0});
  }
}

/// Ten scans of a crowd; `was_reached` looks at each step and its list, and one of them must reach the limit.
template <typename WasReached>
void expect_limit_is_reached(const Config& config, double along_m, double across_m, const WasReached& was_reached) {
  const auto tracker = make_tracker("pmbm", two_radars(), config);
  const auto list = std::make_unique<TrackList>();
  Scene scene;
  int reached = 0;
  for (int i = 0; i < 10; ++i) {
    scene.begin((1000 + 50 * i) * kMillisecond);
    add_crowd(scene, i, along_m, across_m);
    const StepResult result = tracker->step(*scene.scan);
    tracker->write(*list);
    reached += was_reached(result, *list) ? 1 : 0;
  }
  EXPECT_GT(reached, 0);
}

TEST(PmbmTracker, WorkBudgetThatIsReachedIsFlagged) {
  Config config;
  config.pmbm.work_budget = 100;
  expect_limit_is_reached(config, 1.5, 3.0, [](const StepResult& result, const TrackList& list) {
    EXPECT_EQ((list.tracker_flags & tracker_flag::kWorkBudgetReached) != 0u, result.budget_reached);
    EXPECT_EQ(list.likelihood_evaluations, result.likelihood_evaluations);
    return result.budget_reached;
  });
}

TEST(PmbmTracker, CapacityThatIsReachedIsFlagged) {
  Config config;
  config.capacity.objects = 16;
  expect_limit_is_reached(config, 5.0, 8.0, [](const StepResult& result, const TrackList& list) {
    EXPECT_EQ((list.tracker_flags & tracker_flag::kCapacityReached) != 0u,
              result.dropped_objects + result.dropped_detections + list.dropped_tracks > 0u);
    return result.dropped_objects > 0;
  });
}

TEST(PmbmTracker, CrowdThatIsAssociatedInPartsIsFlaggedAndNothingIsDropped) {
  Config config;
  config.capacity.group_objects = 4;
  expect_limit_is_reached(config, 1.5, 3.0, [](const StepResult& result, const TrackList& list) {
    EXPECT_EQ((list.tracker_flags & tracker_flag::kGatesCut) != 0u, result.cut_gates > 0u);
    EXPECT_EQ((list.tracker_flags & tracker_flag::kCapacityReached) != 0u,
              result.dropped_objects + result.dropped_detections + list.dropped_tracks > 0u);
    return result.cut_gates > 0 && result.dropped_objects == 0;
  });
}

}  // namespace
}  // namespace boresight::tracking
