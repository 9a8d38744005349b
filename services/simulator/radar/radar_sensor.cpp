#include "services/simulator/radar/radar_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "services/simulator/radar/detector.hpp"
#include "services/simulator/radar/doppler.hpp"
#include "services/simulator/radar/false_echoes.hpp"
#include "services/simulator/radar/key.hpp"
#include "services/simulator/radar/measurement_noise.hpp"
#include "services/simulator/radar/mounting.hpp"
#include "services/simulator/radar/returns/strength.hpp"
#include "services/simulator/radar/returns/validity.hpp"
#include "services/simulator/random.hpp"

namespace boresight::simulator {

namespace {

constexpr double kNearlyStill_mps = 0.1;  // a body is stationary if all its parts are slower
constexpr double kEmbedded_m = 0.5;       // scatterers at most this deep in a wall are facets of the wall
constexpr double kFaintest_db = 15.0;     // echoes this far below the threshold are never detected, alone or together
constexpr double kFalseRate_mps = 30.0;
constexpr double kClutterExcess_db = 3.0, kInterferenceExcess_db = 5.0;

bool moves(const Body& body) {
  return !body.parked &&
         (body.velocity_mps.norm() > kNearlyStill_mps ||
          std::abs(body.yaw_rate_radps) * 0.5 * std::hypot(body.length_m, body.width_m) > kNearlyStill_mps);
}

/// Clutter or interference: drawn as measured, without noise of measurement.
bool is_noise_itself(const radar::Echo& echo) {
  return echo.truth.provenance == Provenance::kClutter &&
         (echo.truth.cause == Cause::kNone || echo.truth.cause == Cause::kInterference);
}

}  // namespace

RadarSensor::RadarSensor(const RadarConfig& config, const RadarEffects& effects, const radar::EgoBody& ego_body,
                         std::uint64_t seed)
    : config_(config),
      effects_(effects),
      seed_(seed),
      of_car_(car::radar_of_car(effects.real_car, seed, config.id, config.field_of_view)),
      true_position_(of_car_.true_position(config.mounting_pose)),
      ego_box_(radar::seen_from(ego_body, Eigen::Vector3d(true_position_.position_m.data()))),
      swerling_order_(radar::swerling_order(effects.sensitivity.rcs_fluctuation_db)),
      antenna_(config.field_of_view),
      propagation_(effects.multipath, config.field_of_view.range_max_m),
      cells_(effects.resolution),
      returns_(effects.profile_of(config.id), effects.sensitivity, config.cycle_time_s),
      rcs_offset_db_(radar::radar_offset_db(returns_.profile().strength, {seed, config.id, 0})) {}

std::uint32_t RadarSensor::condition(double t_s) const {
  std::vector<radar::Dirt> dirt;
  radar::dirt_at(effects_.blockages, config_.id, t_s, dirt);
  return radar::stated_condition(dirt, config_.field_of_view);
}

void RadarSensor::add(const radar::Target& target, bool with_mirrors, double embedded_m,
                      const Eigen::Matrix3d& world_to_sensor) {
  paths_.clear();
  propagation_.direct(target, embedded_m, paths_);
  if (with_mirrors) propagation_.mirrored(target, paths_);
  radar::combine(target, paths_, effects_.multipath, antenna_, world_to_sensor, echoes_);
}

void RadarSensor::add_bodies(const Scene& scene, const Eigen::Matrix3d& world_to_sensor) {
  for (const Body& body : scene.bodies) {
    const double radius = 0.5 * std::hypot(body.length_m, body.width_m) + 0.5;
    const Eigen::Vector3d centre(body.position_m.x(), body.position_m.y(), 0.0);
    // No path is shorter than the direct one.
    if ((centre - view_.position_m).head<2>().norm() > config_.field_of_view.range_max_m + radius) continue;
    const bool moving = moves(body);
    const bool with_mirrors = moving || effects_.multipath.of_stationary;
    if (with_mirrors) propagation_.choose(centre, radius);
    for (std::uint32_t i = 0; i < body.number_of_centres && body.first_centre + i < scene.centres.size(); ++i) {
      const ReflectionCentre& c = scene.centres[body.first_centre + i];
      add({c.position_m, c.velocity_mps, c.facing, c.rcs_dbsm, body.id, moving, radar::key_of(body.id, i)},
          with_mirrors, 0.05, world_to_sensor);
    }
  }
}

void RadarSensor::add_scatterers(const Scene& scene, const Eigen::Matrix3d& world_to_sensor) {
  const FieldOfView& fov = config_.field_of_view;
  // Ground and fluctuation together add at most about 15 dB. Weaker scatterers need no test of occlusion.
  const double faintest = effects_.sensitivity.threshold_db - 2.0 * kFaintest_db;
  for (const Scatterer& s : scene.scatterers) {
    const Eigen::Vector3d sight = s.position_m - view_.position_m;
    const double range = sight.norm();
    if (range > fov.range_max_m || range < 0.5) continue;
    if (radar::radar_equation_db(s.rcs_dbsm, range, range) < faintest) continue;
    const Eigen::Vector3d look = world_to_sensor * sight;
    const double azimuth = std::atan2(look.y(), look.x());
    if (!effects_.multipath.of_stationary && (azimuth < fov.azimuth_min_rad || azimuth > fov.azimuth_max_rad)) continue;
    if (effects_.multipath.of_stationary) propagation_.choose(s.position_m, 0.0);
    add({s.position_m, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), s.rcs_dbsm, 0, false,
         radar::key_of(s.position_m), s.origin},
        effects_.multipath.of_stationary, kEmbedded_m, world_to_sensor);
  }
}

