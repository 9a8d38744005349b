// The parts of the filter, each against an independent reference.
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/alignment_estimator/core/filter/scan_sums.hpp"
#include "services/alignment_estimator/core/filter/spread.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {
namespace {

/// Detections of one radar that moves with g, with noise in all values.
struct Cloud {
  Sightings sightings;
  Eigen::Vector3d g;
  void draw(std::mt19937& random, double azimuth_std, double elevation_std, double elevation_spread) {
    std::normal_distribution<double> normal(0.0, 1.0);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    RadarConfig radar;
    ScanDetections scan;
    scan.count = 500;
    scan.has_elevation = true;
    for (std::size_t i = 0; i < scan.count; ++i) {
      const double azimuth = unit(random), elevation = elevation_spread * normal(random);
      scan.azimuth_rad[i] = azimuth + azimuth_std * normal(random);
      scan.elevation_rad[i] = elevation + elevation_std * normal(random);
      scan.range_rate_mps[i] = -geometry::direction(azimuth, elevation).dot(g) + 0.03 * normal(random);
      scan.azimuth_std_rad[i] = azimuth_std;
      scan.elevation_std_rad[i] = elevation_std;
      scan.range_rate_std_mps[i] = 0.03;
    }
    take_sightings(scan, radar, {radar, 0.0}, 1.0, 1.0, sightings);
  }
};

TEST(ScanSums, ScoreHasZeroMeanAtTheTruth) {
  // Without the corrections for errors in variables the third component is off by dozens of its σ.
  std::mt19937 random(2);
  auto cloud = std::make_unique<Cloud>();
  cloud->g = {20.0, -14.0, 0.5};
  Judgement judgement;
  judgement.velocity_variance.setZero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d score = Eigen::Vector3d::Zero();
  for (int i = 0; i < 400; ++i) {
    cloud->draw(random, 0.01, 0.02, 0.06);
    const ScanSums sums = sum_scan(run_of(cloud->sightings), cloud->g, judgement);
    information += sums.information - sums.from_noise;
    score += sums.score;
  }
  const Eigen::Vector3d off = information.inverse() * score;
  const Eigen::Vector3d std = information.inverse().diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < 3; ++i) EXPECT_LT(std::abs(off(i)), 3.5 * std(i)) << i;
  EXPECT_LT(off.norm(), 5e-3) << "m/s of 24";
}

TEST(Spread, NoiseOfAnglesDoesNotCountAsSpread) {
  std::mt19937 random(3);
  auto cloud = std::make_unique<Cloud>();
  cloud->g = {20.0, -14.0, 0.0};
  Judgement judgement;
  judgement.velocity_variance.setZero();
  for (const double spread : {0.0, 0.06}) {
    Spread seen;
    for (int i = 0; i < 50; ++i) {
      cloud->draw(random, 0.005, 0.01, spread);
      const ScanSums sums = sum_scan(run_of(cloud->sightings), cloud->g, judgement);
      seen.add(sums.information, sums.from_noise, sums.inliers, 1.0);
    }
    const double vertical = (seen.support(true, 0.35).share * Eigen::Vector3d::UnitZ()).norm();
    EXPECT_NEAR(vertical, spread > 0.0 ? 1.0 : 0.0, 0.05);
    EXPECT_LT((seen.support(false, 0.35).share * Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  }
}

TEST(ScanSums, RangeRatesAreUnfoldedToThePrediction) {
  std::mt19937 random(4);
  auto cloud = std::make_unique<Cloud>();
  cloud->g = {25.0, 5.0, 0.0};
  Judgement judgement;
  judgement.velocity_variance.setZero();
  cloud->draw(random, 0.002, 0.002, 0.05);
  const ScanSums plain = sum_scan(run_of(cloud->sightings), cloud->g, judgement);
  cloud->sightings.ambiguity_mps = 10.0;
  for (std::size_t i = 0; i < cloud->sightings.count; ++i) {
    double& rate = cloud->sightings.range_rate_mps[i];
    rate -= 10.0 * std::floor(rate / 10.0 + 0.5);
  }
  const ScanSums folded = sum_scan(run_of(cloud->sightings), cloud->g, judgement);
  EXPECT_EQ(folded.inliers, plain.inliers);
  EXPECT_LT((folded.score - plain.score).norm(), 1e-6 * plain.score.norm() + 1e-6);
}

}  // namespace
}  // namespace boresight::alignment
