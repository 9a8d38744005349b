// Effect of the plate's result on the dynamic estimator.
#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/alignment_estimator/core/plate/seed.hpp"
#include "services/alignment_estimator/core/windows/windowed_filter.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "services/simulator/alignment/drive.hpp"

namespace boresight::alignment {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr Eigen::Index kTurnX = 1, kTurnY = 2;  // in RadarEstimate::covariance, behind k_v

/// Radars have the ids 1, 2, 3 …
bool seed_radar(WindowedFilter& filter, const RotationSeed& seed) {
  return filter.seed(seed.radar_id - 1, seed.rotation_vehicle_rad, seed.covariance);
}
Memory memory_of(const WindowedFilter& filter) {
  Memory memory;
  filter.save(memory);
  return memory;
}

/// Three radars: two that look ahead, one to the left.
VehicleConfig vehicle() {
  VehicleConfig config;
  config.radars.resize(3);
  for (std::uint32_t i = 0; i < 3; ++i) config.radars[i].id = i + 1;
  config.radars[0].mounting_pose.position_m = {3.7, 0.0, 0.5};
  config.radars[1].mounting_pose = {.position_m = {3.6, 0.7, 0.5}, .yaw_rad = 0.0, .pitch_rad = 0.03};
  config.radars[2].mounting_pose = {.position_m = {3.5, 0.8, 0.5}, .yaw_rad = 1.2};
  return config;
}

Eigen::Matrix3d nominal(const RadarConfig& radar) {
  const MountingPose& pose = radar.mounting_pose;
  return geometry::sensor_to_vehicle(pose.yaw_rad, pose.pitch_rad, pose.roll_rad);
}

TEST(PlateSeed, IsTheStartOfTheEstimator) {
  const VehicleConfig three = vehicle();
  const auto filter = std::make_unique<WindowedFilter>(three, FilterConfig{});
  WindowedFilter& estimator = *filter;
  const RadarEstimate before = estimator.estimate(0);
  RotationSeed seed;
  const double yaw_rad = 0.5 * kDegree_rad, pitch_rad = -0.8 * kDegree_rad;
  ASSERT_TRUE(seed_from_plate(three.radars[1], yaw_rad, 0.01 * kDegree_rad, pitch_rad, 0.02 * kDegree_rad, {}, seed));
  {
    const runtime::CountAllocations counting;
    ASSERT_TRUE(seed_radar(estimator, seed));
  }
  EXPECT_EQ(runtime::counted_allocations(), 0u);

  const RadarEstimate seeded = estimator.estimate(1);
  // Yaw and pitch are those of the sensor's own axes.
  const Eigen::Matrix3d actual = nominal(three.radars[1]) * geometry::sensor_to_vehicle(yaw_rad, pitch_rad, 0.0);
  EXPECT_LT(geometry::so3_log(seeded.sensor_to_vehicle * actual.transpose()).norm(), 0.002 * kDegree_rad);
  EXPECT_NEAR(std::sqrt(seeded.covariance(kTurnY, kTurnY)), std::hypot(0.02, 0.05) * kDegree_rad, 0.003 * kDegree_rad);
  EXPECT_NEAR(std::sqrt(seeded.covariance(kTurnX, kTurnX)), 0.035, 0.001) << "the plate does not measure roll";
  EXPECT_TRUE((seeded.observable & alignment_axis::kVehiclePitch) != 0);
  EXPECT_TRUE((seeded.observable & alignment_axis::kVehicleYaw) != 0);

  const RadarEstimate other = estimator.estimate(0);
  EXPECT_EQ(other.sensor_to_vehicle, before.sensor_to_vehicle);
  EXPECT_EQ(other.covariance, before.covariance);
  EXPECT_EQ(other.observable, before.observable);
}

TEST(PlateSeed, OfOneRadarIsKeptWhenAnotherIsSeeded) {
  const VehicleConfig three = vehicle();
  const auto filter = std::make_unique<WindowedFilter>(three, FilterConfig{});
  WindowedFilter& estimator = *filter;
  std::array<RotationSeed, 3> seeds;
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(seed_from_plate(three.radars[i], 0.01, 1e-4, 0.02, 1e-4, {}, seeds[i]));
    ASSERT_TRUE(seed_radar(estimator, seeds[i]));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const RadarEstimate estimate = estimator.estimate(i);
    Eigen::Matrix3d off = estimate.covariance.bottomRightCorner<3, 3>() - seeds[i].covariance;
    // The variance of yaw includes the effect of an unknown roll and pitch together.
    off(2, 2) -= 0.25 * seeds[i].covariance(0, 0) * seeds[i].covariance(1, 1);
    // What heights over the road may change is a tolerance; it is at most 1e-3 of the variances.
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-3 * seeds[i].covariance.diagonal().maxCoeff())
        << "radar " << i << ", correlations between its axes included";
    const Eigen::Matrix3d actual = geometry::so3_exp(seeds[i].rotation_vehicle_rad) * nominal(three.radars[i]);
    EXPECT_LT((estimate.sensor_to_vehicle - actual).cwiseAbs().maxCoeff(), 1e-12);
  }
  // The memory contains all of this.
  const Memory memory = memory_of(estimator);
  ASSERT_EQ(memory.number_of_radars, 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(memory.radars[i].rotation_vehicle_rad[axis],
                  seeds[i].rotation_vehicle_rad[static_cast<Eigen::Index>(axis)], 1e-12);
    }
  }
}

