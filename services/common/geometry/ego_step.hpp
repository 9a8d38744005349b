// Transforms positions from the vehicle frame of one scan to that of the next.
// Equations: docs/algorithms/frames.md (F11).
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace boresight::geometry {

/// Motion of the vehicle frame over a time step, on a circular path.
struct EgoStep {
  Eigen::Vector2d translation_m{0.0, 0.0};               ///< of the origin, in the old frame
  Eigen::Matrix2d to_new = Eigen::Matrix2d::Identity();  ///< rotates vectors from the old to the new axes

  [[nodiscard]] Eigen::Vector2d move_point(const Eigen::Vector2d& p) const { return to_new * (p - translation_m); }
  [[nodiscard]] Eigen::Vector2d rotate(const Eigen::Vector2d& v) const { return to_new * v; }
};

/// Speed in m/s, yaw rate in rad/s, `elapsed_s` may be negative.
[[nodiscard]] inline EgoStep ego_step(double speed_mps, double yaw_rate_radps, double elapsed_s) {
  const double turn = yaw_rate_radps * elapsed_s;
  const double length = speed_mps * elapsed_s;
  // Chord of the arc: sin(x)/x, by its series for small x, where the quotient would lose digits.
  const double half = 0.5 * turn;
  const double chord = length * (std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half);
  EgoStep step;
  step.translation_m = chord * Eigen::Vector2d(std::cos(half), std::sin(half));
  const double c = std::cos(turn), s = std::sin(turn);
  step.to_new << c, s, -s, c;
  return step;
}

}  // namespace boresight::geometry
