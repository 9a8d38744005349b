// Which parameters the service may report as observable: decided by the geometry of the detections, not their number.
#include <cmath>
#include <memory>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/alignment_estimator/core/write_estimate.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "tests/unit/alignment_estimator/synthetic.hpp"

namespace boresight::alignment {
namespace {

/// One radar on a drive, under the service's default method.
class Drive {
 public:
  Drive(const SyntheticDrive& drive, unsigned seed, const Config& config = {}) : synthesizer(drive, seed) {
    VehicleConfig vehicle;
    vehicle.radars = {drive.radar()};
    estimator = std::make_unique<Estimator>(vehicle, config);
  }
  void drive_on(int scans) {
    for (int i = 0; i < scans; ++i) {
      synthesizer.next();
      take();
    }
  }
  /// Processes the synthesizer's present scan.
  void take() {
    EgoMotion m{};
    m.header.measurement_time_ns = synthesizer.scan->header.measurement_time_ns;
    m.fields = ego_field::kSpeed | ego_field::kYawRate;
    m.speed_mps = static_cast<float>(synthesizer.ego.speed_mps);
    m.yaw_rate_radps = static_cast<float>(synthesizer.ego.yaw_rate_radps);
    m.speed_std_mps = static_cast<float>(synthesizer.ego.speed_std_mps);
    m.yaw_rate_std_radps = static_cast<float>(synthesizer.ego.yaw_rate_std_radps);
    estimator->add_ego_motion(m);
    static_cast<void>(estimator->add_scan(*synthesizer.scan));
  }
  [[nodiscard]] AlignmentEstimate written() const {
    AlignmentEstimate out{};
    EXPECT_TRUE(estimator->write(1, out));
    return out;
  }
  std::unique_ptr<Estimator> estimator;
  Synthesizer synthesizer;
};

AlignmentEstimate after(const SyntheticDrive& drive, int scans, unsigned seed, const Config& config = {}) {
  Drive run(drive, seed, config);
  run.drive_on(scans);
  return run.written();
}

double std_of(const AlignmentEstimate& e, std::size_t parameter) {
  return std::sqrt(static_cast<double>(e.covariance[5 * parameter]));
}

TEST(Observability, AnyMountingIsAsAccurate) {
  struct Mount {
    double yaw_deg, pitch_deg, roll_deg;
  };
  for (const Mount& mount : {Mount{0.0, 0.0, 0.0}, Mount{0.0, 0.0, 180.0}, Mount{135.0, 3.0, 0.0},
                             Mount{-135.0, -3.0, 2.0}, Mount{180.0, 1.0, 0.0}}) {
    SyntheticDrive drive;
    drive.mount_yaw_rad = mount.yaw_deg * kRadiansPerDegree;
    drive.mount_pitch_rad = mount.pitch_deg * kRadiansPerDegree;
    drive.mount_roll_rad = mount.roll_deg * kRadiansPerDegree;
    drive.elevation_limit_rad = 0.15;
    const AlignmentEstimate e = after(drive, 400, 2);
    EXPECT_NEAR(e.alignment_yaw_rad, drive.yaw_rad, 0.08 * kRadiansPerDegree)
        << mount.yaw_deg << ", " << mount.roll_deg;
    EXPECT_NEAR(e.speed_scale, drive.speed_scale, 5e-4) << mount.yaw_deg << ", " << mount.roll_deg;
    EXPECT_EQ(e.state, AlignmentState::kConverged);
    EXPECT_TRUE(e.is_observable(alignment_axis::kVehicleYaw | alignment_axis::kVehiclePitch));
  }
}

/// A drive straight ahead determines the vehicle's pitch and yaw well, its roll by half.
TEST(Observability, HalfKnownRollIsNoPitchOfARadarThatLooksAside) {
  const double prior_rad = Config{}.windows.priors.rotation_std_rad;
  RadarEstimate estimate;
  estimate.observable = alignment_axis::kVehicleYaw | alignment_axis::kVehiclePitch;
  for (const double yaw_deg : {0.0, 50.0, 90.0, 180.0}) {
    RadarConfig radar;
    radar.mounting_pose.yaw_rad = yaw_deg * kRadiansPerDegree;
    estimate.sensor_to_vehicle = geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
    estimate.covariance = Eigen::Vector4d(1e-8, std::pow(0.45 * prior_rad, 2), 1e-6, 1e-6).asDiagonal();
    AlignmentEstimate out{};
    write_estimate(radar, estimate, prior_rad, out);
    const bool looks_along = yaw_deg == 0.0 || yaw_deg == 180.0;
    EXPECT_TRUE(out.is_observable(alignment_axis::kYaw)) << yaw_deg;
    EXPECT_EQ(out.is_observable(alignment_axis::kPitch), looks_along) << yaw_deg;
    EXPECT_EQ(out.is_observable(alignment_axis::kRoll), yaw_deg == 90.0) << yaw_deg;
    EXPECT_NEAR(std_of(out, 2),
                std::hypot(0.45 * prior_rad * std::sin(radar.mounting_pose.yaw_rad),
                           1e-3 * std::cos(radar.mounting_pose.yaw_rad)),
                1e-6)
        << "as it was estimated";
  }
}

TEST(Observability, AnUnmeasuredElevationStaysInTheSpeedScale) {
  // The height of the reflectors is assumed; no number of scans can verify it on this road.
  SyntheticDrive drive;
  drive.mount_yaw_rad = 0.0;
  drive.azimuth_limit_rad = 0.5;
  drive.elevation_limit_rad = 5.0 * kRadiansPerDegree;
  const AlignmentEstimate measured = after(drive, 1000, 3);
  drive.measures_elevation = false;
  const AlignmentEstimate assumed = after(drive, 1000, 3);
  // Spread over the field of view at every range: a little higher than real reflectors.
  EXPECT_NEAR(assumed.speed_scale, drive.speed_scale, 2.0 * std_of(assumed, 0));
  EXPECT_LT(std_of(measured, 0), 4e-4);
  // The mean cosine over ±5° is 1 − 1/6·0.0873²; the uncertainty has this size.
  EXPECT_GT(std_of(assumed, 0), 3e-4);
  EXPECT_LT(std_of(assumed, 0), 1.3e-3);
  EXPECT_FALSE(assumed.is_observable(alignment_axis::kVehiclePitch));
  EXPECT_FALSE(assumed.is_observable(alignment_axis::kVehicleRoll));
  EXPECT_FALSE(assumed.is_observable(alignment_axis::kPitch));
  EXPECT_FALSE(assumed.is_observable(alignment_axis::kRoll));
}

/// Straight driving, all detections at one angle from the direction of travel.
SyntheticDrive one_azimuth(double from_ahead_deg) {
  SyntheticDrive drive;
  drive.turning_radps = 0.0;
  drive.azimuth_centre_rad = from_ahead_deg * kRadiansPerDegree - drive.mount_yaw_rad;
  drive.azimuth_limit_rad = 0.0;
  return drive;
}

TEST(Observability, OneAzimuthCannotSeparateYawFromSpeed) {
  // Noise of the azimuth looks like a spread of azimuths. Without correction it moved k_v by 65 times its σ.
  for (const double from_ahead_deg : {30.0, 45.0, -60.0}) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
      const SyntheticDrive drive = one_azimuth(from_ahead_deg);
      for (const int scans : {100, 2000}) {
        const AlignmentEstimate e = after(drive, scans, seed);
        EXPECT_NE(e.state, AlignmentState::kConverged);
        EXPECT_FALSE(e.is_observable(alignment_axis::kSpeedScale | alignment_axis::kYaw)) << from_ahead_deg;
        EXPECT_LT(std::abs(e.alignment_yaw_rad - drive.yaw_rad), 3.0 * std_of(e, 1)) << from_ahead_deg << ", " << seed;
        EXPECT_LT(std::abs(e.speed_scale - drive.speed_scale), 3.0 * std_of(e, 0)) << from_ahead_deg << ", " << seed;
      }
    }
  }
}

