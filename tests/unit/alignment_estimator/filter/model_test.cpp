// The parts of the filter, each against an independent reference.
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/alignment_estimator/core/filter/motion_model.hpp"
#include "services/alignment_estimator/core/filter/scan_sums.hpp"
#include "services/alignment_estimator/core/filter/spread.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {
namespace {

TEST(MotionModel, EveryColumnIsTheNumericalGradient) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const std::array<double, 3> position{3.65, -0.75, 0.5};
  for (int trial = 0; trial < 50; ++trial) {
    JointState at(2);
    at.speed_scale = 1.0 + 0.03 * unit(random);
    at.yaw_rate_bias_radps = 0.003 * unit(random);
    at.slip_radps2pm = 0.005 * unit(random);
    at.pitch_per_acceleration_radps2pm = 0.003 + 0.001 * unit(random);
    at.nuisances << 0.0, 0.0, 0.005 * unit(random), 0.0;
    at.elevation_excess[1] = unit(random);
    at.lowering[1] = 0.02;
    at.sensor_to_vehicle[1] = geometry::so3_exp({unit(random), unit(random), 3.0 * unit(random)});
    at.linearised[1] = at.sensor_to_vehicle[1];
    at.linearised_speed_scale = at.speed_scale;
    const ScanMotion3d motion{20.0 + 10.0 * unit(random), 0.3 + 0.1 * unit(random), unit(random)};
    const VelocityGradient gradient = sensor_velocity(at, at.nuisances, 1, position, motion, 1.0).gradient;
    const auto moved = [&](Eigen::Index column, double h) {
      JointState to = at;
      switch (column) {
        case column::kSpeedScale:
          to.speed_scale += h;
          break;
        case column::kYawRateBias:
          to.yaw_rate_bias_radps += h;
          break;
        case column::kSlip:
          to.slip_radps2pm += h;
          break;
        case column::kPitchPerAcceleration:
          to.pitch_per_acceleration_radps2pm += h;
          break;
        case column::kSpeed:
        case column::kYawRate:
        case column::kBodyPitch:
        case column::kSideSlip:
          to.nuisances(column - column::kNuisances) += h;
          break;
        case column::kShared + column::kElevations:
          to.elevation_excess[1] += h;
          break;
        case column::kShared + column::kAngleNoise:
          break;  // acts through SensorVelocity::seen
        default:
          to.sensor_to_vehicle[1] =
              geometry::so3_exp(h * Eigen::Vector3d::Unit(column - column::kShared)) * to.sensor_to_vehicle[1];
      }
      return sensor_velocity(to, to.nuisances, 1, position, motion).g;
    };
    for (Eigen::Index column = 0; column < column::kTouched; ++column) {
      constexpr double h = 1e-6;
      const Eigen::Vector3d numeric = (moved(column, h) - moved(column, -h)) / (2.0 * h);
      EXPECT_LT((gradient.row(column).transpose() - numeric).norm(), 1e-5 * (1.0 + numeric.norm())) << column;
    }
  }
}

TEST(JointState, UpdateIsThatOfTheDenseInformationFilter) {
  JointState state(2);
  for (Eigen::Index i = 0; i < state.size(); ++i) state.set_variance(i, 1e-4 * static_cast<double>(1 + i));
  state.set_covariance(0, 9, 5e-5);
  const auto dense = [&] {
    Eigen::MatrixXd p(state.size(), state.size());
    for (Eigen::Index i = 0; i < state.size(); ++i) {
      for (Eigen::Index j = 0; j < state.size(); ++j) p(i, j) = state.covariance(i, j);
    }
    return p;
  };
  const Eigen::MatrixXd before = dense();
  const SensorVelocity velocity = sensor_velocity(state, state.nuisances, 1, {3.0, 0.5, 0.5}, {15.0, 0.2, 0.0});
  Eigen::Matrix3d information;
  information << 900.0, 20.0, 5.0, 20.0, 700.0, -10.0, 5.0, -10.0, 40.0;
  const Eigen::Vector3d score(3.0, -2.0, 1.0);
  state.project(1, velocity.gradient);
  ASSERT_TRUE(state.update(information, score));
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(state.size(), 3);
  full.topRows(column::kShared) = velocity.gradient.topRows(column::kShared);
  full.middleRows(column::of_radar(1), column::kPerRadar) = velocity.gradient.bottomRows(column::kPerRadar);
  const Eigen::MatrixXd expected = (before.inverse() + full * information * full.transpose()).inverse();
  EXPECT_LT((dense() - expected).norm(), 1e-9 * expected.norm());
  const Eigen::VectorXd step = expected * full * score;
  EXPECT_NEAR(state.speed_scale, 1.0 + step(0), 1e-12);
  EXPECT_LT((geometry::so3_log(state.sensor_to_vehicle[1]) - step.segment<3>(column::of_radar(1))).norm(), 1e-12);
}

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
