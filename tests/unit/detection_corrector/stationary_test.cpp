// The share of stationary reflectors that are classified as moving matches the configured sigma, whatever the certainty
// of the mounting. A slow object is classified as moving if its range rate shows it.
#include <cmath>
#include <memory>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/detection_corrector/core/corrector.hpp"

namespace boresight::corrector {
namespace {

constexpr std::int64_t kScanTime_ns = 1'000'000'000'000;

/// Standard deviations of all errors.
struct Spread {
  double yaw_deg, pitch_deg, roll_deg;  // of the estimate, about the vehicle's axes
  double speed_scale;
};

struct Case {
  double speed_mps = 20.0;
  double yaw_rate_radps = 0.0;
  double mount_yaw_deg = -45.0;
  double sigma = 2.5;
  Eigen::Vector3d turn_deg = Eigen::Vector3d::Zero();  // estimated rotation about x, y, z
  Spread spread{0.05, 0.1, 0.3, 5e-4};
  bool draws_turn = false;  // the error of the estimate is drawn from its covariance: nothing is known yet
  bool has_estimate = true;
  bool has_elevation = true;
  std::uint32_t observable = alignment_axis::kVehicleYaw | alignment_axis::kVehiclePitch |
                             alignment_axis::kVehicleRoll | alignment_axis::kSpeedScale | alignment_axis::kYawRateBias |
                             alignment_axis::kSlip;
};

RadarConfig radar_of(const Case& c) {
  RadarConfig radar;
  radar.id = 2;
  radar.mounting_pose = {{3.6, -0.7, 0.5}, c.mount_yaw_deg * kRadiansPerDegree, 0.0, 0.0};
  radar.field_of_view.elevation_min_rad = -10.0 * kRadiansPerDegree;
  radar.field_of_view.elevation_max_rad = 10.0 * kRadiansPerDegree;
  radar.noise = {.range_std_m = 0.1,
                 .azimuth_std_rad = 0.3 * kRadiansPerDegree,
                 .elevation_std_rad = 0.5 * kRadiansPerDegree,
                 .range_rate_std_mps = 0.04};
  return radar;
}

/// Drives with errors drawn from the stds in the messages; returns the share of detections classified as moving.
class Simulation {
 public:
  explicit Simulation(const Case& c, std::uint64_t seed = 1) : case_(c), random_(seed) {
    vehicle_.radars.push_back(radar_of(c));
    config_.moving_sigma = c.sigma;
    config_.region_max_m[2] = 50.0;
  }

  /// `over_ground`: velocity of the object as a function of its line of sight (vehicle axes).
  template <typename Velocity>
  double moving_rate(int scans, int per_scan, double azimuth_limit_deg, Velocity&& over_ground) {
    std::size_t moving = 0, all = 0;
    const auto scan = std::make_unique<RadarScan>();
    const auto out = std::make_unique<CorrectedScan>();
    for (int s = 0; s < scans; ++s) {
      Corrector corrector(vehicle_, config_);
      const Eigen::Matrix3d rotation = draw(corrector);
      fill(*scan, per_scan, azimuth_limit_deg * kRadiansPerDegree, rotation, over_ground);
      corrector.correct(*scan, *out);
      for (int i = 0; i < per_scan; ++i) {
        const std::uint16_t flags = out->detection_flags[static_cast<std::size_t>(i)];
        EXPECT_TRUE((flags & corrected_flag::kMoving) != 0 || (flags & corrected_flag::kStationary) != 0);
        moving += (flags & corrected_flag::kMoving) != 0 ? 1 : 0;
        ++all;
      }
    }
    return static_cast<double>(moving) / static_cast<double>(all);
  }
  double stationary_rate(int scans = 3000, int per_scan = 40) {
    return moving_rate(scans, per_scan, 60.0, [](const Eigen::Vector3d&) { return Eigen::Vector3d::Zero(); });
  }

 private:
  double normal(double std) { return std * std::normal_distribution<double>()(random_); }

