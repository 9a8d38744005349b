// What the estimator may claim to know: by the geometry of what it sees, not by how often it sees it.
#include <memory>

#include <gtest/gtest.h>

#include "services/alignment_estimator/core/azimuth_1d.hpp"
#include "tests/unit/alignment_estimator/synthetic.hpp"

namespace boresight::alignment {
namespace {

std::unique_ptr<Azimuth1d> run(const SyntheticDrive& drive, int scans, unsigned seed) {
  auto method = std::make_unique<Azimuth1d>(drive.radar(), Config{});
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

}  // namespace
}  // namespace boresight::alignment
