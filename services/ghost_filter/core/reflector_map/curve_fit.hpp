// Total least squares of a line or arc, with its covariance.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "services/ghost_filter/core/reflector_map/curve.hpp"

namespace boresight::ghosts {

/// Collects weighted points about a curve; what changes is (shift along the normal in m, turn in rad, change of
/// curvature in 1/m), all at the curve's origin.
class CurveFit {
 public:
  /// Begins with what is known: `curve` with its information matrix (inverse covariance).
  CurveFit(const Curve& curve, const Eigen::Matrix3d& information) : curve_(curve), information_(information) {}

  void add(const Eigen::Vector2d& point_m, double variance_m2) {
    const Eigen::Vector2d q = curve_.local(point_m);
    const double distance = curve_.distance_of_local(q);
    const Eigen::Vector3d row(1.0, q.x(), 0.5 * q.squaredNorm());
    information_.noalias() += row * row.transpose() / variance_m2;
    right_ += row * (distance / variance_m2);
  }
  [[nodiscard]] Eigen::Matrix3d covariance() const { return information_.inverse(); }
  [[nodiscard]] Curve solve() const { return curve_.changed(covariance() * right_); }
  [[nodiscard]] const Eigen::Matrix3d& information() const { return information_; }

 private:
  Curve curve_;
  Eigen::Matrix3d information_;
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
};

/// Covariance of the three parameters when the origin moves along the curve by `arc_m`.
[[nodiscard]] inline Eigen::Matrix3d moved_covariance(const Eigen::Matrix3d& covariance, double arc_m) {
  Eigen::Matrix3d t;
  t << 1.0, arc_m, 0.5 * arc_m * arc_m, 0.0, 1.0, arc_m, 0.0, 0.0, 1.0;
  return t * covariance * t.transpose();
}

}  // namespace boresight::ghosts
