// Where on a mirror a wave turns: as it arrives, so it leaves.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace boresight::ghosts {

/// What one place on a mirror tells of where the wave turns; everything in the same axes.
struct Specular {
  double step_m;   ///< along the mirror, by Newton's method, to where it would
  double error_m;  ///< by which the way is longer here than there
  double sine_of_departure, sine_of_arrival;
  /// Whether it comes and goes on the same side of the mirror.
  [[nodiscard]] bool is_reflection() const { return sine_of_departure * sine_of_arrival < 0.0; }
};

/// Of a wave that comes along `u` over `first_m` and goes on along `d` (unit) over `second_m` to a place that does not
/// move with it, or hardly so.
[[nodiscard]] inline Specular specular(const Eigen::Vector2d& u, double first_m, const Eigen::Vector2d& d,
                                       double second_m, const Eigen::Vector2d& tangent, double curvature_per_m) {
  const double departing = u.dot(tangent), arriving = d.dot(tangent);
  const double sine_of_departure = tangent.x() * u.y() - tangent.y() * u.x();
  const double sine_of_arrival = tangent.x() * d.y() - tangent.y() * d.x();
  const double straight = -(1.0 - departing * departing) / first_m - (1.0 - arriving * arriving) / second_m;
  const double bent = straight + curvature_per_m * (sine_of_arrival - sine_of_departure);
  const double slope = bent < 0.2 * straight ? bent : straight;
  const double step = (departing - arriving) / std::min(-1e-9, slope);
  return {step, 0.5 * std::abs(slope) * step * step, sine_of_departure, sine_of_arrival};
}

}  // namespace boresight::ghosts
