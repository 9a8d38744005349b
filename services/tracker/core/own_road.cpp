#include "services/tracker/core/own_road.hpp"

#include <cmath>

namespace boresight::tracking {

OwnRoad::OwnRoad(const ScanGeometry& geometry) {
  constexpr double kSlowest_mps = 3.0;  // by less, the yaw rate's noise would bend the road
  const auto speed_mps = static_cast<double>(geometry.ego_speed_mps);
  if (speed_mps > kSlowest_mps) curvature_per_m_ = static_cast<double>(geometry.ego_yaw_rate_radps) / speed_mps;
}

std::optional<double> OwnRoad::heading_rad(const Eigen::Vector2d& at_m) const {
  constexpr double kNear_m = 30.0;
  constexpr double kBeside_m = 8.0;  // two lanes, and half of the own one
  constexpr double kMostTurned_rad = 0.3;
  const double turned_rad = curvature_per_m_ * at_m.x();
  const double beside_m = at_m.y() - 0.5 * turned_rad * at_m.x();
  if (!(std::abs(at_m.x()) >= kNear_m)) return std::nullopt;
  if (!(std::abs(turned_rad) < kMostTurned_rad && std::abs(beside_m) < kBeside_m)) return std::nullopt;
  return turned_rad;
}

}  // namespace boresight::tracking
