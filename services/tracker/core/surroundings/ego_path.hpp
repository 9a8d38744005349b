// The vehicle's path: a circle of radius speed / yaw rate, a straight line as its limit. Equations (W1), (W2).
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace boresight::tracking {

/// A place by the path: how far along it, and how far to the left of it.
struct PathPlace {
  double along_m, aside_m;
};

struct EgoPath {
  double speed_mps = 0.0;
  double curvature_per_m = 0.0;
  double speed_std_mps = 0.0;
  double yaw_rate_std_radps = 0.0;

  /// Nearest place of the circle. Both forms hold for the straight line, without a division by the curvature.
  [[nodiscard]] PathPlace place(const Eigen::Vector2d& p) const {
    const double k = curvature_per_m;
    const double square = 1.0 - 2.0 * k * p.y() + k * k * p.squaredNorm();
    const double aside = (2.0 * p.y() - k * p.squaredNorm()) / (1.0 + std::sqrt(std::max(0.0, square)));
    const double turn = std::atan2(k * p.x(), 1.0 - k * p.y());
    const double along = std::abs(turn) < kSmallTurn_rad ? p.x() / (1.0 - k * p.y()) : turn / k;
    return {along, aside};
  }
  /// Direction of the path at a distance along it.
  [[nodiscard]] double heading_rad(double along_m) const { return curvature_per_m * along_m; }
  /// Variance of the vehicle's place across the path after `time_s`: of the signalled yaw rate, and of what the driver
  /// may steer until then, a lateral acceleration that changes at random.
  [[nodiscard]] double variance_m2(double time_s, double lateral_jerk_density_m2ps5) const {
    const double t2 = time_s * time_s;
    const double turned_m = 0.5 * speed_mps * yaw_rate_std_radps * t2;
    return turned_m * turned_m + lateral_jerk_density_m2ps5 * t2 * t2 * time_s / 20.0;
  }

 private:
  static constexpr double kSmallTurn_rad = 1e-6;  // below it sine and angle agree to rounding
};

/// The path of a speed and a yaw rate. Below `least_speed_mps` no path is known: it is straight.
[[nodiscard]] inline EgoPath ego_path(double speed_mps, double yaw_rate_radps, double speed_std_mps,
                                      double yaw_rate_std_radps, double least_speed_mps) {
  EgoPath path{speed_mps, 0.0, speed_std_mps, yaw_rate_std_radps};
  if (std::abs(speed_mps) >= least_speed_mps) path.curvature_per_m = yaw_rate_radps / speed_mps;
  return path;
}

}  // namespace boresight::tracking
