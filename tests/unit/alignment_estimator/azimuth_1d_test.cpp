#include "services/alignment_estimator/core/azimuth_1d.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/alignment_estimator/core/range_rate_model.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/alignment_estimator/synthetic.hpp"

namespace boresight::alignment {
namespace {

/// No systematic floor and no drift: what the data alone say.
Config pure() {
  Config c;
  c.systematic_yaw_std_rad = c.systematic_speed_scale_std = 0.0;
  c.yaw_drift_rad_per_sqrt_s = c.speed_scale_drift_per_sqrt_s = 0.0;
  c.ego_error_correlation_s = 0.0;
  return c;
}

std::unique_ptr<YawFilter> run(const SyntheticDrive& drive, const Config& config, int scans, unsigned seed) {
  auto method = std::make_unique<YawFilter>(drive.radar(), config);
  Synthesizer synthesizer(drive, seed);
  for (int i = 0; i < scans; ++i) {
    synthesizer.next();
    method->process(*synthesizer.scan, synthesizer.ego);
  }
  return method;
}

TEST(RangeRateModel, GradientIsTheNumericalOne) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d direction = Eigen::Vector3d(unit(random), unit(random), 0.3 * unit(random)).normalized();
    const ScanMotion motion{15.0 + 10.0 * unit(random), 0.3 * unit(random), 3.6 * unit(random), unit(random)};
    const Eigen::Vector4d at(1.0 + 0.03 * unit(random), 0.1 * unit(random), 0.0, 0.0);
    const auto value = [&](const Eigen::Vector4d& x) {
      ScanMotion m = motion;
      m.speed_mps += x(2);
      m.yaw_rate_radps += x(3);
      return predict_range_rate(direction, m, x(0), x(1)).range_rate_mps;
    };
    const Eigen::Vector4d gradient = predict_range_rate(direction, motion, at(0), at(1)).gradient;
    for (Eigen::Index k = 0; k < 4; ++k) {
      constexpr double h = 1e-6;
      Eigen::Vector4d up = at, down = at;
      up(k) += h;
      down(k) -= h;
      EXPECT_NEAR(gradient(k), (value(up) - value(down)) / (2.0 * h), 1e-6) << k;
    }
  }
}

TEST(Azimuth1d, FindsYawAndSpeedScale) {
  for (const double yaw_deg : {-3.0, -0.4, 0.0, 2.5}) {
    for (const double scale : {0.98, 1.0, 1.02}) {
      SyntheticDrive drive;
      drive.yaw_rad = yaw_deg * kDegree;
      drive.speed_scale = scale;
      const auto method = run(drive, Config{}, 400, 7);
      EXPECT_NEAR(method->yaw_rad(), drive.yaw_rad, 0.03 * kDegree) << yaw_deg << ", " << scale;
      EXPECT_NEAR(method->speed_scale(), scale, 5e-4) << yaw_deg << ", " << scale;
      EXPECT_EQ(method->state(), AlignmentState::kConverged);
    }
  }
}

TEST(Azimuth1d, FortyPercentOutliersDoNotMoveIt) {
  SyntheticDrive drive;
  drive.outliers = 0.4;
  const auto method = run(drive, Config{}, 600, 3);
  EXPECT_NEAR(method->yaw_rad(), drive.yaw_rad, 0.04 * kDegree);
  EXPECT_NEAR(method->speed_scale(), drive.speed_scale, 5e-4);
}

TEST(Azimuth1d, AMirroredWorldGivesTheMirroredAnswer) {
  SyntheticDrive drive;
  SyntheticDrive mirror = drive;
  mirror.mirrored = true;
  const auto a = run(drive, Config{}, 200, 5), b = run(mirror, Config{}, 200, 5);
  // To the single precision of the messages, whose rounding is not mirrored.
  EXPECT_NEAR(a->yaw_rad(), -b->yaw_rad(), 1e-5);
  EXPECT_NEAR(a->speed_scale(), b->speed_scale(), 1e-6);
  EXPECT_NEAR(a->covariance()(1, 1), b->covariance()(1, 1), 1e-4 * a->covariance()(1, 1));
}

