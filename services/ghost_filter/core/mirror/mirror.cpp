#include "services/ghost_filter/core/mirror/mirror.hpp"

#include <algorithm>

namespace boresight::ghosts {

void place_mirrors(std::span<const Reflector> reflectors, const Odometry& odometry, const IntensityConfig& config,
                   std::vector<Mirror>& mirrors) {
  mirrors.clear();
  for (const Reflector& r : reflectors) {
    if (mirrors.size() == mirrors.capacity()) return;
    const double probability =
        r.existence() * std::min(config.most_mirror_share, config.mirror_share_per_m * r.length_m());
    if (probability < config.least_mirror_share) continue;
    Mirror m;
    m.curve = {odometry.point_to_vehicle(r.curve.origin_m), odometry.vector_to_vehicle(r.curve.tangent),
               r.curve.curvature_per_m};
    m.covariance = r.covariance;
    m.begin_m = r.begin_m();
    m.end_m = r.end_m();
    m.probability = probability;
    m.occupancy = &r.occupancy;
    m.arc_shift_m = r.arc_shift_m;
    mirrors.push_back(m);
  }
}

}  // namespace boresight::ghosts