void RadarSensor::fluctuate(std::uint64_t cycle_key, double noise_rise_db) {
  const double faintest = effects_.sensitivity.threshold_db - kFaintest_db;
  std::size_t kept = 0;
  for (radar::Echo& echo : echoes_) {
    echo.power_db -= noise_rise_db;
    if (effects_.noise && effects_.sensitivity.rcs_fluctuation_db > 0.0) {
      Stream stream(seed_, "fluctuation", cycle_key, echo.key);
      echo.power_db += radar::fluctuation_db(swerling_order_, stream.gaussian());
    }
    if (!(echo.power_db > faintest)) continue;
    echo.range_rate_mps = radar::fold(echo.range_rate_mps, effects_.unambiguous_mps);
    echoes_[kept++] = echo;
  }
  echoes_.resize(kept);
}

void RadarSensor::keep_detected(std::uint64_t cycle_key) {
  std::erase_if(echoes_, [&](const radar::Echo& echo) {
    Stream stream(seed_, "detection", cycle_key, echo.key);
    return stream.uniform() >= radar::detection_probability(echo.power_db, effects_.sensitivity);
  });
}

void RadarSensor::add_false_detections(std::uint32_t cycle, double interference_per_scan) {
  const std::uint64_t cycle_key = radar::cycle_key(config_.id, cycle);
  const double threshold = effects_.sensitivity.threshold_db;
  const double rate_max =
      effects_.unambiguous_mps > 0.0 ? std::min(effects_.unambiguous_mps, kFalseRate_mps) : kFalseRate_mps;
  false_echoes_.clear();
  Stream clutter(seed_, "clutter", cycle_key), interference(seed_, "interference", cycle_key);
  radar::add_false(clutter, effects_.clutter_per_scan, kClutterExcess_db, threshold, rate_max, config_.field_of_view,
                   Cause::kNone, false_echoes_);
  radar::add_false(interference, interference_per_scan, kInterferenceExcess_db, threshold, rate_max,
                   config_.field_of_view, Cause::kInterference, false_echoes_);
  const radar::Draws draws{seed_, config_.id, cycle};
  for (radar::Echo& e : false_echoes_) returns_.restate_noise(draws, config_.field_of_view, e);
  // A cell holds one detection: a false echo in the cell of a real one is dropped.
  const std::size_t real = echoes_.size();
  for (const radar::Echo& e : false_echoes_) {
    const auto end = echoes_.begin() + static_cast<std::ptrdiff_t>(real);
    if (std::all_of(echoes_.begin(), end, [&](const auto& r) { return radar::resolved(effects_.resolution, e, r); })) {
      echoes_.push_back(e);
    }
  }
}

void RadarSensor::distort(radar::Echo& echo, std::uint64_t cycle_key) const {
  const double share = effects_.real_car.road_mirror_share;
  if (share > 0.0 && echo.truth.cause == Cause::kNone &&
      Stream(seed_, "real car road mirror", cycle_key, echo.key).uniform() < share) {
    const Eigen::Vector3d direction = view_.sensor_to_world * geometry::direction(echo.azimuth_rad, echo.elevation_rad);
    if (const auto image = car::mirrored_by_road(direction, echo.range_m, view_.position_m.z())) {
      const radar::Look look = antenna_.look(view_.sensor_to_world.transpose() * *image);
      if (look.inside) {
        echo.azimuth_rad = look.azimuth_rad;
        echo.elevation_rad = look.elevation_rad;
        echo.truth.cause = Cause::kRoadMirror;
      }
    }
  }
  echo.azimuth_rad += of_car_.curve.error_rad(echo.azimuth_rad);
  echo.range_rate_mps *= of_car_.range_rate_scale;
}

