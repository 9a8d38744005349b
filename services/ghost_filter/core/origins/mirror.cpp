#include "services/ghost_filter/core/origins/mirror.hpp"

#include <cmath>

namespace boresight::ghosts {

void place_mirrors(std::span<const Segment> reflectors, const Odometry& odometry, const IntensityConfig& config,
                   std::vector<Mirror>& mirrors) {
  mirrors.clear();
  for (const Segment& r : reflectors) {
    const double probability = std::min(config.most_mirror_share, config.mirror_share_per_m * r.continued_m);
    if (probability < config.least_mirror_share || mirrors.size() == mirrors.capacity()) continue;
    Mirror m;
    m.start_m = odometry.point_to_vehicle(r.start_m);
    m.length_m = r.length_m();
    m.tangent = (odometry.point_to_vehicle(r.end_m) - m.start_m) / m.length_m;
    m.probability = probability;
    // Of a straight line through points that scatter about it, evenly along it.
    const double residual_m = std::max(config.mirror_scatter_m, r.residual_m);
    m.middle_variance_m2 = residual_m * residual_m / r.cells;
    m.turn_variance_rad2 = 12.0 * m.middle_variance_m2 / (m.length_m * m.length_m);
    mirrors.push_back(m);
  }
}

std::optional<MirrorPath> path_over(const Mirror& mirror, const Eigen::Vector2d& sensor_m,
                                    const Eigen::Vector2d& place_m) {
  const Eigen::Vector2d normal = mirror.normal(), sensor = sensor_m - mirror.start_m, place = place_m - mirror.start_m;
  const double sensor_across = normal.dot(sensor), place_across = normal.dot(place);
  if (!(sensor_across * place_across > 0.0)) return std::nullopt;
  // The wave divides the way along the mirror as it does the way across.
  const double share = sensor_across / (sensor_across + place_across);
  const double sensor_along = mirror.tangent.dot(sensor);
  const double arc = sensor_along + share * (mirror.tangent.dot(place) - sensor_along);
  if (!(arc >= 0.0 && arc <= mirror.length_m)) return std::nullopt;
  const Eigen::Vector2d out = arc * mirror.tangent - sensor, on = place - arc * mirror.tangent;
  const double first = out.norm(), second = on.norm();
  return MirrorPath{arc, first, second, out / first, on / second};
}

}  // namespace boresight::ghosts
