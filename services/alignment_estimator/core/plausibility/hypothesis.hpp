// How well one explanation of a radar's velocities fits: a Kalman filter of the errors that it allows, and the
// logarithm of its likelihood.
#pragma once

#include <Eigen/Core>

namespace boresight::alignment::plausibility {

/// Measured over predicted velocity of a sensor, as an angle and a logarithm of a ratio: linear in the errors, however
/// large.
struct Deviation {
  double yaw_rad = 0.0;  ///< argument of the predicted velocity − that of the measured one
  double scale = 0.0;    ///< logarithm of measured / predicted
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  double slip_mps2 = 0.0;  ///< V·ω, by which the slip coefficient acts on the yaw
};

class Hypothesis {
 public:
  Hypothesis() = default;
  /// `any_yaw`: the nominal yaw is not known at all.
  explicit Hypothesis(bool any_yaw) : any_yaw_(any_yaw) { restart(); }

  /// Logarithm of the likelihood of a deviation, whose density is `background` if the velocity is not the sensor's;
  /// then learns from it.
  [[nodiscard]] double add(const Deviation& deviation, double background);
  [[nodiscard]] double yaw_rad() const { return mean_(0); }
  /// Logarithm of P(low ≤ |yaw| ≤ high) now over that before any data: the factor by which limits of the yaw change the
  /// likelihood.
  [[nodiscard]] double log_within(double low_rad, double high_rad) const;

 private:
  void restart();
  [[nodiscard]] Eigen::Vector2d innovation(const Deviation& deviation, const Eigen::Vector3d& mean) const;
  void learn(const Deviation& deviation);

  bool any_yaw_ = false;
  bool has_yaw_ = false;                            ///< of any_yaw_: a deviation has been taken
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();  ///< yaw (rad), scale, slip coefficient (rad per m/s²)
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
};

}  // namespace boresight::alignment::plausibility
