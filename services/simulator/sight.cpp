#include "services/simulator/sight.hpp"

#include "services/simulator/radar/mounting.hpp"
#include "services/simulator/radar/viewpoint.hpp"

namespace boresight::simulator {

Sight::Sight(const RadarConfig& config, const RadarEffects& effects, const radar::EgoBody& ego_body)
    : config_(config),
      effects_(effects),
      ego_box_(radar::seen_from(ego_body, Eigen::Vector3d(config.mounting_pose.position_m.data()))),
      antenna_(config.field_of_view) {}

void Sight::look(const Scene& scene, std::vector<BodySight>& bodies) {
  const radar::Viewpoint view = radar::viewpoint(
      scene.ego, config_.mounting_pose, radar::actual_mounting(config_.mounting_pose, effects_, config_.id, scene.t_s));
  const double range_max_m = config_.field_of_view.range_max_m;
  occlusion_.prepare(scene, view.position_m.head<2>(), range_max_m, ego_box_);
  bodies.clear();
  for (const Body& body : scene.bodies) {
    BodySight sight{body.id, body.number_of_centres, 0, 0};
    for (std::uint32_t i = 0; i < body.number_of_centres; ++i) {
      const ReflectionCentre& centre = scene.centres[body.first_centre + i];
      const Eigen::Vector3d path = centre.position_m - view.position_m;
      const double range_m = path.norm();
      if (!(range_m > 0.0) || range_m > range_max_m) continue;
      if (!antenna_.look(view.sensor_to_world.transpose() * (path / range_m)).inside) continue;
      ++sight.in_view;
      const bool faces = centre.facing.isZero() || centre.facing.dot(path) < 0.0;
      if (faces && occlusion_.clear(view.position_m, centre.position_m, body.id)) ++sight.seen;
    }
    if (sight.in_view > 0) bodies.push_back(sight);
  }
}

}  // namespace boresight::simulator