  /// Passes the side inputs to the corrector; returns the true rotation and stores the true velocity of the sensor.
  Eigen::Matrix3d draw(Corrector& corrector) {
    const RadarConfig& radar = vehicle_.radars[0];
    const Eigen::Vector3d std =
        Eigen::Vector3d(case_.spread.roll_deg, case_.spread.pitch_deg, case_.spread.yaw_deg) * kRadiansPerDegree;
    const Eigen::Vector3d error(normal(std.x()), normal(std.y()), normal(std.z()));
    const double scale_error = normal(case_.spread.speed_scale), estimated_scale = 1.008;
    Eigen::Vector3d turn = case_.turn_deg * kRadiansPerDegree;
    if (case_.draws_turn) turn += 0.5 * Eigen::Vector3d(normal(std.x()), normal(std.y()), normal(std.z()));
    const double bias = case_.has_estimate ? 0.003 + normal(2e-4) : 0.0;
    const double slip = case_.has_estimate ? 0.003 + normal(2e-4) : 0.0;
    const double scale = case_.has_estimate ? estimated_scale + scale_error : 1.0 + scale_error;
    if (case_.has_estimate) {
      AlignmentEstimate e{};
      e.header.source_id = 2;
      e.header.sequence = 1;
      e.header.measurement_time_ns = kScanTime_ns;
      e.state = AlignmentState::kConverged;
      e.observable = case_.observable;
      e.speed_scale = static_cast<float>(estimated_scale);
      e.vehicle_roll_rad = static_cast<float>(turn.x());
      e.vehicle_pitch_rad = static_cast<float>(-turn.y());
      e.vehicle_yaw_rad = static_cast<float>(turn.z());
      e.vehicle_covariance[0] = static_cast<float>(case_.spread.speed_scale * case_.spread.speed_scale);
      e.vehicle_covariance[5] = static_cast<float>(std.z() * std.z());
      e.vehicle_covariance[10] = static_cast<float>(std.y() * std.y());
      e.vehicle_covariance[15] = static_cast<float>(std.x() * std.x());
      e.yaw_rate_bias_radps = e.slip_coefficient_radps2pm = 0.003F;
      e.yaw_rate_bias_std_radps = e.slip_coefficient_std_radps2pm = 2e-4F;
      e.angle_noise_scale = 1.0F;
      EXPECT_TRUE(corrector.add_alignment(e));
    } else {
      turn.setZero();
    }
    const double speed = case_.speed_mps, yaw_rate = case_.yaw_rate_radps;  // true
    EgoMotion m{};
    m.header.measurement_time_ns = kScanTime_ns;
    m.fields = ego_field::kSpeed | ego_field::kYawRate;
    m.speed_std_mps = 0.03F;
    m.yaw_rate_std_radps = 0.002F;
    m.speed_mps = static_cast<float>(speed / scale + normal(0.03));
    m.yaw_rate_radps = static_cast<float>(yaw_rate + bias + normal(0.002));
    corrector.add_ego_motion(m);
    velocity_ = geometry::sensor_velocity(1.0, speed, yaw_rate, radar.mounting_pose.position_m,
                                          -slip * speed * speed * yaw_rate);
    return geometry::so3_exp(error) * geometry::fixed_axes_rotation(turn.z(), -turn.y(), turn.x()) *
           geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
  }

  template <typename Velocity>
  void fill(RadarScan& scan, int count, double limit_rad, const Eigen::Matrix3d& rotation, Velocity&& over_ground) {
    const RadarConfig& radar = vehicle_.radars[0];
    scan.header = {};
    scan.header.source_id = 2;
    scan.header.measurement_time_ns = kScanTime_ns;
    scan.fields = case_.has_elevation ? scan_field::kElevation | scan_field::kStds : scan_field::kStds;
    scan.number_of_valid_detections = static_cast<std::uint32_t>(count);
    std::uniform_real_distribution<double> azimuth(-limit_rad, limit_rad), elevation(-0.1, 0.1), uniform(0.0, 1.0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const double a = azimuth(random_), range = 6.0 + 50.0 * uniform(random_);
      double e = elevation(random_);
      if (!case_.has_elevation) {
        // Reflectors anywhere between the road and the top of an object on it, within the field of view.
        do {
          e = std::asin((4.7 * uniform(random_) * uniform(random_) - 0.5) / range);
        } while (std::abs(e) > 10.0 * kRadiansPerDegree);
      }
      const Eigen::Vector3d direction = rotation * geometry::direction(a, e);
      scan.range_m[i] = static_cast<float>(range);
      scan.azimuth_rad[i] = static_cast<float>(a + normal(radar.noise.azimuth_std_rad));
      scan.elevation_rad[i] =
          case_.has_elevation ? static_cast<float>(e + normal(radar.noise.elevation_std_rad)) : 0.0F;
      scan.range_rate_mps[i] =
          static_cast<float>(direction.dot(over_ground(direction) - velocity_) +
                             normal(radar.noise.range_rate_std_mps) + normal(config_.body_motion_std_mps));
      scan.range_std_m[i] = static_cast<float>(radar.noise.range_std_m);
      scan.azimuth_std_rad[i] = static_cast<float>(radar.noise.azimuth_std_rad);
      scan.elevation_std_rad[i] = static_cast<float>(radar.noise.elevation_std_rad);
      scan.range_rate_std_mps[i] = static_cast<float>(radar.noise.range_rate_std_mps);
      scan.detection_flags[i] = 0;
    }
  }

