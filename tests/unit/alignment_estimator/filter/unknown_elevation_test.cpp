// Radars that measure no elevation: the errors of k_v and yaw match their stated σ.

#include <gtest/gtest.h>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/common/geometry/angles.hpp"
#include "tests/unit/alignment_estimator/filter/bench.hpp"

namespace boresight::alignment {
namespace {

simulator::AlignmentSpec without_elevation(std::uint64_t seed) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.seed = seed;
  spec.duration_s = 30.0;
  simulator::draw_truth(spec);
  for (simulator::AlignmentRadar& radar : spec.radars) radar.measures_elevation = false;
  return spec;
}

TEST(FilterWithoutElevation, FourRadarsWithoutElevationStateConsistentSpeedAndYaw) {
  double speed_nees = 0.0, worst_speed = 0.0, yaw_nees = 0.0, worst_yaw = 0.0;
  constexpr std::uint64_t kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const simulator::AlignmentSpec spec = without_elevation(seed);
    Bench bench(spec);
    bench.run(30.0);
    for (std::size_t r = 0; r < 4; ++r) {
      const RadarEstimate e = bench.filter->estimate(r);
      ASSERT_TRUE((e.observable & alignment_axis::kVehicleYaw) != 0) << r;
      const double yaw = bench.error_rad(r).z();
      yaw_nees += yaw * yaw / e.covariance(3, 3) / (4.0 * kSeeds);
      worst_yaw = std::max(worst_yaw, std::abs(yaw));
    }
    const RadarEstimate e = bench.filter->estimate(0);
    const double off = e.speed_scale - spec.speed_scale;
    speed_nees += off * off / e.covariance(0, 0) / kSeeds;
    worst_speed = std::max(worst_speed, std::abs(off));
    EXPECT_LT(std::sqrt(e.covariance(0, 0)), 2e-3);
  }
  EXPECT_LT(speed_nees, 2.0);
  EXPECT_LT(worst_speed, 2e-3) << "an assumed uniform elevation over the field of view gave an error of 0.01";
  EXPECT_LT(yaw_nees, 1.5);
  EXPECT_LT(worst_yaw, 0.3 * kRadiansPerDegree);
}

TEST(FilterWithoutElevation, YawIsMoreCertainWhenRollAndPitchAreKnown) {
  const simulator::AlignmentSpec spec = without_elevation(1);
  Bench alone(spec), seeded(spec);
  const Eigen::Matrix3d known = Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal();
  for (std::size_t r = 0; r < 4; ++r) {
    const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(spec.radars[r].config.mounting_pose, 0.0, 0.0, 0.0);
    const Eigen::Vector3d turn = geometry::so3_log(seeded.drive.sensor_to_vehicle(r, 1.0) * nominal.transpose());
    ASSERT_TRUE(seeded.filter->seed(r, turn, known)) << r;
  }
  alone.run(30.0);
  seeded.run(30.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const double alone_std = std::sqrt(alone.filter->estimate(r).covariance(3, 3));
    const double seeded_std = std::sqrt(seeded.filter->estimate(r).covariance(3, 3));
    EXPECT_GT(alone_std, 0.1 * kRadiansPerDegree) << r << ": it does not shrink with driving time";
    EXPECT_LT(seeded_std, 0.06 * kRadiansPerDegree) << r;
  }
}

}  // namespace
}  // namespace boresight::alignment
