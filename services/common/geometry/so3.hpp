// Rotations as vectors: exponential, logarithm, and the Euler angles of a mounting.
// Equations: docs/algorithms/frames.md (F9)(F10).
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "services/common/geometry/frames.hpp"

namespace boresight::geometry {

/// [v]×: cross_matrix(v)·w = v × w.
[[nodiscard]] inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Rotation by |v| rad about v (Rodrigues).
[[nodiscard]] inline Eigen::Matrix3d so3_exp(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  const Eigen::Matrix3d k = cross_matrix(v);
  // The quotients by their series for small angles, where they would lose digits.
  const double a = angle < 1e-4 ? 1.0 - angle * angle / 6.0 : std::sin(angle) / angle;
  const double b = angle < 1e-4 ? 0.5 - angle * angle / 24.0 : (1.0 - std::cos(angle)) / (angle * angle);
  return Eigen::Matrix3d::Identity() + a * k + b * k * k;
}

/// The rotation vector of a rotation matrix, |v| ≤ π.
[[nodiscard]] inline Eigen::Vector3d so3_log(const Eigen::Matrix3d& r) {
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(r).normalized());
  const double angle = turn.angle() > M_PI ? turn.angle() - 2.0 * M_PI : turn.angle();
  return angle * turn.axis();
}

/// Yaw, pitch (positive looks up) and roll of R = R_z(yaw)·R_y(−pitch)·R_x(roll); at a pitch of ±90° yaw and roll
/// are not distinguishable, and roll is set to 0.
[[nodiscard]] inline Eigen::Vector3d euler_angles(const Eigen::Matrix3d& r) {
  const double pitch = std::asin(std::clamp(r(2, 0), -1.0, 1.0));
  if (std::abs(r(2, 0)) > 1.0 - 1e-12) return {std::atan2(-r(0, 1), r(1, 1)), pitch, 0.0};
  return {std::atan2(r(1, 0), r(0, 0)), pitch, std::atan2(r(2, 1), r(2, 2))};
}

/// C = R_x(roll)·R_y(−pitch)·R_z(yaw): a rotation about fixed axes, z first and x last; positive pitch looks up.
[[nodiscard]] inline Eigen::Matrix3d fixed_axes_rotation(double yaw_rad, double pitch_rad, double roll_rad) {
  return (Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(-pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

/// Yaw, pitch and roll of such a rotation. A further rotation about x changes only the roll, so that an unknown roll
/// does not affect the other two.
[[nodiscard]] inline Eigen::Vector3d fixed_axes_angles(const Eigen::Matrix3d& c) {
  return {std::atan2(-c(0, 1), c(0, 0)), std::asin(std::clamp(-c(0, 2), -1.0, 1.0)), std::atan2(-c(1, 2), c(2, 2))};
}

/// Change of these angles by a small rotation e, C ← Exp(e)·C; singular at a pitch of ±90°.
[[nodiscard]] inline Eigen::Matrix3d fixed_axes_gradient(double pitch_rad, double roll_rad) {
  const double cr = std::cos(roll_rad), sr = std::sin(roll_rad);
  const double cp = std::cos(pitch_rad), tp = std::tan(pitch_rad);
  // Inverse of e = e_x·δroll − R_x e_y·δpitch + R_x R_y(−pitch) e_z·δyaw.
  Eigen::Matrix3d m;
  m << 0.0, -sr / cp, cr / cp, 0.0, -cr, -sr, 1.0, -sr * tp, cr * tp;
  return m;
}

/// Change of (yaw, pitch, roll) by a small rotation d in vehicle axes, R ← Exp(d)·R; singular at a pitch of ±90°.
[[nodiscard]] inline Eigen::Matrix3d euler_gradient(double yaw_rad, double pitch_rad) {
  const double cy = std::cos(yaw_rad), sy = std::sin(yaw_rad);
  const double cp = std::cos(pitch_rad), tp = std::tan(pitch_rad);
  // Inverse of d = e_z·δyaw − R_z e_y·δpitch + R_z R_y(−pitch) e_x·δroll.
  Eigen::Matrix3d m;
  m << -cy * tp, -sy * tp, 1.0, sy, -cy, 0.0, cy / cp, sy / cp, 0.0;
  return m;
}

/// Small rotation in vehicle axes by a change of (yaw, pitch, roll): the inverse of `euler_gradient`. Compiled once.
[[nodiscard]] Eigen::Matrix3d euler_gradient_inverse(double yaw_rad, double pitch_rad);

}  // namespace boresight::geometry