  Case case_;
  Config config_;
  VehicleConfig vehicle_;
  std::mt19937_64 random_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

double rate_of(double sigma) {
  return std::erfc(sigma / M_SQRT2);
}

void expect_rate_of_sigma(const Case& c, const char* what) {
  const double rate = Simulation(c).stationary_rate();
  EXPECT_GT(rate, 0.5 * rate_of(c.sigma)) << what;
  EXPECT_LT(rate, 2.0 * rate_of(c.sigma)) << what;
}

TEST(StationaryTest, ErrorRateOfAlignedRadarsMatchesSigma) {
  for (const double mount_yaw_deg : {0.0, -45.0, 90.0, 135.0}) {
    for (const double speed_mps : {1.0, 10.0, 35.0}) {
      for (const double sigma : {2.0, 3.0}) {
        Case c;
        c.mount_yaw_deg = mount_yaw_deg;
        c.speed_mps = speed_mps;
        c.yaw_rate_radps = 3.0 / std::max(6.0, speed_mps);
        c.sigma = sigma;
        expect_rate_of_sigma(c, "aligned");
      }
    }
  }
}

TEST(StationaryTest, ErrorRateOfConvergedMisalignedRadarsMatchesSigma) {
  for (const double mount_yaw_deg : {0.0, -45.0, 135.0}) {
    Case c;
    c.mount_yaw_deg = mount_yaw_deg;
    c.turn_deg = {1.5, -2.0, 2.5};
    c.yaw_rate_radps = 0.2;
    expect_rate_of_sigma(c, "misaligned, converged");
  }
}

TEST(StationaryTest, BeforeConvergenceTheCovarianceWidensTheThreshold) {
  for (const double mount_yaw_deg : {0.0, -45.0, 135.0}) {
    Case c;
    c.mount_yaw_deg = mount_yaw_deg;
    c.spread = {2.0, 2.0, 3.0, 0.015};
    c.draws_turn = true;
    expect_rate_of_sigma(c, "not yet converged");
    c.observable = 0;  // only the prior
    c.draws_turn = false;
    expect_rate_of_sigma(c, "not observable");
  }
}

TEST(StationaryTest, WithoutAnEstimateTheConfiguredStdsApply) {
  const Config config;
  Case c;
  c.has_estimate = false;
  const double angle_deg = config.unknown_rotation_std_rad / kRadiansPerDegree;
  c.spread = {angle_deg, angle_deg, angle_deg, config.unknown_speed_scale_std};
  expect_rate_of_sigma(c, "without an estimate");
}

TEST(StationaryTest, UnmeasuredElevationsAreNotMotion) {
  Case c;
  c.has_elevation = false;
  for (const double speed_mps : {10.0, 30.0}) {
    c.speed_mps = speed_mps;
    // The model admits from zero to twice the expected reduction. This is wider than in this world, so there is no
    // lower
    // bound.
    EXPECT_LT(Simulation(c).stationary_rate(), 2.0 * rate_of(c.sigma)) << speed_mps;
  }
}

TEST(StationaryTest, AWalkingPaceIsDetectedAlongTheLineOfSight) {
  Case c;
  c.sigma = Config{}.moving_sigma;
  c.speed_mps = 10.0;
  for (const double sign : {-1.0, 1.0}) {
    const auto along = [&](const Eigen::Vector3d& sight) -> Eigen::Vector3d { return sign * sight; };
    const auto across = [&](const Eigen::Vector3d& sight) -> Eigen::Vector3d {
      return sign * Eigen::Vector3d(-sight.y(), sight.x(), 0.0).normalized();
    };
    EXPECT_GT(Simulation(c).moving_rate(300, 40, 60.0, along), 0.99);
    // Motion across the line of sight cannot be measured.
    EXPECT_LT(Simulation(c).moving_rate(300, 40, 60.0, across), 0.01);
    // Motion forward, along the line of sight of a radar that looks ahead.
    Case ahead = c;
    ahead.mount_yaw_deg = 0.0;
    const auto forward = [&](const Eigen::Vector3d&) -> Eigen::Vector3d { return {sign, 0.0, 0.0}; };
    EXPECT_GT(Simulation(ahead).moving_rate(300, 40, 30.0, forward), 0.99);
    // Motion to the left, along the line of sight of a radar that looks to the left.
    Case left = c;
    left.mount_yaw_deg = 90.0;
    const auto leftward = [&](const Eigen::Vector3d&) -> Eigen::Vector3d { return {0.0, sign, 0.0}; };
    EXPECT_GT(Simulation(left).moving_rate(300, 40, 30.0, leftward), 0.99);
  }
}

TEST(StationaryTest, AnUnknownMountingWidensTheThresholdToTheSide) {
  Case c;
  c.sigma = Config{}.moving_sigma;
  c.speed_mps = 20.0;
  c.mount_yaw_deg = 90.0;
  c.spread = {2.0, 2.0, 3.0, 0.015};
  c.draws_turn = true;
  const auto along = [](const Eigen::Vector3d& sight) -> Eigen::Vector3d { return sight; };
  EXPECT_LT(Simulation(c).moving_rate(300, 40, 30.0, along), 0.1);
}

}  // namespace
}  // namespace boresight::corrector
