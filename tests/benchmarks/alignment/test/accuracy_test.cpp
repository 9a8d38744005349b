// A few of the bars with a margin, on few drives, so that a change that loses accuracy fails at once.
#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {
namespace {

using simulator::AlignmentSpec;
using simulator::RoadKind;

TEST(Accuracy, OneMinuteOfDriving) {
  for (const RoadKind road : {RoadKind::kCity, RoadKind::kMotorway}) {
    for (const std::uint64_t seed : {1u, 2u}) {
      const auto run = run_drive(clean_drive(road, 60.0, seed), own_method().make);
      EXPECT_LT(worst_radar(run.last(), kYaw), 0.02 * kRadiansPerDegree) << name_of(road) << seed;
      EXPECT_LT(worst_radar(run.last(), kPitch), 0.12 * kRadiansPerDegree) << name_of(road) << seed;
      EXPECT_LT(worst_radar(run.last(), kSpeedScale), 3e-4) << name_of(road) << seed;
    }
  }
}

TEST(Accuracy, DisturbancesDoNotChangeTheMounting) {
  const auto run = run_drive(disturbed_drive(RoadKind::kMixed, 90.0, 3), own_method().make);
  EXPECT_LT(worst_radar(run.last(), kYaw), 0.03 * kRadiansPerDegree);
  EXPECT_LT(worst_radar(run.last(), kPitch), 0.2 * kRadiansPerDegree);
}

TEST(Accuracy, FiveDegreesAmongFiftyPercentOutliersConverge) {
  AlignmentSpec spec = clean_drive(RoadKind::kCity, 30.0, 4);
  spec.outlier_share = 0.5;
  for (auto& radar : spec.radars)
    radar.truth = {5.0 * kRadiansPerDegree, -5.0 * kRadiansPerDegree, 5.0 * kRadiansPerDegree};
  const auto run = run_drive(spec, own_method().make);
  EXPECT_LT(worst_radar(run.last(), kYaw), 0.1 * kRadiansPerDegree);
  EXPECT_LT(worst_radar(run.last(), kPitch), 0.5 * kRadiansPerDegree);
}

TEST(Accuracy, AStepChangeIsReportedForTheRightRadarInTime) {
  AlignmentSpec spec = clean_drive(RoadKind::kMixed, 40.0, 5);
  constexpr double kAt_s = 30.0;
  spec.step_changes.push_back({1.0 + kAt_s, 2, {0.0, 0.0, 1.0 * kRadiansPerDegree}});  // measurement times start at 1 s
  const auto run = run_drive(spec, own_method().make);
  ASSERT_EQ(run.step_changes.size(), 1u);
  EXPECT_EQ(run.step_changes[0].radar, 2u);
  EXPECT_GT(run.step_changes[0].time_s, kAt_s);
  EXPECT_LT(run.step_changes[0].time_s, kAt_s + 5.0);
  EXPECT_LT(worst_radar(run.last(), kYaw), 0.05 * kRadiansPerDegree);
}

TEST(Accuracy, RollIsNotObservableOnAStraightRoad) {
  const auto run = run_drive(clean_drive(RoadKind::kStraight, 30.0, 6), own_method().make);
  for (const RadarError& radar : run.last().radars) {
    EXPECT_EQ(radar.observable & alignment_axis::kVehicleRoll, 0u);
    EXPECT_NE(radar.observable & alignment_axis::kVehicleYaw, 0u);
  }
}

}  // namespace
}  // namespace boresight::bench