TEST(Azimuth1d, TheOrderOfDetectionsDoesNotMatter) {
  const SyntheticDrive drive;
  YawFilter forward(drive.radar(), Config{}), backward(drive.radar(), Config{});
  Synthesizer synthesizer(drive, 9);
  for (int i = 0; i < 100; ++i) {
    synthesizer.next();
    forward.process(*synthesizer.scan, synthesizer.ego);
    RadarScan& scan = *synthesizer.scan;
    std::reverse(scan.azimuth_rad.data(), scan.azimuth_rad.data() + scan.number_of_valid_detections);
    std::reverse(scan.range_rate_mps.data(), scan.range_rate_mps.data() + scan.number_of_valid_detections);
    backward.process(scan, synthesizer.ego);
  }
  EXPECT_NEAR(forward.yaw_rad(), backward.yaw_rad(), 1e-9);
  EXPECT_NEAR(forward.speed_scale(), backward.speed_scale(), 1e-9);
}

TEST(Azimuth1d, IsTheBatchTotalLeastSquaresOfTheSameData) {
  // Without outliers, and with a gate that cuts nothing off, the recursive filter is total least squares over
  // everything with the prior, which is solved here in one go, with an unknown azimuth for each detection.
  SyntheticDrive drive;
  drive.outliers = 0.0;
  Config config = pure();
  config.outlier_gate_sigma = 1e4;
  config.start_gate_mps = 0.0;
  const RadarConfig radar = drive.radar();
  const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
  YawFilter filter(radar, config);
  Synthesizer synthesizer(drive, 11);
  struct Row {
    double azimuth, range_rate;
    ScanMotion motion;
    double correction = 0.0;  // of the azimuth
  };
  std::vector<Row> rows;
  for (int i = 0; i < 60; ++i) {
    synthesizer.next();
    synthesizer.ego.speed_std_mps = synthesizer.ego.yaw_rate_std_radps = 0.0;
    filter.process(*synthesizer.scan, synthesizer.ego);
    const ScanMotion motion{synthesizer.ego.speed_mps, synthesizer.ego.yaw_rate_radps,
                            radar.mounting_pose.position_m[0], radar.mounting_pose.position_m[1]};
    for (std::uint32_t k = 0; k < drive.detections; ++k) {
      rows.push_back({synthesizer.scan->azimuth_rad[k], synthesizer.scan->range_rate_mps[k], motion});
    }
  }
  Eigen::Vector2d x(1.0, 0.0);
  const Eigen::Vector2d prior_variance(config.prior_speed_scale_std * config.prior_speed_scale_std,
                                       config.prior_yaw_std_rad * config.prior_yaw_std_rad);
  const double azimuth_variance = drive.azimuth_std_rad * drive.azimuth_std_rad;
  Eigen::Matrix2d information;
  for (int iteration = 0; iteration < 20; ++iteration) {
    information = prior_variance.cwiseInverse().asDiagonal();
    Eigen::Vector2d right = prior_variance.cwiseInverse().cwiseProduct(Eigen::Vector2d(1.0, 0.0) - x);
    for (Row& row : rows) {
      const auto predict = [&](double azimuth) {
        return predict_range_rate(nominal * geometry::direction(azimuth, 0.0), row.motion, x(0), x(1));
      };
      constexpr double h = 1e-6;
      const double azimuth = row.azimuth + row.correction;
      const RangeRatePrediction p = predict(azimuth);
      const double slope = (predict(azimuth + h).range_rate_mps - predict(azimuth - h).range_rate_mps) / (2.0 * h);
      const double variance = drive.range_rate_std_mps * drive.range_rate_std_mps + slope * slope * azimuth_variance;
      const double residual = row.range_rate - p.range_rate_mps + slope * row.correction;
      row.correction = azimuth_variance * slope * residual / variance;
      const Eigen::Vector2d g = p.gradient.head<2>();
      information += g * g.transpose() / variance;
      right += g * residual / variance;
    }
    x += information.inverse() * right;
  }
  const Eigen::Matrix2d covariance = information.inverse();
  EXPECT_NEAR(filter.speed_scale(), x(0), 0.15 * std::sqrt(covariance(0, 0)));
  EXPECT_NEAR(filter.yaw_rad(), x(1), 0.15 * std::sqrt(covariance(1, 1)));
  EXPECT_NEAR(std::sqrt(filter.covariance()(0, 0) / covariance(0, 0)), 1.0, 0.03);
  EXPECT_NEAR(std::sqrt(filter.covariance()(1, 1) / covariance(1, 1)), 1.0, 0.03);
}

