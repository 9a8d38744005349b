// Burza 2025, (10)–(16): the range rate of a stationary reflector by the planar roll model, with its gradient.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::published {

/// Range rate (m/s) and its gradient over b = (k_v, α_m, β_m, γ_m).
struct RangeRate {
  double value_mps;
  Eigen::Vector4d gradient;
};

/// The full model for one scan of one radar. The planar roll model is not a rotation
/// (docs/algorithms/published-alignment.md): it agrees with R_z·R_y·R_x where pitch and roll are zero, and is off by up
/// to degrees elsewhere. The symbol printed as α_b in (11) is β_b. A nominal roll, which Burza 2025 does not have,
/// adds to γ_m, so that an upside-down radar is modelled too.
class PlanarModel {
 public:
  /// `speed_mps` as signalled, at the rear axle. The straight-road model (17)–(21) is this with a yaw rate of 0.
  PlanarModel(const MountingPose& nominal, const Eigen::Vector4d& b, double speed_mps, double yaw_rate_radps)
      : yaw_rad_(nominal.yaw_rad + b(1)),
        pitch_rad_(nominal.pitch_rad + b(2)),
        cos_roll_(std::cos(nominal.roll_rad + b(3))),
        sin_roll_(std::sin(nominal.roll_rad + b(3))),
        speed_scale_(b(0)),
        x_m_(nominal.position_m[0]),
        y_m_(nominal.position_m[1]) {
    move(speed_mps, yaw_rate_radps);
  }
  /// The same radar at another motion; cheaper than a new model.
  void move(double speed_mps, double yaw_rate_radps) {
    speed_mps_ = speed_mps;
    forward_mps_ = speed_scale_ * speed_mps - yaw_rate_radps * y_m_;
    left_mps_ = yaw_rate_radps * x_m_;
  }

  /// (10)–(12) at the measured angles.
  [[nodiscard]] double value(double azimuth_rad, double elevation_rad) const {
    const double a = yaw_rad_ + azimuth_rad * cos_roll_ - elevation_rad * sin_roll_;
    const double e = pitch_rad_ + elevation_rad * cos_roll_ + azimuth_rad * sin_roll_;
    return -(forward_mps_ * std::cos(a) + left_mps_ * std::sin(a)) * std::cos(e);
  }
  /// (10)–(16); four sines and cosines here and the two of the roll, which are the scan's.
  [[nodiscard]] RangeRate operator()(double azimuth_rad, double elevation_rad) const {
    const double a = yaw_rad_ + azimuth_rad * cos_roll_ - elevation_rad * sin_roll_;
    const double e = pitch_rad_ + elevation_rad * cos_roll_ + azimuth_rad * sin_roll_;
    const double ca = std::cos(a), sa = std::sin(a), ce = std::cos(e), se = std::sin(e);
    RangeRate r;
    r.value_mps = -(forward_mps_ * ca + left_mps_ * sa) * ce;
    r.gradient(0) = -speed_mps_ * ca * ce;                      // (13)
    r.gradient(1) = (forward_mps_ * sa - left_mps_ * ca) * ce;  // (14)
    r.gradient(2) = (forward_mps_ * ca + left_mps_ * sa) * se;  // (15)
    r.gradient(3) = r.gradient(1) * (-azimuth_rad * sin_roll_ - elevation_rad * cos_roll_) +
                    r.gradient(2) * (azimuth_rad * cos_roll_ - elevation_rad * sin_roll_);  // (16)
    return r;
  }

 private:
  double yaw_rad_, pitch_rad_, cos_roll_, sin_roll_, speed_scale_, x_m_, y_m_;
  double speed_mps_, forward_mps_, left_mps_;  // k_v·V − V_ωx and V_ωy
};

}  // namespace boresight::alignment::published