TEST(Observability, AViewAheadDeterminesOnlySpeedAndAViewAsideOnlyYaw) {
  const double prior_yaw = Config{}.windows.priors.rotation_std_rad,
               prior_scale = Config{}.windows.priors.speed_scale_std;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const AlignmentEstimate ahead = after(one_azimuth(0.0), 1000, seed);
    EXPECT_EQ(ahead.observable & (alignment_axis::kVehicleYaw | alignment_axis::kYaw), 0u);
    EXPECT_TRUE(ahead.is_observable(alignment_axis::kSpeedScale));
    EXPECT_NE(ahead.state, AlignmentState::kConverged);
    EXPECT_GT(std_of(ahead, 1), 0.5 * prior_yaw);
    EXPECT_NEAR(ahead.speed_scale, 1.01, 0.004);
    const SyntheticDrive drive = one_azimuth(90.0);
    const AlignmentEstimate sideways = after(drive, 1000, seed);
    EXPECT_FALSE(sideways.is_observable(alignment_axis::kSpeedScale));
    EXPECT_TRUE(sideways.is_observable(alignment_axis::kYaw | alignment_axis::kVehicleYaw));
    EXPECT_GT(std_of(sideways, 0), 0.5 * prior_scale);
    EXPECT_LT(std::abs(sideways.alignment_yaw_rad - drive.yaw_rad), 3.0 * std_of(sideways, 1));
  }
}

