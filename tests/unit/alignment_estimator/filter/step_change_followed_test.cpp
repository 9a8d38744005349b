// Reaction of the filter to small changes of one radar's mounting.
#include <cmath>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "tests/unit/alignment_estimator/filter/bench.hpp"

namespace boresight::alignment {
namespace {

simulator::AlignmentSpec drive_with_step_change(std::uint64_t seed, double seconds) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.seed = seed;
  spec.duration_s = seconds;
  return spec;
}

TEST(FollowsStepChange, SmallChangesAreReportedForTheirRadarAndFollowedConsistently) {
  for (const Eigen::Vector2d& pitch_yaw_deg : {Eigen::Vector2d(0.0, 0.5), Eigen::Vector2d(-1.0, 0.0)}) {
    simulator::AlignmentSpec spec = drive_with_step_change(93, 75.0);
    spec.step_changes.push_back(
        {41.2, 2, {0.0, pitch_yaw_deg(0) * kRadiansPerDegree, pitch_yaw_deg(1) * kRadiansPerDegree}});
    Bench bench(spec);
    bench.run(40.0);
    for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(bench.filter->estimate(r).step_change.count, 0u) << r;
    bench.run(52.2);
    EXPECT_EQ(bench.filter->estimate(2).step_change.count, 1u);
    bench.run(75.0);
    const AlignmentStepChange reported = bench.filter->estimate(2).step_change;
    EXPECT_NEAR(reported.rotation_vehicle_rad[1], pitch_yaw_deg(0) * kRadiansPerDegree, 0.2 * kRadiansPerDegree);
    EXPECT_NEAR(reported.rotation_vehicle_rad[2], pitch_yaw_deg(1) * kRadiansPerDegree, 0.1 * kRadiansPerDegree);
    for (std::size_t r = 0; r < 4; ++r) {
      const RadarEstimate estimate = bench.filter->estimate(r);
      EXPECT_EQ(estimate.step_change.count, r == 2 ? 1u : 0u) << r;
      for (Eigen::Index a = 1; a < 3; ++a) {
        const double std_rad = std::sqrt(estimate.covariance(a + 1, a + 1));
        EXPECT_LT(std::abs(bench.error_rad(r)(a)), 4.0 * std_rad) << r << " " << a;
        EXPECT_LT(std_rad, (a == 1 ? 0.1 : 0.02) * kRadiansPerDegree) << r << " " << a;
      }
    }
  }
}

TEST(FollowsStepChange, ChangesBelowTheReportLimitAreFollowedToo) {
  simulator::AlignmentSpec spec = drive_with_step_change(94, 75.0);
  spec.step_changes.push_back({41.2, 1, {0.0, 0.0, 0.12 * kRadiansPerDegree}});
  Bench bench(spec);
  bench.run(75.0);
  EXPECT_EQ(bench.filter->estimate(1).step_change.count, 0u);
  EXPECT_LT(std::abs(bench.error_rad(1).z()), 0.02 * kRadiansPerDegree);
}

TEST(FollowsStepChange, ASlowDriftIsFollowed) {
  // 0.6° in a minute.
  simulator::AlignmentSpec spec = drive_with_step_change(92, 90.0);
  for (int i = 0; i < 300; ++i) {
    spec.step_changes.push_back({21.0 + 0.2 * i, 0, {0.0, 0.0, 0.6 / 300.0 * kRadiansPerDegree}});
  }
  Bench bench(spec);
  double worst_rad = 0.0;
  bench.run(90.0, [&](const simulator::AlignmentEvent&) {
    if (bench.time_s > 20.0) worst_rad = std::max(worst_rad, std::abs(bench.error_rad(0).z()));
  });
  EXPECT_LT(worst_rad, 0.25 * kRadiansPerDegree);
  EXPECT_LT(std::abs(bench.error_rad(0).z()), 0.04 * kRadiansPerDegree);
  EXPECT_EQ(bench.filter->estimate(0).step_change.count, 0u);
}

}  // namespace
}  // namespace boresight::alignment
