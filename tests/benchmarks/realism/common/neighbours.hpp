// Nearest detections of a scan or of another scan.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace boresight::bench::realism {

using Places = std::vector<Eigen::Vector2d>;

/// Turns of a scan about the sensor that show how often one detection meets another by chance: 3 … 8° to either side.
inline constexpr std::array<double, 4> kChanceTurns_rad{-8.0 * M_PI / 180.0, -3.0 * M_PI / 180.0, 3.0 * M_PI / 180.0,
                                                        8.0 * M_PI / 180.0};

[[nodiscard]] inline Eigen::Vector2d turned_about(const Eigen::Vector2d& place_m, const Eigen::Vector2d& centre_m,
                                                  double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const Eigen::Vector2d d = place_m - centre_m;
  return centre_m + Eigen::Vector2d(c * d.x() - s * d.y(), s * d.x() + c * d.y());
}

/// Whether any of `places` lies within `radius_m`.
[[nodiscard]] inline bool has_near(const Eigen::Vector2d& place_m, const Places& places, double radius_m) {
  for (const Eigen::Vector2d& other : places) {
    if ((other - place_m).squaredNorm() <= radius_m * radius_m) return true;
  }
  return false;
}

}  // namespace boresight::bench::realism
