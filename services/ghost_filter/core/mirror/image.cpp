#include "services/ghost_filter/core/mirror/image.hpp"

#include <algorithm>
#include <cmath>

#include "services/ghost_filter/core/mirror/specular.hpp"

namespace boresight::ghosts {

std::optional<Image> image_of(const Mirror& mirror, const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& place_m) {
  constexpr int kRounds = 6;
  constexpr double kLeast_m = 0.5, kMostError_m = 0.005;
  const Eigen::Vector2d sensor = mirror.curve.local(sensor_m), place = mirror.curve.local(place_m);
  const double away = std::abs(sensor.y()) + std::abs(place.y());
  if (!(away > 0.0)) return std::nullopt;
  // Were the mirror straight, the wave would divide the way along it as it does the way across.
  double arc =
      std::clamp(sensor.x() + (place.x() - sensor.x()) * std::abs(sensor.y()) / away, mirror.begin_m, mirror.end_m);
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Vector2d point = mirror.curve.local_at(arc);
    const Eigen::Vector2d out = point - sensor, on = place - point;
    const double first = out.norm(), second = on.norm();
    if (!(first > kLeast_m && second > kLeast_m)) return std::nullopt;
    const Eigen::Vector2d u = out / first, d = on / second;
    const Specular here =
        specular(u, first, d, second, mirror.curve.local_tangent_at(arc), mirror.curve.curvature_per_m);
    if (here.error_m <= kMostError_m) {
      if (!here.is_reflection()) return std::nullopt;
      return Image{arc, first, second, mirror.curve.from_local(u), mirror.curve.from_local(d)};
    }
    const double next = std::clamp(arc + here.step_m, mirror.begin_m, mirror.end_m);
    if (next == arc) return std::nullopt;
    arc = next;
  }
  return std::nullopt;
}

}  // namespace boresight::ghosts
