// Noise across the line of sight, on scans with noise of known size.
#include "tests/benchmarks/realism/statistics/azimuth_noise.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/benchmarks/realism/test/scans.hpp"

namespace boresight::bench::realism {
namespace {

/// Stationary detections at this azimuth from sensors of different speeds along x, with both kinds of noise.
AzimuthNoise noise_at(double azimuth_deg, double azimuth_std_deg, double rate_std_mps) {
  AzimuthNoise noise;
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  const double azimuth = azimuth_deg * M_PI / 180.0;
  for (std::uint64_t i = 1; i <= 1000; ++i) {
    ObservedScan scan = scan_of(i);
    scan.sensor_velocity_mps = {5.0 + 0.02 * static_cast<double>(i), 0.0};
    for (int k = 0; k < 20; ++k) {
      ObservedDetection d = at(30.0 * std::cos(azimuth), 30.0 * std::sin(azimuth));
      d.deviation_mps = rate_std_mps * normal(engine) + azimuth_std_deg * M_PI / 180.0 * normal(engine) *
                                                            scan.sensor_velocity_mps.x() * std::sin(azimuth);
      scan.detections.push_back(d);
    }
    noise.add(scan);
  }
  return noise;
}

TEST(AzimuthNoise, IsFoundBesideTheNoiseOfTheRangeRate) {
  EXPECT_NEAR(noise_at(65.0, 0.6, 0.05).azimuth_std_deg(2), 0.6, 0.05);
  EXPECT_NEAR(noise_at(-35.0, 0.3, 0.05).azimuth_std_deg(1), 0.3, 0.03);
}

TEST(AzimuthNoise, IsNearZeroForNoiseOfTheRangeRateAlone) {
  EXPECT_LT(noise_at(65.0, 0.0, 0.05).azimuth_std_deg(2), 0.05);
}

TEST(AzimuthNoise, OtherBandsHaveNoData) {
  const AzimuthNoise noise = noise_at(65.0, 0.6, 0.05);
  EXPECT_TRUE(std::isnan(noise.azimuth_std_deg(0)));
  EXPECT_TRUE(std::isnan(noise.azimuth_std_deg(1)));
}

TEST(AzimuthNoise, CarsScatterAcrossTheLineOfSightAboutTheirOwnMedian) {
  AzimuthNoise noise;
  for (std::uint64_t i = 1; i <= 100; ++i) {
    ObservedScan scan = scan_of(i);
    scan.objects = {car_at(1, 30.0)};
    // Always 0.7 m to the left of the centre, and 0.2 m to either side of that; along the line of sight does not count.
    scan.detections = {of_car(1, 30.0, 0.5), of_car(1, 34.0, 0.9)};
    noise.add(scan);
  }
  noise.end_drive();
  EXPECT_NEAR(noise.car_std_m(0), 1.4826 * 0.2, 1e-4);
  EXPECT_TRUE(std::isnan(noise.car_std_m(1)));
}

TEST(AzimuthNoise, DrivesAddUp) {
  AzimuthNoise noise = noise_at(65.0, 0.6, 0.05);
  noise.merge(noise_at(35.0, 0.3, 0.05));
  EXPECT_NEAR(noise.azimuth_std_deg(1), 0.3, 0.03);
  EXPECT_NEAR(noise.azimuth_std_deg(2), 0.6, 0.05);
}

}  // namespace
}  // namespace boresight::bench::realism
