// What the estimator may claim to know: by the geometry of what it sees, not by how often it sees it.
#include <memory>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/alignment_estimator/core/azimuth_1d.hpp"
#include "tests/unit/alignment_estimator/synthetic.hpp"

namespace boresight::alignment {
namespace {

std::unique_ptr<YawFilter> run(const SyntheticDrive& drive, int scans, unsigned seed) {
  auto method = std::make_unique<YawFilter>(drive.radar(), Config{});
  Synthesizer synthesizer(drive, seed);
  for (int i = 0; i < scans; ++i) {
    synthesizer.next();
    method->process(*synthesizer.scan, synthesizer.ego);
  }
  return method;
}

TEST(Observability, AnyMountingIsAsGood) {
  struct Mount {
    double yaw_deg, pitch_deg, roll_deg;
  };
  for (const Mount& mount : {Mount{0.0, 0.0, 0.0}, Mount{0.0, 0.0, 180.0}, Mount{135.0, 3.0, 0.0},
                             Mount{-135.0, -3.0, 2.0}, Mount{180.0, 1.0, 0.0}}) {
    SyntheticDrive drive;
    drive.mount_yaw_rad = mount.yaw_deg * kDegree;
    drive.mount_pitch_rad = mount.pitch_deg * kDegree;
    drive.mount_roll_rad = mount.roll_deg * kDegree;
    drive.elevation_limit_rad = 0.15;
    const auto method = run(drive, 400, 2);
    EXPECT_NEAR(method->yaw_rad(), drive.yaw_rad, 0.03 * kDegree) << mount.yaw_deg << ", " << mount.roll_deg;
    EXPECT_NEAR(method->speed_scale(), drive.speed_scale, 5e-4) << mount.yaw_deg << ", " << mount.roll_deg;
    EXPECT_EQ(method->state(), AlignmentState::kConverged);
  }
}

TEST(Observability, AnElevationThatIsNotMeasuredStaysInTheSpeedScale) {
  // Where in the view reflectors stand is assumed; no number of scans tells whether that is so on this road.
  SyntheticDrive drive;
  drive.mount_yaw_rad = 0.0;
  drive.azimuth_limit_rad = 0.5;
  drive.elevation_limit_rad = 5.0 * kDegree;
  const auto measured = run(drive, 1000, 3);
  drive.measures_elevation = false;
  const auto assumed = run(drive, 1000, 3);
  EXPECT_NEAR(assumed->speed_scale(), drive.speed_scale, 5e-4) << "spread over the view as assumed";
  const double measured_std = std::sqrt(measured->covariance()(0, 0));
  const double assumed_std = std::sqrt(assumed->covariance()(0, 0));
  EXPECT_LT(measured_std, 4e-4);
  // Standard deviation of the cosine of an angle spread evenly over ±5°, from its moments: 1/2·0.0873²·sqrt(1/5 − 1/9).
  EXPECT_NEAR(assumed_std, 0.00114, 1.5e-4);
}

/// Straight on, everything seen at one angle from the direction of travel.
SyntheticDrive one_azimuth(double from_ahead_deg) {
  SyntheticDrive drive;
  drive.turning_radps = 0.0;
  drive.azimuth_centre_rad = from_ahead_deg * kDegree - drive.mount_yaw_rad;
  drive.azimuth_limit_rad = 0.0;
  return drive;
}

AlignmentEstimate written(const YawFilter& method) {
  AlignmentEstimate out{};
  method.write(out);
  return out;
}

TEST(Observability, OneAzimuthCannotTellYawFromSpeed) {
  // The noise of the azimuth makes it look like a spread of azimuths; taken for one, it moved k_v by 65 times its σ.
  const Config config;
  for (const double from_ahead_deg : {30.0, 45.0, -60.0}) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
      const SyntheticDrive drive = one_azimuth(from_ahead_deg);
      for (const int scans : {100, 2000}) {
        const auto method = run(drive, scans, seed);
        const AlignmentEstimate out = written(*method);
        EXPECT_NE(out.state, AlignmentState::kConverged);
        EXPECT_NE(out.observable, alignment_axis::kSpeedScale | alignment_axis::kYaw) << from_ahead_deg;
        const double yaw_std = std::sqrt(method->covariance()(1, 1)), scale_std = std::sqrt(method->covariance()(0, 0));
        // One combination is known, the other has the prior's spread: neither std can be below what that leaves.
        const double tangent = std::tan(std::abs(from_ahead_deg) * kDegree);
        const double a = config.prior_speed_scale_std, b = config.prior_yaw_std_rad * tangent;
        const double left = a * b / std::hypot(a, b);
        EXPECT_NEAR(scale_std / left, 1.0, 0.15) << from_ahead_deg << ", seed " << seed;
        EXPECT_NEAR(yaw_std * tangent / left, 1.0, 0.15) << from_ahead_deg << ", seed " << seed;
        EXPECT_LT(std::abs(method->yaw_rad() - drive.yaw_rad), 3.0 * yaw_std) << from_ahead_deg << ", seed " << seed;
        EXPECT_LT(std::abs(method->speed_scale() - drive.speed_scale), 3.0 * scale_std)
            << from_ahead_deg << ", seed " << seed;
      }
    }
  }
}

