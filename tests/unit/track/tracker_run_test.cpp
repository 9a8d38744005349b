#include "services/boresight/track/tracker_run.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <gmock/gmock.h>

namespace boresight::track {
namespace {

using ::testing::ElementsAre;

/// CPU time that only counting trackers spend.
std::int64_t g_cpu_time_ns = 0;
std::int64_t counted_cpu_time_ns() {
  return g_cpu_time_ns;
}

/// Reports one track at each detection, and takes as many milliseconds as `ms` says for its next step.
class CountingTracker final : public tracking::MultiObjectTracker {
 public:
  CountingTracker(std::vector<int> ms, float shift_m) : ms_(std::move(ms)), shift_m_(shift_m) {}
  tracking::StepResult step(const ClassifiedScan& scan) override {
    g_cpu_time_ns += std::int64_t{1'000'000} * ms_[steps_++];
    x_m_.clear();
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) x_m_.push_back(scan.x_vehicle_m[i] + shift_m_);
    tracking::StepResult result;
    result.budget_reached = steps_ == 2;
    result.dropped_detections = 1;
    result.dropped_objects = 2;
    result.cut_gates = steps_ == 1 ? 3 : 0;
    result.likelihood_evaluations = 10;
    return result;
  }
  void write(TrackList& out) const override {
    out.number_of_tracks = 0;
    for (const float x_m : x_m_) {
      Track& track = out.tracks[out.number_of_tracks++];
      track = {};
      track.existence_probability = 1.0F;
      track.position_vehicle_m = {x_m, 0.0F, 0.0F};
      track.length_m = track.width_m = 2.0F;
    }
  }

 private:
  std::vector<int> ms_;
  float shift_m_;
  std::size_t steps_ = 0;
  std::vector<float> x_m_;
};

MeasuredPoint point_at(double x_m, double y_m, double range_rate_mps = kNaN) {
  return {{x_m, y_m}, range_rate_mps};
}

TEST(TrackerRuns, TakeTheLeastCpuTimeOfEachScanAndTheEstimatesOfTheFirstPass) {
  const std::vector<std::vector<int>> ms = {{5, 2, 4}, {3, 6, 4}};
  std::size_t made = 0;
  const TrackerRun run =
      run_tracker([&] { return std::make_unique<CountingTracker>(ms[made++], 0.0F); },
                  {{point_at(1.0, 0.0)}, {}, {point_at(2.0, 0.0), point_at(3.0, 0.0)}}, 0.1, 2, counted_cpu_time_ns);
  EXPECT_EQ(made, 2U);
  EXPECT_THAT(run.cpu_ms, ElementsAre(3.0, 2.0, 4.0));
  EXPECT_DOUBLE_EQ(run.mean_cpu_ms(), 3.0);
  EXPECT_DOUBLE_EQ(run.worst_cpu_ms(), 4.0);
  ASSERT_EQ(run.estimates.size(), 3U);
  EXPECT_EQ(run.estimates[0][0].ellipse.centre_m.x(), 1.0);
  EXPECT_TRUE(run.estimates[1].empty());
  EXPECT_EQ(run.estimates[2].size(), 2U);
  EXPECT_TRUE(run.is_repeatable);
  EXPECT_EQ(run.budget_reached, 1U);
  EXPECT_EQ(run.dropped_detections, 3U);
  EXPECT_EQ(run.dropped_objects, 6U);
  EXPECT_EQ(run.gates_cut, 1U) << "scans";
  EXPECT_EQ(run.likelihood_evaluations, 30U);
}

TEST(TrackerRuns, NoticeATrackerThatIsNotDeterministic) {
  float shift_m = 0.0F;
  const TrackerRun run =
      run_tracker([&] { return std::make_unique<CountingTracker>(std::vector<int>{1}, shift_m += 1.0F); },
                  {{point_at(1.0, 0.0)}}, 0.1, 2, counted_cpu_time_ns);
  EXPECT_FALSE(run.is_repeatable);
  EXPECT_EQ(run.estimates[0][0].ellipse.centre_m.x(), 2.0);
}

TEST(ScansOfAScenario, HaveTheTimeOfTheirStepAndMovingDetections) {
  const auto scan = std::make_unique<ClassifiedScan>();
  fill_scan({point_at(3.0, 4.0, -1.5), point_at(-1.0, 0.0)}, 7, 0.1, *scan);
  EXPECT_EQ(scan->header.measurement_time_ns, 700'000'000);
  EXPECT_EQ(scan->header.version, ClassifiedScan::kVersion);
  ASSERT_EQ(scan->number_of_valid_detections, 2U);
  EXPECT_EQ(scan->x_vehicle_m[0], 3.0F);
  EXPECT_EQ(scan->y_vehicle_m[0], 4.0F);
  EXPECT_EQ(scan->range_m[0], 5.0F);
  EXPECT_FLOAT_EQ(scan->azimuth_vehicle_rad[0], std::atan2(4.0F, 3.0F));
  EXPECT_EQ(scan->range_rate_over_ground_mps[0], -1.5F);
  EXPECT_EQ(scan->range_rate_over_ground_mps[1], 0.0F);
  EXPECT_EQ(scan->provenance[1], Provenance::kMoving);
  EXPECT_EQ(scan->probability(Provenance::kMoving, 1), 1.0F);
  EXPECT_EQ(scan->ghost_probability(1), 0.0F);
  EXPECT_EQ(scan->moving_log_likelihood_ratio[1], 0.0F) << "the table says nothing of origins";
}

}  // namespace
}  // namespace boresight::track