/// The angles' noise is a third of the field of view: least squares with exact angles would be off by 20 σ.
SyntheticDrive narrow_view() {
  SyntheticDrive drive;
  drive.azimuth_centre_rad = -40.0 * kRadiansPerDegree;
  drive.azimuth_limit_rad = 2.0 * kRadiansPerDegree;
  drive.azimuth_std_rad = 0.6 * kRadiansPerDegree;
  return drive;
}

TEST(Observability, ANarrowViewWithCoarseAnglesIsNotBiased) {
  double normalised = 0.0;
  constexpr int kRuns = 40;
  Config config;
  config.filter.azimuth_std_edge = 1.0;  // as for the noise of this drive
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    const SyntheticDrive drive = narrow_view();
    const AlignmentEstimate e = after(drive, 300, seed, config);
    const Eigen::Vector2d error(e.speed_scale - drive.speed_scale, e.alignment_yaw_rad - drive.yaw_rad);
    Eigen::Matrix2d covariance;
    covariance << e.covariance[0], e.covariance[1], e.covariance[4], e.covariance[5];
    normalised += error.dot(covariance.inverse() * error);
  }
  // A linear problem would give 2. k_v and yaw are hardly separable along a curved line. The start of the estimate on
  // it is known to degrees only, so the covariance is too thin across the line: by a factor of 2.7.
  EXPECT_LT(normalised / kRuns, 20.0);
}

TEST(Observability, WithoutAStationaryWorldNothingIsObservable) {
  SyntheticDrive moving;
  moving.outliers = 1.0;
  const SyntheticDrive standing;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Drive run(moving, seed);
    for (int i = 0; i < 1000; ++i) {
      run.drive_on(1);
      ASSERT_EQ(run.written().state, AlignmentState::kWaiting) << "seed " << seed << ", scan " << i;
    }
    const AlignmentEstimate out = run.written();
    EXPECT_EQ(out.observable, 0u);
    EXPECT_EQ(out.speed_scale, 1.0F);
    EXPECT_NEAR(out.alignment_yaw_rad, 0.0F, 1e-6);
    Synthesizer world(standing, seed);
    for (int i = 0; i < 200; ++i) {
      world.next();
      run.synthesizer.scan->number_of_valid_detections = world.scan->number_of_valid_detections;
      const std::int64_t time_ns = run.synthesizer.scan->header.measurement_time_ns + 50'000'000;
      *run.synthesizer.scan = *world.scan;
      run.synthesizer.scan->header.measurement_time_ns = time_ns;
      run.synthesizer.ego = world.ego;
      run.take();
    }
    EXPECT_NEAR(run.written().alignment_yaw_rad, standing.yaw_rad, 0.05 * kRadiansPerDegree)
        << "the stationary reflectors are found afterwards";
    EXPECT_EQ(run.written().state, AlignmentState::kConverged);
  }
}

TEST(Observability, AConvoyIsNoStationaryWorld) {
  // All objects ahead move, and the car approaches them at 5 m/s.
  SyntheticDrive drive;
  drive.mount_yaw_rad = 0.0;
  drive.azimuth_limit_rad = 0.5;
  Drive run(drive, 5);
  for (int i = 0; i < 400; ++i) {
    run.synthesizer.next();
    for (std::uint32_t k = 0; k < drive.detections; ++k) {
      run.synthesizer.scan->range_rate_mps[k] =
          static_cast<float>(-5.0 * std::cos(run.synthesizer.scan->azimuth_rad[k]));
    }
    run.take();
    ASSERT_EQ(run.written().state, AlignmentState::kWaiting) << i;
  }
  EXPECT_EQ(run.written().observable, 0u);
}

TEST(Observability, WaitsAtAStandstillOrWithoutDetections) {
  const SyntheticDrive drive;
  for (const char* what : {"too slow", "too few detections", "nothing but NaN"}) {
    Drive run(drive, 1);
    EXPECT_EQ(run.written().state, AlignmentState::kNoData);
    for (int i = 0; i < 100; ++i) {
      run.synthesizer.next();
      const std::string_view kind = what;
      if (kind == "too slow") run.synthesizer.ego.speed_mps = 1.0;
      if (kind == "too few detections") run.synthesizer.scan->number_of_valid_detections = 3;
      for (std::uint32_t k = 0; k < drive.detections && kind == "nothing but NaN"; ++k) {
        run.synthesizer.scan->range_rate_mps[k] = std::nanf("");
      }
      run.take();
    }
    const AlignmentEstimate out = run.written();
    EXPECT_EQ(out.state, AlignmentState::kWaiting) << what;
    EXPECT_EQ(out.observable, 0u) << what;
    EXPECT_EQ(out.speed_scale, 1.0F) << what;
    EXPECT_EQ(out.vehicle_yaw_rad, 0.0F) << what;
    EXPECT_NEAR(std_of(out, 1), Config{}.windows.priors.rotation_std_rad, 1e-3) << what;
  }
}

}  // namespace
}  // namespace boresight::alignment