TEST(PlateSeed, IsRefusedWhereItCannotBeUsed) {
  const VehicleConfig three = vehicle();
  RotationSeed seed;
  ASSERT_TRUE(seed_from_plate(three.radars[0], 0.01, 1e-4, 0.02, 1e-4, {}, seed));
  const auto filter = std::make_unique<WindowedFilter>(three, FilterConfig{});
  WindowedFilter& estimator = *filter;
  const RadarEstimate before = estimator.estimate(0);
  RotationSeed wrong = seed;
  wrong.radar_id = 9;
  EXPECT_FALSE(seed_radar(estimator, wrong));
  wrong = seed;
  wrong.rotation_vehicle_rad.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(seed_radar(estimator, wrong));
  wrong = seed;
  wrong.covariance(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(seed_radar(estimator, wrong));
  wrong = seed;
  wrong.covariance(2, 2) = 0.0;
  EXPECT_FALSE(seed_radar(estimator, wrong));
  wrong = seed;
  wrong.rotation_vehicle_rad *= 100.0;
  EXPECT_FALSE(seed_radar(estimator, wrong));
  EXPECT_EQ(estimator.estimate(0).sensor_to_vehicle, before.sensor_to_vehicle);
  EXPECT_EQ(estimator.estimate(0).covariance, before.covariance);
}

TEST(PlateSeed, IsAcceptedByEveryMethodWithThreeAngles) {
  const VehicleConfig three = vehicle();
  RotationSeed seed;
  ASSERT_TRUE(seed_from_plate(three.radars[0], 0.01, 1e-4, 0.02, 1e-4, {}, seed));
  RotationSeed unknown = seed;
  unknown.radar_id = 9;
  for (const auto& [name, method] : kMethodNames) {
    SCOPED_TRACE(name);
    Config config;
    config.method = method;
    Estimator estimator(three, config);
    const bool refuses = method == MethodName::kAzimuth1d || method == MethodName::kBoresightPlanar;
    EXPECT_EQ(estimator.seed(seed), !refuses);
    const Eigen::Vector3d turn =
        geometry::so3_log(estimator.estimate(0).sensor_to_vehicle * nominal(three.radars[0]).transpose());
    EXPECT_LT((turn - (refuses ? Eigen::Vector3d::Zero() : seed.rotation_vehicle_rad)).norm(), 1e-9);
    EXPECT_FALSE(estimator.seed(unknown)) << "a radar that is not in the vehicle";
  }
}

TEST(PlateSeed, SavesMinutesOfDriving) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.duration_s = 12.0;
  spec.road = simulator::RoadKind::kMotorway;
  simulator::AlignmentDrive drive(spec);
  const VehicleConfig four = drive.vehicle();
  Config config;
  config.method = MethodName::kBoresight;
  Estimator with_seed(four, config), without(four, config);
  for (std::size_t i = 0; i < four.radars.size(); ++i) {
    RotationSeed seed;
    seed.radar_id = four.radars[i].id;
    seed.rotation_vehicle_rad =
        geometry::so3_log(drive.sensor_to_vehicle(i, 0.0) * nominal(four.radars[i]).transpose());
    seed.covariance = Eigen::Vector3d::Constant(std::pow(0.05 * kDegree_rad, 2)).asDiagonal();
    // An error of two stds, which is realistic.
    seed.rotation_vehicle_rad.y() += 0.1 * kDegree_rad;
    ASSERT_TRUE(with_seed.seed(seed));
  }
  simulator::AlignmentEvent event;
  while (drive.next(event)) {
    for (Estimator* const estimator : {&with_seed, &without}) {
      if (event.ego != nullptr) estimator->add_ego_motion(*event.ego);
      if (event.scan != nullptr) static_cast<void>(estimator->add_scan(*event.scan));
    }
  }
  for (std::size_t i = 0; i < four.radars.size(); ++i) {
    const RadarEstimate seeded = with_seed.estimate(i), plain = without.estimate(i);
    ASSERT_GT(seeded.scans_used, 50u);
    EXPECT_LE(std::sqrt(seeded.covariance(kTurnX, kTurnX)), 0.06 * kDegree_rad);
    EXPECT_GT(std::sqrt(plain.covariance(kTurnX, kTurnX)), 0.2 * kDegree_rad);
    const Eigen::Vector3d error =
        geometry::so3_log(seeded.sensor_to_vehicle * drive.sensor_to_vehicle(i, 13.0).transpose());
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      EXPECT_LT(std::abs(error[axis]), 4.0 * std::sqrt(seeded.covariance(1 + axis, 1 + axis)))
          << "radar " << i << ", axis " << axis;
    }
    EXPECT_NEAR(seeded.speed_scale, spec.speed_scale, 0.005);
  }
}

}  // namespace
}  // namespace boresight::alignment
