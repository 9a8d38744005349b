#include "tests/benchmarks/realism/common/observer.hpp"

#include <algorithm>
#include <cmath>

#include "services/simulator/radar/mounting.hpp"
#include "services/simulator/radar/viewpoint.hpp"

namespace boresight::bench::realism {

namespace {

constexpr double kNearlyStill_mps = 0.1;  // a slower body stands, as in the simulator's truth
constexpr double kForward_rad = M_PI / 4.0, kSideways_rad = 2.0 * M_PI / 3.0;

Facing facing_of(const RadarConfig& radar) {
  const double yaw = std::abs(std::remainder(radar.mounting_pose.yaw_rad, 2.0 * M_PI));
  return yaw < kForward_rad ? Facing::kForward : yaw < kSideways_rad ? Facing::kSideways : Facing::kRear;
}

RoadUser road_user(const simulator::Body& body) {
  const bool moves = !body.parked && body.velocity_mps.norm() > kNearlyStill_mps;
  switch (body.kind) {
    case simulator::BodyKind::kCar:
    case simulator::BodyKind::kVan:
      return moves ? RoadUser::kCar : RoadUser::kStandingCar;
    case simulator::BodyKind::kTruck:
      return moves ? RoadUser::kTruck : RoadUser::kStandingTruck;
    case simulator::BodyKind::kCyclist:
      return RoadUser::kTwoWheeler;
    case simulator::BodyKind::kPedestrian:
      break;
  }
  return RoadUser::kPedestrian;
}

/// Standing pedestrians and two-wheelers have no measured row.
bool has_row(const simulator::Body& body) {
  const bool is_vehicle = body.kind != simulator::BodyKind::kCyclist && body.kind != simulator::BodyKind::kPedestrian;
  return is_vehicle || body.velocity_mps.norm() > kNearlyStill_mps;
}

ObservedObject observed(const simulator::Body& body, const Eigen::Vector2d& sensor_m, bool in_sight) {
  ObservedObject o;
  o.id = body.id;
  o.user = road_user(body);
  o.position_m = body.position_m;
  o.velocity_mps = body.velocity_mps;
  o.heading_rad = body.heading_rad;
  o.length_m = body.length_m;
  o.width_m = body.width_m;
  o.range_m = std::max(0.0, -o.depth_m(sensor_m));
  const Eigen::Vector2d sight = body.position_m - sensor_m;
  o.aspect_rad = std::abs(std::remainder(std::atan2(sight.y(), sight.x()) - body.heading_rad, 2.0 * M_PI));
  o.in_sight = in_sight;
  return o;
}

Eigen::Vector2d rigid_velocity(const simulator::Body& body, const Eigen::Vector2d& place_m) {
  const Eigen::Vector2d offset = place_m - body.position_m;
  return body.velocity_mps + body.yaw_rate_radps * Eigen::Vector2d(-offset.y(), offset.x());
}

}  // namespace

Observer::Observer(const simulator::Scenario& scenario, const VehicleConfig& vehicle) : effects_(scenario.effects) {
  for (const RadarConfig& radar : vehicle.radars) {
    radars_.push_back({radar, simulator::Sight(radar, effects_, simulator::ego_body(scenario.ego))});
  }
}

ObservedScan Observer::observe(const simulator::Drive& drive, const simulator::Event& event) {
  const RadarScan& scan = *event.scan;
  const simulator::Scene& scene = drive.scene();
  ObservedScan out;
  const auto radar = std::find_if(radars_.begin(), radars_.end(),
                                  [&](const Radar& r) { return r.config.id == scan.header.source_id; });
  if (radar == radars_.end()) return out;
  const RadarConfig& config = radar->config;
  const simulator::radar::Viewpoint view = simulator::radar::viewpoint(
      scene.ego, config.mounting_pose,
      simulator::radar::actual_mounting(config.mounting_pose, effects_, config.id, event.t_s));
  out.t_s = event.t_s;
  out.radar = config.id;
  out.number = scan.header.source_sequence;
  out.facing = facing_of(config);
  out.sensor_m = view.position_m.head<2>();
  out.sensor_velocity_mps = view.velocity_mps.head<2>();
  out.view_rad = config.field_of_view.azimuth_max_rad - config.field_of_view.azimuth_min_rad;
  out.range_max_m = config.field_of_view.range_max_m;

  const auto body_of = [&scene](std::uint32_t id) {
    return std::find_if(scene.bodies.begin(), scene.bodies.end(), [id](const auto& b) { return b.id == id; });
  };
  radar->sight.look(scene, sights_);
  for (const simulator::BodySight& sight : sights_) {
    const auto body = body_of(sight.body_id);
    if (body == scene.bodies.end() || !has_row(*body)) continue;
    out.objects.push_back(observed(*body, out.sensor_m, sight.seen > 0));
  }
  const double boresight_rad = std::atan2(view.sensor_to_world(1, 0), view.sensor_to_world(0, 0));
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    const simulator::DetectionTruth& truth = (*event.truth)[i];
    ObservedDetection d;
    d.range_m = static_cast<double>(scan.range_m[i]);
    d.azimuth_rad = static_cast<double>(scan.azimuth_rad[i]);
    d.range_rate_mps = static_cast<double>(scan.range_rate_mps[i]);
    d.rcs_dbsm = static_cast<double>(scan.rcs_dbsm[i]);
    const double direction_rad = boresight_rad + d.azimuth_rad;
    d.position_m = out.sensor_m + d.range_m * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
    const double elevation_rad = scan.has(scan_field::kElevation) ? static_cast<double>(scan.elevation_rad[i]) : 0.0;
    const Eigen::Vector3d direction =
        view.sensor_to_world * Eigen::Vector3d(std::cos(elevation_rad) * std::cos(d.azimuth_rad),
                                               std::cos(elevation_rad) * std::sin(d.azimuth_rad),
                                               std::sin(elevation_rad));
    d.deviation_mps = d.range_rate_mps + direction.dot(view.velocity_mps);
    d.existence = scan.has(scan_field::kExistence) ? static_cast<double>(scan.existence_probability[i]) : 1.0;
    d.is_valid = (scan.detection_flags[i] & detection_flag::kInvalid) == 0;
    d.is_unambiguous = (scan.detection_flags[i] & detection_flag::kAmbiguous) == 0;
    d.provenance = truth.provenance;
    d.cause = truth.cause;
    d.object = truth.object_id;
    if (d.object != 0 && d.is_direct_of(d.object)) {
      if (const auto body = body_of(d.object); body != scene.bodies.end()) {
        d.body_radial_mps = direction.head<2>().dot(rigid_velocity(*body, d.position_m));
        d.rigid_deviation_mps = d.deviation_mps - d.body_radial_mps;
      }
    }
    d.is_in_box = std::any_of(out.objects.begin(), out.objects.end(),
                              [&](const ObservedObject& o) { return o.depth_m(d.position_m) >= 0.0; });
    out.detections.push_back(d);
  }
  return out;
}

}  // namespace boresight::bench::realism