TEST(Azimuth1d, NearTheCramerRaoBoundAndHonestAboutIt) {
  // The bound: information of the inliers alone, known as such, with the noise of azimuth and range rate.
  SyntheticDrive drive;
  drive.outliers = 0.2;
  constexpr int kRuns = 120, kScans = 120;
  const Config config = pure();
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  const RadarConfig radar = drive.radar();
  const Eigen::Matrix3d actual = geometry::sensor_to_vehicle(radar.mounting_pose, drive.yaw_rad, 0.0, 0.0);
  for (int scan = 0; scan < kScans; ++scan) {
    const ScanMotion motion{drive.speed_mps(scan), drive.yaw_rate_radps(scan), radar.mounting_pose.position_m[0],
                            radar.mounting_pose.position_m[1]};
    const Eigen::Vector3d velocity = geometry::sensor_velocity(drive.speed_scale, motion.speed_mps,
                                                               motion.yaw_rate_radps, radar.mounting_pose.position_m);
    constexpr int kAngles = 200;
    for (int k = 0; k < kAngles; ++k) {
      const double a = drive.azimuth_limit_rad * (2.0 * (k + 0.5) / kAngles - 1.0);
      const Eigen::Vector3d u = actual * geometry::direction(a, 0.0);
      const double by_azimuth =
          velocity.dot(actual * Eigen::Vector3d(-std::sin(a), std::cos(a), 0.0)) * drive.azimuth_std_rad;
      const double variance = drive.range_rate_std_mps * drive.range_rate_std_mps + by_azimuth * by_azimuth;
      const Eigen::Vector2d g(-motion.speed_mps * u.x(), velocity.x() * u.y() - velocity.y() * u.x());
      information += (1.0 - drive.outliers) * drive.detections / kAngles * g * g.transpose() / variance;
    }
  }
  const Eigen::Matrix2d bound = information.inverse();
  Eigen::Vector2d square = Eigen::Vector2d::Zero();
  double normalised = 0.0;
  for (int i = 0; i < kRuns; ++i) {
    const auto method = run(drive, config, kScans, 1000U + static_cast<unsigned>(i));
    const Eigen::Vector2d error(method->speed_scale() - drive.speed_scale, method->yaw_rad() - drive.yaw_rad);
    square += error.cwiseAbs2();
    normalised += error.dot(method->covariance().inverse() * error);
  }
  const Eigen::Vector2d rmse = (square / kRuns).cwiseSqrt();
  const Eigen::Vector2d ratio = rmse.cwiseQuotient(bound.diagonal().cwiseSqrt());
  const double mean_nees = normalised / kRuns;
  std::printf("k_v: RMSE %.2e, %.2f of the bound; yaw: RMSE %.4f°, %.2f of the bound; mean NEES %.2f (2 expected)\n",
              rmse(0), ratio(0), rmse(1) / kDegree, ratio(1), mean_nees);
  // 120 runs know a ratio to 6 %: below 0.85 the bound itself would be wrong.
  EXPECT_GT(ratio.minCoeff(), 0.85);
  EXPECT_LT(ratio.maxCoeff(), 1.5);
  // χ² with 240 degrees of freedom: 99.9 % lie within.
  EXPECT_GT(mean_nees, 1.45) << "too modest";
  EXPECT_LT(mean_nees, 2.66) << "too proud";
}

TEST(Azimuth1d, ErrorsOfTheSpeedSignalAreInItsCovariance) {
  SyntheticDrive drive;
  drive.speed_std_mps = 0.1;
  drive.yaw_rate_std_radps = 0.004;
  double normalised = 0.0;
  constexpr int kRuns = 60;
  for (int i = 0; i < kRuns; ++i) {
    const auto method = run(drive, pure(), 120, 2000U + static_cast<unsigned>(i));
    const Eigen::Vector2d error(method->speed_scale() - drive.speed_scale, method->yaw_rad() - drive.yaw_rad);
    normalised += error.dot(method->covariance().inverse() * error);
  }
  EXPECT_LT(normalised / kRuns, 2.96) << "too proud: χ² with 120 degrees of freedom stays below in 99.9 %";
}

