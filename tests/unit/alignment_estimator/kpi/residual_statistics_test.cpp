#include "services/alignment_estimator/core/kpi/residual_statistics.hpp"

#include <random>

#include <gtest/gtest.h>

#include "services/alignment_estimator/core/kpi/count_residuals.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {
namespace {

AlignmentKpis written(const ResidualStatistics& statistics) {
  AlignmentKpis kpis{};
  statistics.write(kpis);
  return kpis;
}

TEST(ResidualStatistics, MomentsOfKnownDistributions) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.05);
  std::exponential_distribution<double> skewed(20.0);
  ResidualStatistics gauss, exponential;
  for (int i = 0; i < 200'000; ++i) {
    gauss.add_inlier(normal(random), 0.2);
    exponential.add_inlier(skewed(random) - 0.05, 0.2);
  }
  EXPECT_NEAR(written(gauss).residual_rmse_mps, 0.05, 5e-4);
  EXPECT_NEAR(written(gauss).uncorrected_residual_rmse_mps, 0.2, 1e-6);
  EXPECT_NEAR(written(gauss).residual_skewness, 0.0, 0.03);
  EXPECT_NEAR(written(gauss).residual_kurtosis, 3.0, 0.05);
  EXPECT_NEAR(written(exponential).residual_skewness, 2.0, 0.1);
  EXPECT_NEAR(written(exponential).residual_kurtosis, 9.0, 1.0);
}

TEST(ResidualStatistics, FadesWithTheTimeConstant) {
  ResidualStatistics statistics;
  for (int i = 0; i < 100; ++i) statistics.add_inlier(1.5, -1.5);
  statistics.fade(20.0, 20.0);
  EXPECT_NEAR(statistics.inliers(), 100.0 / std::exp(1.0), 1e-9);
  EXPECT_NEAR(statistics.after().back(), 100.0 / std::exp(1.0), 1e-9)
      << "a value beyond the histogram is in its last bin";
  EXPECT_NEAR(statistics.before().front(), 100.0 / std::exp(1.0), 1e-9);
  for (int i = 0; i < 100; ++i) statistics.add_inlier(0.0, 0.0);
  EXPECT_NEAR(written(statistics).residual_rmse_mps, 1.5 * std::sqrt(36.79 / 136.79), 1e-3);
  EXPECT_NEAR(statistics.after()[ResidualStatistics::kBins / 2], 100.0, 1e-9) << "0 is in the middle bin";
  EXPECT_NEAR(ResidualStatistics::bin_centre_mps(ResidualStatistics::kBins / 2), 0.0, 1e-12);
}

TEST(ResidualStatistics, WithoutDataNothingIsKnown) {
  const AlignmentKpis kpis = written(ResidualStatistics{});
  EXPECT_TRUE(std::isnan(kpis.residual_rmse_mps));
  EXPECT_TRUE(std::isnan(kpis.residual_kurtosis));
  EXPECT_TRUE(std::isnan(kpis.inlier_ratio));
}

TEST(CountResiduals, InliersByTheirOwnNoiseAndAliasesUnfolded) {
  RadarConfig radar;
  radar.mounting_pose.yaw_rad = 0.8;
  RadarEstimate estimate;
  estimate.speed_scale = 1.01;
  estimate.sensor_to_vehicle =
      geometry::so3_exp({0.0, 0.0, 0.02}) * geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
  const EgoSample ego{
      .valid = true, .speed_mps = 20.0, .speed_std_mps = 0.0, .yaw_rate_radps = 0.1, .yaw_rate_std_radps = 0.0};
  const Eigen::Vector3d velocity =
      geometry::sensor_velocity(1.01, ego.speed_mps, ego.yaw_rate_radps, radar.mounting_pose.position_m);
  static ScanDetections scan;
  scan.ambiguity_mps = 30.0;
  std::vector<double> predicted;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> angle(-1.0, 1.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (std::size_t i = 0; i < 400; ++i) {
    const double azimuth = angle(random), std = 0.005;
    scan.azimuth_std_rad[i] = std;
    scan.elevation_std_rad[i] = 1e-6;
    scan.range_rate_std_mps[i] = 0.05;
    scan.azimuth_rad[i] = azimuth + std * normal(random);
    scan.elevation_rad[i] = 0.0;
    const double truth =
        geometry::stationary_range_rate(estimate.sensor_to_vehicle * geometry::direction(azimuth, 0.0), velocity);
    scan.range_rate_mps[i] = truth + 0.05 * normal(random) + (i % 3 == 0 ? 30.0 : 0.0);
    if (i % 4 == 0) scan.range_rate_mps[i] += 5.0;  // moves
    predicted.push_back(geometry::stationary_range_rate(
        estimate.sensor_to_vehicle * geometry::direction(scan.azimuth_rad[i], 0.0), velocity));
  }
  scan.count = predicted.size();
  ResidualStatistics statistics;
  count_residuals(radar, estimate, scan, ego, predicted, 4.0, statistics);
  EXPECT_NEAR(written(statistics).inlier_ratio, 0.75, 0.01);
  EXPECT_LT(written(statistics).residual_rmse_mps, 0.11);
  EXPECT_NEAR(written(statistics).uncorrected_residual_rmse_mps, 0.35, 0.15) << "0.02 rad and 1 % at 20 m/s";
}

}  // namespace
}  // namespace boresight::alignment
