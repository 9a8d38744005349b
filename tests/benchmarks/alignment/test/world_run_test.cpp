// The estimator on drives of the world simulator.
#include "tests/benchmarks/alignment/common/world_run.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace boresight::bench {
namespace {

constexpr double kDuration_s = 6.0;

double yaw_error_deg(const WorldRun& run, int radar) {
  return run.figures.value("alignment.radar_" + std::to_string(radar) + ".rotation_z.error_deg");
}

TEST(WorldRun, MountingErrorsOfTheSeedAreFoundWithTheIdealProfile) {
  const WorldRun run = run_world_drive({"demo_drive", "ideal", 101, kDuration_s});
  ASSERT_EQ(run.radars, 4u);
  EXPECT_DOUBLE_EQ(run.duration_s, kDuration_s);
  // Before the drive the error is 1° or more.
  for (int radar = 1; radar <= 4; ++radar) EXPECT_LT(std::abs(yaw_error_deg(run, radar)), 0.2) << radar;
  EXPECT_GT(run.figures.value("alignment.radar_1.rotation_z.nees"), 0.0);
  EXPECT_EQ(run.figures.value("alignment.false_step_changes"), 0.0);
}

TEST(WorldRun, RadarProfileChangesTheResult) {
  const WorldRun ideal = run_world_drive({"demo_drive", "ideal", 101, kDuration_s});
  const WorldRun series = run_world_drive({"demo_drive", "series_77ghz", 101, kDuration_s});
  EXPECT_NE(yaw_error_deg(ideal, 1), yaw_error_deg(series, 1));
  EXPECT_THROW(static_cast<void>(run_world_drive({"demo_drive", "no_such_profile", 101, 1.0})), std::invalid_argument);
}

TEST(WorldRun, DriveIsAtMostAsLongAsItsScenario) {
  EXPECT_DOUBLE_EQ(run_world_drive({"highway_multipath", "ideal", 101, 45.0}).duration_s, 11.4);
}

}  // namespace
}  // namespace boresight::bench