TEST(Azimuth1d, StandingStillOrAloneItWaits) {
  SyntheticDrive drive;
  YawFilter method(drive.radar(), Config{});
  EXPECT_EQ(method.state(), AlignmentState::kNoData);
  Synthesizer synthesizer(drive, 1);
  const auto expect_untouched = [&](const char* what) {
    EXPECT_EQ(method.state(), AlignmentState::kWaiting) << what;
    EXPECT_EQ(method.speed_scale(), 1.0) << what;
    EXPECT_EQ(method.yaw_rad(), 0.0) << what;
  };
  for (int i = 0; i < 100; ++i) {
    synthesizer.next();
    EgoSample slow = synthesizer.ego;
    slow.speed_mps = 1.0;
    method.process(*synthesizer.scan, slow);
  }
  expect_untouched("too slow");
  for (int i = 0; i < 100; ++i) {
    synthesizer.next();
    method.process(*synthesizer.scan, EgoSample{});
  }
  expect_untouched("no ego motion");
  for (int i = 0; i < 100; ++i) {
    synthesizer.next();
    synthesizer.scan->number_of_valid_detections = 3;
    method.process(*synthesizer.scan, synthesizer.ego);
  }
  expect_untouched("too few detections");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < 100; ++i) {
    synthesizer.next();
    for (std::uint32_t k = 0; k < drive.detections; ++k) synthesizer.scan->range_rate_mps[k] = nan;
    method.process(*synthesizer.scan, synthesizer.ego);
  }
  expect_untouched("nothing but NaN");
  AlignmentEstimate out{};
  method.write(out);
  EXPECT_EQ(out.observable, 0u);
  EXPECT_NEAR(out.covariance[5], Config{}.prior_yaw_std_rad * Config{}.prior_yaw_std_rad, 1e-4);
}

TEST(Azimuth1d, NotANumberAmongGoodOnesHarmsNothing) {
  const SyntheticDrive drive;
  YawFilter method(drive.radar(), Config{});
  Synthesizer synthesizer(drive, 6);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < 300; ++i) {
    synthesizer.next();
    synthesizer.scan->azimuth_rad[0] = nan;
    synthesizer.scan->range_rate_mps[1] = std::numeric_limits<float>::infinity();
    synthesizer.scan->elevation_rad[2] = nan;
    method.process(*synthesizer.scan, synthesizer.ego);
  }
  EXPECT_NEAR(method.yaw_rad(), drive.yaw_rad, 0.05 * kDegree);
}

TEST(Azimuth1d, FollowsAnEstimateThatItPublishes) {
  const SyntheticDrive drive;
  const auto method = run(drive, Config{}, 400, 8);
  AlignmentEstimate out{};
  method->write(out);
  EXPECT_EQ(out.state, AlignmentState::kConverged);
  EXPECT_EQ(out.observable, alignment_axis::kSpeedScale | alignment_axis::kYaw | alignment_axis::kVehicleYaw);
  EXPECT_NEAR(out.alignment_yaw_rad, method->yaw_rad(), 1e-7);
  EXPECT_NEAR(out.covariance[5], method->covariance()(1, 1), 1e-9);
  EXPECT_GT(out.kpis.inlier_ratio, 0.7F);
  EXPECT_LT(out.kpis.residual_rmse_mps, 0.12F);
  EXPECT_GT(out.kpis.uncorrected_residual_rmse_mps, 0.2F);
  EXPECT_EQ(out.kpis.scans_used, 400u);
  EXPECT_NEAR(out.kpis.seconds_of_drive, 20.0F, 0.2F);
}

TEST(Azimuth1d, AllocatesNothing) {
  const SyntheticDrive drive;
  YawFilter method(drive.radar(), Config{});
  Synthesizer synthesizer(drive, 10);
  AlignmentEstimate out{};
  for (int i = 0; i < 10; ++i) {
    synthesizer.next();
    const std::uint64_t before = runtime::counted_allocations();
    {
      const runtime::CountAllocations counting;
      method.process(*synthesizer.scan, synthesizer.ego);
      method.write(out);
    }
    ASSERT_EQ(runtime::counted_allocations(), before);
  }
}

}  // namespace
}  // namespace boresight::alignment
