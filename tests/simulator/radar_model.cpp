#include "tests/simulator/radar_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/common/geometry/frames.hpp"
#include "tests/simulator/random.hpp"

namespace boresight::simulator {

namespace {

constexpr std::size_t kMaxPerScan = 300;
constexpr double kUnambiguous_mps = 80.0;
constexpr double kGhostProbability = 0.15;

/// A vehicle at an instant, world frame.
struct VehicleState {
  std::uint32_t id;
  double arc_m, lateral_m, arc_speed_mps;
  Eigen::Vector2d position_m;
  double heading_rad;
  Eigen::Vector2d velocity_mps;
  double yaw_rate_radps;
  double length_m, width_m;
};

VehicleState on_road(const Road& road, double arc_m, double lateral_m, double arc_speed_mps) {
  const Motion m = along_road(road, arc_m, arc_speed_mps, 0.0, {{0.0, lateral_m}}, arc_speed_mps < 0.0);
  return {0,   arc_m, lateral_m, arc_speed_mps, m.position_m, m.heading_rad, m.velocity_mps(), m.yaw_rate_radps,
          0.0, 0.0};
}

VehicleState vehicle_at(const World& world, std::size_t index, double t_s) {
  const Body b = world.body(index, t_s);
  const Motion m = world.motion(index, t_s);
  return {b.id,          m.arc_m,        m.lateral_m,      m.arc_speed_mps, b.position_m,
          b.heading_rad, b.velocity_mps, b.yaw_rate_radps, b.length_m,      b.width_m};
}

Eigen::Vector3d lift(const Eigen::Vector2d& p, double z) {
  return {p.x(), p.y(), z};
}

/// Whether the segment from a to b passes through the box of a vehicle (in the plane).
bool blocks(const VehicleState& vehicle, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double c = std::cos(vehicle.heading_rad), s = std::sin(vehicle.heading_rad);
  const auto local = [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d d = p - vehicle.position_m;
    return Eigen::Vector2d(c * d.x() + s * d.y(), -s * d.x() + c * d.y());
  };
  const Eigen::Vector2d from = local(a), along = local(b) - from;
  const Eigen::Vector2d half(0.5 * vehicle.length_m, 0.5 * vehicle.width_m);
  double enter = 0.0, leave = 1.0;
  for (Eigen::Index k = 0; k < 2; ++k) {
    if (std::abs(along(k)) < 1e-9) {
      if (std::abs(from(k)) > half(k)) return false;
      continue;
    }
    double t0 = (-half(k) - from(k)) / along(k), t1 = (half(k) - from(k)) / along(k);
    if (t0 > t1) std::swap(t0, t1);
    enter = std::max(enter, t0);
    leave = std::min(leave, t1);
  }
  return enter < leave;
}

}  // namespace

/// A path to something that reflects: where it appears from the sensor, world frame.
struct RadarModel::Target {
  Eigen::Vector3d direction;  // unit, world
  double range_m;
  double range_rate_mps;
  double rcs_dbsm;
  DetectionTruth truth;
};

/// The sensor in the world at the instant of a scan.
struct RadarModel::Instant {
  simulator::Scene scene;
  double t_s;
  EgoState ego;
  Eigen::Vector3d position;  // of the sensor
  Eigen::Vector3d velocity;
  Eigen::Matrix3d vehicle_to_world;
  std::vector<VehicleState> vehicles;
  std::uint32_t cycle;
};

RadarModel::RadarModel(const RadarConfig& radar, const Scenario& scenario, std::uint64_t seed)
    : radar_(radar), scenario_(scenario), seed_(seed) {
  const Misalignment& m = scenario.effects.misalignment[radar.id];
  actual_ = geometry::sensor_to_vehicle(radar.mounting_pose, m.yaw_rad, m.pitch_rad, m.roll_rad);
}

void RadarModel::add_stationary(const Instant& scene, std::vector<Target>& targets) const {
  const double reach = radar_.field_of_view.range_max_m;
  for (const Scatterer& scatterer : scene.scene.scatterers) {
    const Scatterer* const p = &scatterer;
    const Eigen::Vector3d sight = p->position_m - scene.position;
    const double range = sight.norm();
    if (range > reach || range < 0.5) continue;
    const Eigen::Vector3d direction = sight / range;
    bool hidden = false;
    // What stands higher than a car is seen over it.
    for (const VehicleState& v : scene.vehicles) {
      hidden = hidden || (p->position_m.z() < 1.5 && blocks(v, scene.position.head<2>(), p->position_m.head<2>()));
    }
    if (hidden) continue;
    targets.push_back({direction, range, -direction.dot(scene.velocity), p->rcs_dbsm, {Provenance::kStationary, 0}});
  }
}

void RadarModel::add_ghosts(const World& world, const Instant& scene, std::size_t index,
                            const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                            std::vector<Target>& targets) const {
  const Eigen::Vector3d sight = position - scene.position;
  const VehicleState& vehicle = scene.vehicles[index];
  for (const StructureSpec& structure : scenario_.structures) {
    const double rail = structure.lateral_m;
    // Type 2: the three-bounce path by the rail sees the target's mirror image, which travels along the road as the
    // target does.
    const double mirrored_lateral = 2.0 * rail - vehicle.lateral_m;
    const double arc_speed = vehicle.arc_speed_mps;
    const VehicleState mirror = on_road(world.road(), vehicle.arc_m, mirrored_lateral, arc_speed);
    const Eigen::Vector3d mirror_sight = lift(mirror.position_m, position.z()) - scene.position;
    const double mirror_range = mirror_sight.norm();
    const Eigen::Vector3d mirror_direction = mirror_sight / mirror_range;
    targets.push_back({mirror_direction,
                       mirror_range,
                       mirror_direction.dot(lift(mirror.velocity_mps, 0.0) - scene.velocity),
                       -12.0,
                       {Provenance::kGhostType2, vehicle.id}});
    // Type 1: sensor → rail → target → sensor: half the way there is from the mirrored sensor.
    const VehicleState sensor_mirror = on_road(world.road(), scene.ego.arc_m, 2.0 * rail, scene.ego.speed_mps);
    const Eigen::Vector3d from_mirror = position - (lift(sensor_mirror.position_m, scene.position.z()) +
                                                    (scene.position - lift(scene.ego.position_m, scene.position.z())));
    const double direct = sight.norm(), detour = from_mirror.norm();
    const Eigen::Vector3d direction = sight / direct;
    const double rate = 0.5 * (direction.dot(velocity - scene.velocity) +
                               from_mirror.dot(velocity - lift(sensor_mirror.velocity_mps, 0.0)) / detour);
    targets.push_back({direction, 0.5 * (direct + detour), rate, -14.0, {Provenance::kGhostType1, vehicle.id}});
  }
}

void RadarModel::add_vehicles(const World& world, const Instant& scene, std::vector<Target>& targets) const {
  for (const VehicleState& v : scene.vehicles) {
    if ((v.position_m - scene.ego.position_m).norm() > radar_.field_of_view.range_max_m + 10.0) continue;
    const double c = std::cos(v.heading_rad), s = std::sin(v.heading_rad);
    // Corners, middles of the sides and of the ends; those on the sides that face the radar reflect.
    constexpr std::array<std::array<double, 2>, 8> kOutline = {
        {{1, 1}, {1, 0}, {1, -1}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}, {0, 1}}};
    std::uint64_t outline_index = 0;
    for (const auto& [u, w] : kOutline) {
      ++outline_index;
      const Eigen::Vector2d body(0.5 * v.length_m * u, 0.5 * v.width_m * w);
      const Eigen::Vector2d offset(c * body.x() - s * body.y(), s * body.x() + c * body.y());
      const Eigen::Vector2d point = v.position_m + offset;
      const Eigen::Vector2d normal_x(c * u, s * u), normal_y(-s * w, c * w);
      const Eigen::Vector2d to_sensor = scene.position.head<2>() - point;
      if (normal_x.dot(to_sensor) <= 0.0 && normal_y.dot(to_sensor) <= 0.0) continue;
      bool hidden = false;
      for (const VehicleState& other : scene.vehicles) {
        hidden = hidden || (other.id != v.id && blocks(other, scene.position.head<2>(), point));
      }
      if (hidden) continue;
      const Eigen::Vector3d position = lift(point, 0.6);
      const Eigen::Vector3d velocity =
          lift(v.velocity_mps + v.yaw_rate_radps * Eigen::Vector2d(-offset.y(), offset.x()), 0.0);
      const Eigen::Vector3d sight = position - scene.position;
      const double range = sight.norm();
      if (range > radar_.field_of_view.range_max_m || range < 0.5) continue;
      const Eigen::Vector3d direction = sight / range;
      targets.push_back({direction, range, direction.dot(velocity - scene.velocity), 8.0, {Provenance::kMoving, v.id}});
      Stream ghost(seed_, "ghost", (static_cast<std::uint64_t>(radar_.id) << 32) | scene.cycle,
                   (static_cast<std::uint64_t>(v.id) << 8) | outline_index);
      if (ghost.uniform() < kGhostProbability) {
        add_ghosts(world, scene, static_cast<std::size_t>(&v - scene.vehicles.data()), position, velocity, targets);
      }
    }
  }
}

