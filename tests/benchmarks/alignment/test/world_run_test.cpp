// The estimator on drives of the world simulator.
#include "tests/benchmarks/alignment/common/world_run.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/benchmarks/common/options.hpp"

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

simulator::car::RealCar with_scales() {
  simulator::car::RealCar car;
  car.range_rate_scale = 0.0025;
  return car;
}

TEST(WorldRun, TrueSpeedScaleDiffersByRadarIfRadarsScaleTheirRangeRates) {
  const WorldRun run = run_world_drive({"demo_drive", "ideal", 101, 1.0, with_scales()});
  const WorldRun same = run_world_drive({"demo_drive", "ideal", 101, 1.0});
  ASSERT_EQ(run.truth.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const double own = run.truth[i].speed_scale / same.truth[i].speed_scale;
    EXPECT_NE(own, 1.0) << i;
    EXPECT_NEAR(own, 1.0, 0.0025) << i;
    EXPECT_EQ(same.truth[i].speed_scale, same.truth[0].speed_scale) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(run.truth[i].speed_scale, run.truth[j].speed_scale) << i << j;
  }
}

// Without load in the truth the error would be 2°, with its sign reversed 4°.
TEST(WorldRun, LoadIsPartOfTheTrueMountingFromItsTimeOn) {
  simulator::car::RealCar car;
  car.load_pitch_rad = 2.0 * M_PI / 180.0;
  car.load_time_s = 0.0;
  const WorldRun loaded = run_world_drive({"demo_drive", "series_77ghz", 101, 20.0, car});
  for (int radar = 1; radar <= 4; ++radar) {
    const std::string name = "alignment.radar_" + std::to_string(radar) + ".rotation_y.";
    EXPECT_TRUE(std::isfinite(loaded.figures.value(name + "nees"))) << radar;
    EXPECT_LT(std::abs(loaded.figures.value(name + "error_deg")), 0.3) << radar;
  }
  car.load_time_s = 5.0;
  const WorldRun later = run_world_drive({"demo_drive", "ideal", 101, 1.0, car});
  const WorldRun never = run_world_drive({"demo_drive", "ideal", 101, 1.0});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(later.truth[i].rotation.isApprox(never.truth[i].rotation)) << i;
}

TEST(WorldRun, RealCarChangesTheResultAndRepeatsItForTheSameSeed) {
  const WorldDrive real{"demo_drive", "series_77ghz", 101, kDuration_s, simulator::car::real_car_preset()};
  const WorldRun first = run_world_drive(real), second = run_world_drive(real);
  const WorldRun without = run_world_drive({"demo_drive", "series_77ghz", 101, kDuration_s});
  for (int radar = 1; radar <= 4; ++radar) {
    EXPECT_EQ(yaw_error_deg(first, radar), yaw_error_deg(second, radar)) << radar;
    EXPECT_NE(yaw_error_deg(first, radar), yaw_error_deg(without, radar)) << radar;
  }
}

TEST(WorldRun, MountingErrorsAreFoundThoughStampsAreLate) {
  simulator::car::RealCar car;
  car.stamp_offset_s = 0.02;
  const WorldRun run = run_world_drive({"demo_drive", "ideal", 101, kDuration_s, car});
  for (int radar = 1; radar <= 4; ++radar) EXPECT_LT(std::abs(yaw_error_deg(run, radar)), 0.2) << radar;
}

TEST(Options, BarsAreJudgedWithTheJudgedProfileAndWithoutARealCarOnly) {
  Options options;
  EXPECT_TRUE(options.judges());
  options.real_car = true;
  EXPECT_FALSE(options.judges());
  EXPECT_EQ(options.drives(), "ideal + real car");
  options.real_car = false;
  options.profile = "series_77ghz";
  EXPECT_FALSE(options.judges());
}

}  // namespace
}  // namespace boresight::bench
