// Vehicles whose radars measure elevation only in part. The radars with elevation determine k_v so well that a pitch of
// the others would change the length of their velocity, if the unmeasured elevations were known.
#include <gtest/gtest.h>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/common/geometry/angles.hpp"
#include "tests/unit/alignment_estimator/filter/bench.hpp"

namespace boresight::alignment {
namespace {

TEST(MixedElevation, PitchAndRollOfRadarsWithoutElevationStayOpen) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.road = simulator::RoadKind::kCity;
  spec.duration_s = 60.0;
  for (const std::size_t r : {0u, 1u}) spec.radars[r].measures_elevation = false;
  Bench bench(spec);
  bench.run(60.0);
  for (const std::size_t r : {0u, 1u}) {
    const RadarEstimate e = bench.filter->estimate(r);
    EXPECT_EQ(e.observable & (alignment_axis::kVehiclePitch | alignment_axis::kVehicleRoll), 0u) << r;
    EXPECT_EQ(e.observable & alignment_axis::kVehicleYaw, alignment_axis::kVehicleYaw) << r;
    EXPECT_GT(std::sqrt(e.covariance(2, 2)), 3.0 * kRadiansPerDegree) << r << ": that of the prior";
    EXPECT_LT(std::abs(bench.error_rad(r).z()), 0.15 * kRadiansPerDegree) << r;
  }
  for (const std::size_t r : {2u, 3u}) {
    const RadarEstimate e = bench.filter->estimate(r);
    EXPECT_EQ(e.observable & alignment_axis::kVehiclePitch, alignment_axis::kVehiclePitch) << r;
    EXPECT_LT(std::abs(bench.error_rad(r).y()), 0.1 * kRadiansPerDegree) << r;
  }
  EXPECT_NEAR(bench.filter->estimate(0).speed_scale, spec.speed_scale, 3e-4) << "not misled by the others";
}

}  // namespace
}  // namespace boresight::alignment
