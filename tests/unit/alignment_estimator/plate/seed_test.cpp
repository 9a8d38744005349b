// Start value of the dynamic estimator from the plate: checked along the boresight of radars in various mountings.
#include "services/alignment_estimator/core/plate/seed.hpp"

#include <limits>
#include <memory>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {
namespace {

constexpr double kDeg = M_PI / 180.0;

RadarConfig mounted(double yaw_deg, double pitch_deg, double roll_deg) {
  RadarConfig radar;
  radar.id = 7;
  radar.mounting_pose = {{3.6, 0.7, 0.5}, yaw_deg * kDeg, pitch_deg * kDeg, roll_deg * kDeg};
  return radar;
}

Eigen::Matrix3d nominal(const RadarConfig& radar) {
  return geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
}

TEST(PlateSeed, is_the_alignment_angles_of_a_radar_that_is_mounted_upright) {
  for (const double yaw_deg : {0.0, 45.0, -135.0}) {
    const RadarConfig radar = mounted(yaw_deg, 0.0, 0.0);
    RotationSeed seed;
    ASSERT_TRUE(seed_from_plate(radar, 1.5 * kDeg, 0.0, -0.8 * kDeg, 0.0, SeedConfig{}, seed));
    EXPECT_EQ(seed.radar_id, 7u);
    const Eigen::Vector3d angles =
        geometry::euler_angles(geometry::so3_exp(seed.rotation_vehicle_rad) * nominal(radar));
    EXPECT_NEAR(angles[0] / kDeg, yaw_deg + 1.5, 1e-9);
    EXPECT_NEAR(angles[1] / kDeg, -0.8, 1e-9);
    EXPECT_NEAR(angles[2] / kDeg, 0.0, 1e-9);
  }
}

TEST(PlateSeed, explains_the_view_of_a_radar_in_any_mounting) {
  // Actual boresight and the azimuth at which the plate, on the nominal boresight, would be seen: computed from the
  // rotation alone, then read as the station does.
  for (const double roll_deg : {0.0, 180.0, 20.0, -30.0, 150.0}) {
    const RadarConfig radar = mounted(60.0, 2.0, roll_deg);
    const Eigen::Matrix3d upright = geometry::sensor_to_vehicle(60.0 * kDeg, 2.0 * kDeg, 0.0);
    const Eigen::Matrix3d actual =
        upright * geometry::sensor_to_vehicle(0.9 * kDeg, 1.1 * kDeg, 0.0) * upright.transpose() * nominal(radar);
    const Eigen::Vector3d plate = actual.transpose() * upright * Eigen::Vector3d::UnitX();
    const double azimuth = std::atan2(plate.y(), plate.x());
    RotationSeed seed;
    ASSERT_TRUE(seed_from_plate(radar, -azimuth, 0.0, 1.1 * kDeg, 0.0, SeedConfig{}, seed));
    const Eigen::Matrix3d found = geometry::so3_exp(seed.rotation_vehicle_rad) * nominal(radar);
    EXPECT_LT(geometry::so3_log(found.transpose() * actual).norm() / kDeg, 0.001) << roll_deg;
  }
}

TEST(PlateSeed, is_least_certain_about_the_roll_around_boresight) {
  const RadarConfig radar = mounted(45.0, 0.0, 180.0);
  SeedConfig config;
  RotationSeed seed;
  ASSERT_TRUE(seed_from_plate(radar, 0.0, 3e-4, 0.0, 1e-3, config, seed));
  const auto variance = [&](const Eigen::Vector3d& axis) { return axis.dot(seed.covariance * axis); };
  const double c = std::sqrt(0.5);
  EXPECT_NEAR(variance({c, c, 0.0}), config.roll_std_rad * config.roll_std_rad, 1e-12);
  EXPECT_NEAR(variance({-c, c, 0.0}), 1e-6 + std::pow(config.placement_pitch_std_rad, 2.0), 1e-12);
  EXPECT_NEAR(variance({0.0, 0.0, 1.0}), 9e-8 + std::pow(config.placement_yaw_std_rad, 2.0), 1e-12);
  EXPECT_TRUE(seed.covariance.isApprox(seed.covariance.transpose()));
}

TEST(PlateSeed, refuses_what_it_cannot_turn_into_angles) {
  RotationSeed seed;
  seed.radar_id = 99;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(seed_from_plate(mounted(0.0, 0.0, 90.0), 0.0, 1e-3, 0.0, 1e-3, SeedConfig{}, seed));
  EXPECT_FALSE(seed_from_plate(mounted(0.0, 0.0, -65.0), 0.0, 1e-3, 0.0, 1e-3, SeedConfig{}, seed));
  EXPECT_FALSE(seed_from_plate(mounted(0.0, 0.0, 0.0), nan, 1e-3, 0.0, 1e-3, SeedConfig{}, seed));
  EXPECT_FALSE(seed_from_plate(mounted(0.0, 0.0, 0.0), 0.0, 1e-3, 0.0, nan, SeedConfig{}, seed));
  EXPECT_FALSE(seed_from_plate(mounted(0.0, 0.0, 0.0), 0.0, -1e-3, 0.0, 1e-3, SeedConfig{}, seed));
  EXPECT_EQ(seed.radar_id, 99u);
}

/// A memory whose values tell the radars apart.
std::unique_ptr<Memory> numbered(std::size_t radars) {
  auto memory = std::make_unique<Memory>();
  memory->number_of_radars = radars;
  for (std::size_t i = 0; i < radars; ++i) {
    memory->radars[i].id = static_cast<std::uint32_t>(i + 1);
    memory->radars[i].range_rate_scale = 1e-3 * static_cast<double>(i + 1);
    memory->radars[i].covariance.fill(static_cast<double>(i + 1));
  }
  return memory;
}

RotationSeed some_seed(std::uint32_t id) {
  RotationSeed seed;
  seed.radar_id = id;
  seed.rotation_vehicle_rad = {0.01, 0.02, 0.03};
  seed.covariance << 1.0, 0.1, 0.2, 0.1, 2.0, 0.3, 0.2, 0.3, 3.0;
  return seed;
}

void expect_only_changed(const Memory& memory, std::size_t radar) {
  const RotationSeed seed = some_seed(0);
  for (std::size_t i = 0; i < memory.number_of_radars; ++i) {
    const Memory::Radar& entry = memory.radars[i];
    EXPECT_EQ(entry.range_rate_scale, i == radar ? 0.0 : 1e-3 * static_cast<double>(i + 1));
    for (std::size_t row = 0; row < Memory::kOwn; ++row) {
      for (std::size_t column = 0; column < Memory::kOwn; ++column) {
        const bool turns = row >= Memory::kRotation && row < Memory::kRotation + 3 && column >= Memory::kRotation &&
                           column < Memory::kRotation + 3;
        const double of_seed = turns ? seed.covariance(static_cast<Eigen::Index>(row - Memory::kRotation),
                                                       static_cast<Eigen::Index>(column - Memory::kRotation))
                                     : 0.0;
        EXPECT_EQ(entry.variance(row, column), i == radar ? of_seed : static_cast<double>(i + 1)) << row << column;
      }
    }
  }
}

TEST(PlateSeed, replaces_one_radar_in_the_memory_and_leaves_the_others) {
  const auto memory = numbered(4);
  memory->radars[1].seconds_of_drive = 500.0;
  memory->radars[1].angle_noise_scale = 2.0;
  memory->radars[2].seconds_of_drive = 600.0;
  ASSERT_TRUE(put_seed(some_seed(2), *memory));
  EXPECT_EQ(memory->number_of_radars, 4u);
  EXPECT_EQ(memory->radars[1].rotation_vehicle_rad, (std::array<double, 3>{0.01, 0.02, 0.03}));
  EXPECT_EQ(memory->radars[1].seconds_of_drive, 0.0);
  EXPECT_EQ(memory->radars[1].angle_noise_scale, 1.0);
  EXPECT_EQ(memory->radars[2].seconds_of_drive, 600.0);
  expect_only_changed(*memory, 1);
}

TEST(PlateSeed, adds_a_radar_that_the_memory_does_not_know) {
  const auto memory = numbered(2);
  ASSERT_TRUE(put_seed(some_seed(9), *memory));
  EXPECT_EQ(memory->number_of_radars, 3u);
  EXPECT_EQ(memory->radars[2].id, 9u);
  expect_only_changed(*memory, 2);
}

TEST(PlateSeed, a_full_or_damaged_memory_is_unchanged) {
  auto memory = numbered(kMaxRadars);
  EXPECT_FALSE(put_seed(some_seed(99), *memory));
  EXPECT_TRUE(put_seed(some_seed(16), *memory));
  memory->number_of_radars = kMaxRadars + 1;
  EXPECT_FALSE(put_seed(some_seed(1), *memory));
}

}  // namespace
}  // namespace boresight::alignment
