// Total least squares of a line or arc, with its covariance.
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/LU>

#include "services/ghost_filter/core/reflector_map/curve.hpp"

namespace boresight::ghosts {

/// What weighted points say about a curve: the normal equations of its change (shift along the normal in m, turn in
/// rad, change of curvature in 1/m), all at the curve's origin.
struct Evidence {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares_m2 = 0.0;  ///< of the distances
  std::uint32_t points = 0;
  std::uint32_t on = 0, beside = 0;  ///< points that lie on the curve, and near but not on it, whosoever they are

  /// A point in the curve's local coordinates.
  void add_local(const Eigen::Vector2d& q, double distance_m, double variance_m2) {
    const Eigen::Vector3d row(1.0, q.x(), 0.5 * q.squaredNorm());
    const Eigen::Vector3d weighted = row / variance_m2;
    information.noalias() += weighted * row.transpose();
    right += weighted * distance_m;
    squares_m2 += distance_m * distance_m;
    ++points;
  }
};

/// Collects weighted points about a curve.
class CurveFit {
 public:
  /// Begins with what is known: `curve` with its information matrix (inverse covariance).
  CurveFit(const Curve& curve, const Eigen::Matrix3d& information) : curve_(curve) {
    evidence_.information = information;
  }

  void add(const Eigen::Vector2d& point_m, double variance_m2) {
    const Eigen::Vector2d q = curve_.local(point_m);
    evidence_.add_local(q, curve_.distance_of_local(q), variance_m2);
  }
  void add(const Evidence& evidence) {
    evidence_.information += evidence.information;
    evidence_.right += evidence.right;
  }
  [[nodiscard]] Eigen::Matrix3d covariance() const { return evidence_.information.inverse(); }
  [[nodiscard]] Curve solve() const { return curve_.changed(covariance() * evidence_.right); }

 private:
  Curve curve_;
  Evidence evidence_;
};

/// Covariance of the three parameters when the origin moves along the curve by `arc_m`.
[[nodiscard]] inline Eigen::Matrix3d moved_covariance(const Eigen::Matrix3d& covariance, double arc_m) {
  Eigen::Matrix3d t;
  t << 1.0, arc_m, 0.5 * arc_m * arc_m, 0.0, 1.0, arc_m, 0.0, 0.0, 1.0;
  return t * covariance * t.transpose();
}

}  // namespace boresight::ghosts