TEST(Observability, AheadTellsOnlySpeedAndSidewaysOnlyYaw) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const auto ahead = run(one_azimuth(0.0), 1000, seed);
    EXPECT_EQ(written(*ahead).observable, alignment_axis::kSpeedScale);
    EXPECT_NE(ahead->state(), AlignmentState::kConverged);
    EXPECT_NEAR(written(*ahead).covariance[5], Config{}.prior_yaw_std_rad * Config{}.prior_yaw_std_rad, 2e-4);
    EXPECT_NEAR(ahead->speed_scale(), 1.01, 0.004);
    const SyntheticDrive drive = one_azimuth(90.0);
    const auto sideways = run(drive, 1000, seed);
    EXPECT_EQ(written(*sideways).observable, alignment_axis::kYaw | alignment_axis::kVehicleYaw);
    EXPECT_NEAR(written(*sideways).covariance[0], Config{}.prior_speed_scale_std * Config{}.prior_speed_scale_std,
                1e-4);
    EXPECT_LT(std::abs(sideways->yaw_rad() - drive.yaw_rad), 3.0 * std::sqrt(sideways->covariance()(1, 1)));
  }
}

TEST(Observability, ANarrowViewWithCoarseAnglesIsNotBiased) {
  // The angles' noise is a third of the view: least squares that takes angles for exact is off by 20 σ.
  double normalised = 0.0;
  constexpr int kRuns = 40;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    SyntheticDrive drive;
    drive.azimuth_centre_rad = -40.0 * kDegree;
    drive.azimuth_limit_rad = 2.0 * kDegree;
    drive.azimuth_std_rad = 0.6 * kDegree;
    const auto method = run(drive, 300, seed);
    const Eigen::Vector2d error(method->speed_scale() - drive.speed_scale, method->yaw_rad() - drive.yaw_rad);
    normalised += error.dot(method->covariance().inverse() * error);
  }
  EXPECT_LT(normalised / kRuns, 3.2) << "χ² with 80 degrees of freedom stays below in 99.9 %";
}

TEST(Observability, WithoutAStationaryWorldNothingIsClaimed) {
  SyntheticDrive moving;
  moving.outliers = 1.0;
  const SyntheticDrive standing;
  const Config config;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    YawFilter method(moving.radar(), config);
    Synthesizer traffic(moving, seed), world(standing, seed);
    for (int i = 0; i < 1000; ++i) {
      traffic.next();
      method.process(*traffic.scan, traffic.ego);
      ASSERT_EQ(method.state(), AlignmentState::kWaiting) << "seed " << seed << ", scan " << i;
    }
    const AlignmentEstimate out = written(method);
    EXPECT_EQ(out.observable, 0u);
    EXPECT_EQ(out.speed_scale, 1.0F);
    EXPECT_EQ(out.alignment_yaw_rad, 0.0F);
    EXPECT_NEAR(out.covariance[5], config.prior_yaw_std_rad * config.prior_yaw_std_rad, 1e-6);
    for (int i = 0; i < 200; ++i) {
      world.next();
      method.process(*world.scan, world.ego);
    }
    EXPECT_NEAR(method.yaw_rad(), standing.yaw_rad, 0.05 * kDegree) << "and what then stands still is found";
    EXPECT_EQ(method.state(), AlignmentState::kConverged);
  }
}

TEST(Observability, AConvoyIsNoStationaryWorld) {
  // All that a radar sees ahead drives on, the car closes in on it at 5 m/s.
  SyntheticDrive drive;
  drive.mount_yaw_rad = 0.0;
  drive.azimuth_limit_rad = 0.5;
  YawFilter method(drive.radar(), Config{});
  Synthesizer synthesizer(drive, 5);
  for (int i = 0; i < 400; ++i) {
    synthesizer.next();
    for (std::uint32_t k = 0; k < drive.detections; ++k) {
      synthesizer.scan->range_rate_mps[k] = static_cast<float>(-5.0 * std::cos(synthesizer.scan->azimuth_rad[k]));
    }
    method.process(*synthesizer.scan, synthesizer.ego);
    ASSERT_EQ(method.state(), AlignmentState::kWaiting) << i;
  }
  EXPECT_EQ(written(method).observable, 0u);
}

}  // namespace
}  // namespace boresight::alignment
