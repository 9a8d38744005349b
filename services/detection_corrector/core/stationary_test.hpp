// Tests whether the range rate of a detection agrees with a stationary reflector.
// Equations: docs/algorithms/correction.md (C5)(C6).
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "services/common/estimation/unknown_elevation.hpp"
#include "services/detection_corrector/core/config.hpp"
#include "services/detection_corrector/core/ego_velocity.hpp"
#include "services/detection_corrector/core/mounting.hpp"
#include "services/detection_corrector/core/range_rate_noise.hpp"

namespace boresight::corrector {

/// The values of a detection that the test needs.
struct Sight {
  Eigen::Vector3d direction;                                      ///< unit vector, vehicle axes
  double cos_azimuth, sin_azimuth, cos_elevation, sin_elevation;  ///< in the sensor's frame
  double range_m;
  double range_rate_over_ground_mps;  ///< in the radar's own scale: measured range rate + direction·g
  double azimuth_std_rad, elevation_std_rad, range_rate_std_mps;
  double azimuth_curve_std_rad = 0.0;  ///< of the azimuth's systematic error, not scaled by the angles' noise
};

/// For the detections of one scan. The threshold is `moving_sigma` stds of the range rate over ground of a stationary
/// reflector. The std combines the range rate with the learnt scale of its std, the angles by the derivative of (R
/// u)·v_s, motion and mounting, and the motion of the body. There is no other constant in the threshold. The test runs
/// in the radar's own scale of range rates, because that scale times k_v is known much better than k_v.
class StationaryTest {
 public:
  /// `unknown`: for a radar that measures no elevation, otherwise nullptr.
  StationaryTest(const EgoVelocity& motion, const Mounting& mounting, const UnknownElevation* unknown,
                 const Config& config)
      : velocity_mps_(motion.seen_mps),
        velocity_sensor_mps_(mounting.sensor_to_vehicle.transpose() * motion.seen_mps),
        common_(motion.covariance +
                config.body_motion_std_mps * config.body_motion_std_mps * Eigen::Matrix3d::Identity()),
        unknown_(unknown),
        angle_variance_factor_(mounting.angle_noise_scale * mounting.angle_noise_scale),
        sigma_squared_(config.moving_sigma * config.moving_sigma) {}

  /// What the range rate differs by from that of a stationary reflector.
  [[nodiscard]] Innovation innovation(const Sight& s) const {
    const Eigen::Vector3d& v = velocity_sensor_mps_;
    const double azimuth_gradient = s.cos_elevation * (s.cos_azimuth * v.y() - s.sin_azimuth * v.x());
    const double by_azimuth = azimuth_gradient * s.azimuth_std_rad;
    const double by_curve = azimuth_gradient * s.azimuth_curve_std_rad;
    const double by_elevation =
        (s.cos_elevation * v.z() - s.sin_elevation * (s.cos_azimuth * v.x() + s.sin_azimuth * v.y())) *
        s.elevation_std_rad;
    Innovation out{
        s.direction, s.range_rate_over_ground_mps, s.range_rate_std_mps * s.range_rate_std_mps,
        angle_variance_factor_ * (by_azimuth * by_azimuth + by_elevation * by_elevation) + by_curve * by_curve};
    if (unknown_ != nullptr) {
      // A stationary reflector above or below the sensor has a smaller range rate than its azimuth predicts. The
      // reduction is between zero and twice the expected one, with a part common to all radars and an individual part.
      const UnknownElevation::Cosine cosine = unknown_->at(s.range_m);
      const double closing = s.direction.dot(velocity_mps_);
      const double excess_std = M_SQRT2 * kElevationExcessStd * cosine.lowering;
      out.value_mps -= cosine.lowering * closing;
      out.angular_variance_m2ps2 += closing * closing * (cosine.relative_variance + excess_std * excess_std);
    }
    return out;
  }

  /// `factor`: actual / stated variance of the radar's range rates.
  [[nodiscard]] bool passes(const Innovation& i, double factor) const {
    const double variance =
        factor * i.stated_variance_m2ps2 + i.angular_variance_m2ps2 + i.direction.dot(common_ * i.direction);
    return i.value_mps * i.value_mps <= sigma_squared_ * variance;
  }

  /// Covariance of the error that is common to the scan: motion, mounting, and motion of the body.
  [[nodiscard]] const Eigen::Matrix3d& common() const { return common_; }

 private:
  Eigen::Vector3d velocity_mps_;         // g of the sensor, vehicle axes
  Eigen::Vector3d velocity_sensor_mps_;  // the same in the sensor's frame
  Eigen::Matrix3d common_;
  const UnknownElevation* unknown_;
  double angle_variance_factor_;
  double sigma_squared_;
};

}  // namespace boresight::corrector