void RadarSensor::write(std::uint32_t cycle, RadarScan& scan, std::vector<DetectionTruth>& truth) const {
  truth.clear();
  const std::uint64_t cycle_key = radar::cycle_key(config_.id, cycle);
  const radar::Draws draws{seed_, config_.id, cycle};
  const std::size_t most = std::min<std::size_t>(kMaxDetections, effects_.sensitivity.max_detections);
  const std::size_t count = std::min(most, echoes_.size());
  const double limit = effects_.unambiguous_mps;
  for (std::size_t i = 0; i < count; ++i) {
    const radar::Echo& echo = echoes_[i];
    radar::Echo seen = echo;
    if (!is_noise_itself(echo)) distort(seen, cycle_key);
    const SensorNoise noise = radar::noise_of(config_.noise, echo.azimuth_rad, echo.elevation_rad,
                                              echo.power_db - effects_.sensitivity.threshold_db);
    Stream stream(seed_, "noise", cycle_key, echo.key);
    const double on = effects_.noise && !is_noise_itself(echo) ? 1.0 : 0.0;
    const double range = echo.range_m + on * noise.range_std_m * stream.gaussian();
    const double azimuth = seen.azimuth_rad + on * noise.azimuth_std_rad * stream.gaussian();
    const double elevation = seen.elevation_rad + on * noise.elevation_std_rad * stream.gaussian();
    const double rate = radar::fold(seen.range_rate_mps + on * noise.range_rate_std_mps * stream.gaussian(), limit);
    // The sensor corrects for its pattern and range. It does not know the loss by dirt or the true length of the path.
    const double rcs = echo.power_db + 40.0 * std::log10(echo.range_m / 10.0) -
                       2.0 * radar::pattern_db(echo.azimuth_rad, echo.elevation_rad, config_.field_of_view);
    scan.range_m[i] = static_cast<float>(std::max(0.1, range));
    scan.azimuth_rad[i] = static_cast<float>(azimuth);
    scan.elevation_rad[i] = static_cast<float>(elevation);
    scan.range_rate_mps[i] = static_cast<float>(rate);
    scan.rcs_dbsm[i] = static_cast<float>(std::clamp(std::round(rcs + rcs_offset_db_), -127.0, 127.0));
    scan.snr_db[i] = 0.0F;
    scan.range_std_m[i] = static_cast<float>(noise.range_std_m);
    scan.azimuth_std_rad[i] = static_cast<float>(noise.azimuth_std_rad);
    scan.elevation_std_rad[i] = static_cast<float>(noise.elevation_std_rad);
    scan.range_rate_std_mps[i] = static_cast<float>(noise.range_rate_std_mps);
    const radar::Verdict verdict =
        radar::verdict_on(returns_.profile().validity, radar::is_direct(echo), echo.key, draws);
    scan.existence_probability[i] = static_cast<float>(verdict.existence);
    scan.detection_flags[i] = verdict.flags;
    truth.push_back(seen.truth);
  }
  scan.number_of_valid_detections = static_cast<std::uint32_t>(count);
  scan.dropped_detections = static_cast<std::uint16_t>(std::min<std::size_t>(65535, echoes_.size() - count));
  scan.integrity = 0;
  scan.fields = scan_field::kElevation | scan_field::kRcs | scan_field::kStds | scan_field::kExistence;
  if (limit > 0.0) scan.fields |= scan_field::kAmbiguity;
  scan.range_rate_min_mps = static_cast<float>(limit > 0.0 ? -limit : 0.0);
  scan.range_rate_max_mps = static_cast<float>(limit > 0.0 ? limit : 0.0);
}

void RadarSensor::measure(const Scene& scene, std::uint32_t cycle, RadarScan& scan,
                          std::vector<DetectionTruth>& truth) {
  view_ = radar::viewpoint(scene.ego, true_position_,
                           radar::actual_mounting(config_.mounting_pose, effects_, config_.id, scene.t_s));
  const Eigen::Matrix3d world_to_sensor = view_.sensor_to_world.transpose();
  radar::dirt_at(effects_.blockages, config_.id, scene.t_s, dirt_);
  antenna_.set_dirt(dirt_);
  propagation_.prepare(scene, view_, ego_box_);
  echoes_.clear();
  add_bodies(scene, world_to_sensor);
  if (returns_.is_on()) returns_.note_bodies(scene, echoes_);
  add_scatterers(scene, world_to_sensor);

  const std::uint64_t key = radar::cycle_key(config_.id, cycle);
  const radar::Disturbance disturbance = radar::disturbance_at(effects_.interference, config_.id, scene.t_s);
  fluctuate(key, disturbance.noise_rise_db);
  cells_.merge(echoes_);
  keep_detected(key);
  if (returns_.is_on()) {
    returns_.apply({scene, view_, antenna_, propagation_, dirt_, disturbance.noise_rise_db, {seed_, config_.id, cycle}},
                   echoes_);
  }
  add_false_detections(cycle, disturbance.detections_per_scan);
  std::sort(echoes_.begin(), echoes_.end(), [](const radar::Echo& a, const radar::Echo& b) {
    return a.power_db != b.power_db ? a.power_db > b.power_db : a.key < b.key;
  });
  write(cycle, scan, truth);
  scan.cycle_counter = cycle;
}

}  // namespace boresight::simulator