void RadarModel::measure(const World& world, double t_s, std::uint32_t cycle, RadarScan& scan,
                         std::vector<DetectionTruth>& truth) const {
  Instant scene;
  world.at(t_s, radar_.field_of_view.range_max_m, scene.scene);
  scene.t_s = t_s;
  scene.cycle = cycle;
  scene.ego = world.ego(t_s);
  const double c = std::cos(scene.ego.heading_rad), s = std::sin(scene.ego.heading_rad);
  scene.vehicle_to_world << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  const Eigen::Vector3d mount(radar_.mounting_pose.position_m.data());
  scene.position = lift(scene.ego.position_m, 0.0) + scene.vehicle_to_world * mount;
  scene.velocity =
      scene.vehicle_to_world *
      geometry::sensor_velocity(1.0, scene.ego.speed_mps, scene.ego.yaw_rate_radps, radar_.mounting_pose.position_m);
  for (std::size_t i = 0; i < world.number_of_bodies(); ++i) {
    scene.vehicles.push_back(vehicle_at(world, i, t_s));
  }

  std::vector<Target> targets;
  add_vehicles(world, scene, targets);
  add_stationary(scene, targets);

  const std::uint64_t cycle_index = (static_cast<std::uint64_t>(radar_.id) << 32) | cycle;
  const FieldOfView& view = radar_.field_of_view;
  const Eigen::Matrix3d world_to_sensor = actual_.transpose() * scene.vehicle_to_world.transpose();
  truth.clear();
  std::uint32_t count = 0;
  const auto add = [&](double range, double azimuth, double elevation, double rate, double rcs,
                       const DetectionTruth& origin, const SensorNoise& noise) {
    if (count == kMaxPerScan) return;
    scan.range_m[count] = static_cast<float>(range);
    scan.azimuth_rad[count] = static_cast<float>(azimuth);
    scan.elevation_rad[count] = static_cast<float>(elevation);
    scan.range_rate_mps[count] = static_cast<float>(rate);
    scan.rcs_dbsm[count] = static_cast<float>(std::clamp(std::round(rcs), -127.0, 127.0));
    scan.snr_db[count] = 0.0F;
    scan.range_std_m[count] = static_cast<float>(noise.range_std_m);
    scan.azimuth_std_rad[count] = static_cast<float>(noise.azimuth_std_rad);
    scan.elevation_std_rad[count] = static_cast<float>(noise.elevation_std_rad);
    scan.range_rate_std_mps[count] = static_cast<float>(noise.range_rate_std_mps);
    scan.existence_probability[count] = 1.0F;
    scan.detection_flags[count] = std::abs(rate) > kUnambiguous_mps ? detection_flag::kAmbiguous : 0;
    truth.push_back(origin);
    ++count;
  };

  const double on = scenario_.effects.noise ? 1.0 : 0.0;
  std::uint64_t index = 0;
  for (const Target& target : targets) {
    Stream stream(seed_, "detection", cycle_index, index++);
    const Eigen::Vector3d d = world_to_sensor * target.direction;
    const double azimuth = std::atan2(d.y(), d.x());
    const double elevation = std::asin(std::clamp(d.z(), -1.0, 1.0));
    if (azimuth < view.azimuth_min_rad || azimuth > view.azimuth_max_rad || elevation < view.elevation_min_rad ||
        elevation > view.elevation_max_rad || target.range_m > view.range_max_m) {
      continue;
    }
    const double rcs = target.rcs_dbsm + 3.0 * on * stream.gaussian();
    // Weak and far reflections are seen less often; at most three of four, as a resolution cell holds one detection.
    const double margin_db = rcs + 32.0 - 20.0 * std::log10(std::max(1.0, target.range_m / 10.0));
    const double detection_probability = 0.75 / (1.0 + std::exp(-0.4 * (margin_db - 20.0)));
    if (stream.uniform() > detection_probability) continue;
    SensorNoise noise = radar_.noise;
    noise.azimuth_std_rad /= std::max(0.35, std::cos(azimuth));  // the beam widens off boresight
    add(std::max(0.1, target.range_m + on * noise.range_std_m * stream.gaussian()),
        azimuth + on * noise.azimuth_std_rad * stream.gaussian(),
        elevation + on * noise.elevation_std_rad * stream.gaussian(),
        target.range_rate_mps + on * noise.range_rate_std_mps * stream.gaussian(), rcs, target.truth, noise);
  }
  Stream clutter(seed_, "clutter", cycle_index);
  const unsigned false_detections = clutter.poisson(scenario_.effects.clutter_per_scan);
  for (unsigned i = 0; i < false_detections; ++i) {
    const double range = clutter.uniform(1.0, view.range_max_m);
    const double azimuth = clutter.uniform(view.azimuth_min_rad, view.azimuth_max_rad);
    const double elevation = clutter.uniform(view.elevation_min_rad, view.elevation_max_rad);
    const double rate = clutter.uniform(-30.0, 30.0);
    add(range, azimuth, elevation, rate, clutter.uniform(-20.0, -10.0), {Provenance::kClutter, 0}, radar_.noise);
  }
  scan.cycle_counter = cycle;
  scan.number_of_valid_detections = count;
  scan.dropped_detections = 0;
  scan.fields =
      scan_field::kElevation | scan_field::kRcs | scan_field::kStds | scan_field::kExistence | scan_field::kAmbiguity;
  scan.range_rate_min_mps = static_cast<float>(-kUnambiguous_mps);
  scan.range_rate_max_mps = static_cast<float>(kUnambiguous_mps);
}

}  // namespace boresight::simulator
