// The load of the latency measurement is a physical world.
#include "tests/benchmarks/pipeline_latency/load/crowded_road.hpp"

#include <cmath>
#include <filesystem>
#include <memory>

#include "services/common/runtime/config/vehicle_file.hpp"

namespace boresight::bench {
namespace {

constexpr double kEgoSpeed_mps = 15.0;
constexpr double kSixSigma_mps = 6 * 0.04;  // of the demo vehicle's radars
constexpr std::uint32_t kFirstStationary = kMovingDetections + kFalseDetections;

VehicleConfig demo() {
  return config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml");
}

double over_ground_mps(const RadarConfig& radar, const RadarScan& scan, std::uint32_t i) {
  return scan.range_rate_mps[i] + kEgoSpeed_mps * std::cos(scan.azimuth_rad[i] + radar.mounting_pose.yaw_rad);
}

double x_vehicle_m(const RadarConfig& radar, const RadarScan& scan, std::uint32_t i) {
  return radar.mounting_pose.position_m[0] +
         scan.range_m[i] * std::cos(scan.azimuth_rad[i] + radar.mounting_pose.yaw_rad);
}

TEST(CrowdedRoad, HasTheSameNumbersOfDetectionsInEachScan) {
  const CrowdedRoad road(kEgoSpeed_mps);
  const auto scan = std::make_unique<RadarScan>();
  for (std::uint32_t cycle = 0; cycle < 1200; cycle += 7) {
    for (const RadarConfig& radar : demo().radars) {
      road.measure(radar, 0.05 * cycle, cycle, *scan);
      EXPECT_EQ(scan->number_of_valid_detections, kFirstStationary + kStationaryDetections);
    }
  }
}

TEST(CrowdedRoad, HasAsManyDetectionsAsAskedForTheOthersStationary) {
  const CrowdedRoad road(kEgoSpeed_mps, 800);
  const auto scan = std::make_unique<RadarScan>();
  for (std::uint32_t cycle = 0; cycle < 1200; cycle += 37) {
    for (const RadarConfig& radar : demo().radars) {
      road.measure(radar, 0.05 * cycle, cycle, *scan);
      ASSERT_EQ(scan->number_of_valid_detections, 800u);
      for (std::uint32_t i = kFirstStationary; i < 800; ++i) {
        ASSERT_NEAR(over_ground_mps(radar, *scan, i), 0.0, kSixSigma_mps + 0.2);  // of more draws
      }
    }
  }
}

TEST(CrowdedRoad, RangeRatesOverGroundAreThoseOfOrigins) {
  const CrowdedRoad road(kEgoSpeed_mps);
  const auto scan = std::make_unique<RadarScan>();
  for (const RadarConfig& radar : demo().radars) {
    road.measure(radar, 3.0, 60, *scan);
    for (std::uint32_t i = 0; i < kMovingDetections; ++i) {
      // Vehicles drive along the road, so that the line of sight gives the sign and the bound.
      const double along = std::cos(scan->azimuth_rad[i] + radar.mounting_pose.yaw_rad);
      const double speed_mps = over_ground_mps(radar, *scan, i) / along;
      if (std::abs(along) < 0.3) continue;
      EXPECT_TRUE(std::abs(speed_mps - 15.0) < 5.0 || std::abs(speed_mps + 16.0) < 1.0) << speed_mps;
    }
    for (std::uint32_t i = kMovingDetections; i < kFirstStationary; ++i) {
      EXPECT_GT(std::abs(over_ground_mps(radar, *scan, i)), 1.5);
    }
    for (std::uint32_t i = kFirstStationary; i < scan->number_of_valid_detections; ++i) {
      EXPECT_NEAR(over_ground_mps(radar, *scan, i), 0.0, kSixSigma_mps + 0.1);
    }
  }
}

TEST(CrowdedRoad, VehiclesMoveAsTheirRangeRatesSay) {
  const CrowdedRoad road(kEgoSpeed_mps);
  const RadarConfig radar = demo().radars.front();
  const auto before = std::make_unique<RadarScan>(), after = std::make_unique<RadarScan>();
  constexpr double kStep_s = 0.5, kBody_m = 5.5;
  road.measure(radar, 2.0, 40, *before);
  road.measure(radar, 2.0 + kStep_s, 50, *after);
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < kMovingDetections; ++i) {
    const double along = std::cos(before->azimuth_rad[i] + radar.mounting_pose.yaw_rad);
    const double expected_m = x_vehicle_m(radar, *before, i) + kStep_s * before->range_rate_mps[i] / along;
    for (std::uint32_t k = 0; k < kMovingDetections; ++k) {
      if (std::abs(x_vehicle_m(radar, *after, k) - expected_m) > kBody_m) continue;
      ++found;
      break;
    }
  }
  EXPECT_GE(found, kMovingDetections * 8 / 10) << "a few leave the nearest ones";
}

TEST(CrowdedRoad, FalseDetectionsAreNewInEachScan) {
  const CrowdedRoad road(kEgoSpeed_mps);
  const RadarConfig radar = demo().radars.front();
  const auto first = std::make_unique<RadarScan>(), second = std::make_unique<RadarScan>();
  road.measure(radar, 1.0, 20, *first);
  road.measure(radar, 1.05, 21, *second);
  for (std::uint32_t i = kMovingDetections; i < kFirstStationary; ++i) {
    EXPECT_NE(first->range_m[i], second->range_m[i]);
  }
  road.measure(radar, 1.0, 20, *second);
  for (std::uint32_t i = 0; i < first->number_of_valid_detections; ++i) {
    EXPECT_EQ(first->range_m[i], second->range_m[i]) << "the seed is fixed";
  }
}

}  // namespace
}  // namespace boresight::bench
