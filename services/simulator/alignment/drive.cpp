#include "services/simulator/alignment/drive.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/simulator/alignment/motion.hpp"
#include "services/simulator/alignment/moving_objects.hpp"
#include "services/simulator/alignment/reflection_draws.hpp"
#include "services/simulator/car/radar_of_car.hpp"
#include "services/simulator/car/signals.hpp"
#include "services/simulator/random.hpp"

namespace boresight::simulator {

namespace {

constexpr auto kStart_ns = static_cast<std::int64_t>(AlignmentDrive::kStart_s * 1e9);

std::int64_t stamp_ns(double since_start_s) {
  return kStart_ns + std::llround(since_start_s * 1e9);
}

constexpr double kMedianRange_m = 18.0;
constexpr double kNearest_m = 2.0;

struct RadarState {
  AlignmentRadar spec;
  View view;
  car::RadarOfCar of_car;
  Stream movement;
  std::vector<MovingObject> objects;  // kObjectsOfAKind of each kind
  std::uint32_t cycle = 0;
  [[nodiscard]] std::int64_t next_ns() const {
    return stamp_ns(spec.first_scan_s + static_cast<double>(cycle) * spec.config.cycle_time_s);
  }
};

RadarState make_radar(const AlignmentRadar& spec, const car::RealCar& car, std::uint64_t seed, std::size_t index) {
  RadarState radar{spec,
                   view_of(spec.config),
                   car::radar_of_car(car, seed, spec.config.id, spec.config.field_of_view),
                   Stream(seed, "alignment objects", index),
                   {},
                   0};
  radar.objects = make_moving_objects(radar.view, spec.config.cycle_time_s, radar.movement);
  return radar;
}

double clamp_range_m(const RadarConfig& config, double range_m) {
  return std::clamp(range_m, kNearest_m, std::max(kNearest_m, config.field_of_view.range_max_m));
}

constexpr double kMostDetections = 600.0;  // largest mean number, since the Poisson draw needs e^−mean > 0
/// Standard deviation that the sensor states; greater than 0 even without noise.
double stated_speed_std_mps(const AlignmentSpec& spec) {
  return std::max(spec.speed_std_mps, 1e-4);
}
double stated_yaw_rate_std_radps(const AlignmentSpec& spec) {
  return std::max(spec.yaw_rate_std_radps, 1e-6);
}

/// Angles of a detection in the sensor's frame, radians.
struct Angles {
  double azimuth, elevation;
};

/// True mounting angles of the radar: nominal plus misalignment plus step changes.
struct Mounting {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d yaw_pitch_roll_rad;
};

}  // namespace

struct AlignmentDrive::State {
  explicit State(const AlignmentSpec& s)
      : spec(s),
        road(s),
        speed_noise(s.seed, "alignment speed noise"),
        yaw_rate_noise(s.seed, "alignment yaw rate noise"),
        end_ns(stamp_ns(s.duration_s)) {
    for (std::size_t i = 0; i < s.radars.size(); ++i) radars.push_back(make_radar(s.radars[i], s.real_car, s.seed, i));
    truth.reserve(kMaxDetections);
  }

  AlignmentSpec spec;
  AlignmentRoad road;
  Stream speed_noise, yaw_rate_noise;
  std::int64_t end_ns;
  std::vector<RadarState> radars;
  std::uint64_t ego_count = 0, scan_count = 0;
  std::unique_ptr<RadarScan> scan = std::make_unique<RadarScan>();  // zeros
  EgoMotion ego{};
  std::vector<AlignmentDetectionTruth> truth;

  [[nodiscard]] Mounting mounting(std::size_t radar, double time_s) const {
    const MountingPose& nominal = spec.radars[radar].config.mounting_pose;
    const Misalignment& m = spec.radars[radar].truth;
    Mounting out{geometry::sensor_to_vehicle(nominal, m.yaw_rad, m.pitch_rad, m.roll_rad),
                 {nominal.yaw_rad + m.yaw_rad, nominal.pitch_rad + m.pitch_rad, nominal.roll_rad + m.roll_rad}};
    for (const StepChange& step_change : spec.step_changes) {
      if (step_change.radar != radar || time_s < step_change.time_s) continue;
      out.rotation = geometry::so3_exp(step_change.rotation_vehicle_rad) * out.rotation;
      out.yaw_pitch_roll_rad = geometry::euler_angles(out.rotation);
    }
    return out;
  }

  void make_ego(const AlignmentMotion& motion);
  void make_scan(std::size_t index, double time_s, const AlignmentMotion& motion);
};

void AlignmentDrive::State::make_ego(const AlignmentMotion& motion) {
  ++ego_count;
  ego = EgoMotion{};
  ego.header.version = EgoMotion::kVersion;
  ego.header.sequence = ego.header.source_sequence = ego_count;
  ego.header.measurement_time_ns = stamp_ns(static_cast<double>(ego_count - 1) / spec.ego_rate_hz);
  ego.header.time_source = TimeSource::kSensorSynchronised;
  ego.fields = ego_field::kSpeed | ego_field::kYawRate;
  ego.speed_mps = static_cast<float>(car::quantised_speed(
      spec.real_car, motion.speed_mps / spec.speed_scale + spec.speed_std_mps * speed_noise.gaussian()));
  ego.yaw_rate_radps =
      static_cast<float>(car::signalled_yaw_rate(spec.real_car, motion.yaw_rate_radps) + spec.yaw_rate_bias_radps +
                         spec.yaw_rate_std_radps * yaw_rate_noise.gaussian());
  ego.speed_std_mps = static_cast<float>(stated_speed_std_mps(spec));
  ego.yaw_rate_std_radps = static_cast<float>(stated_yaw_rate_std_radps(spec));
  ego.longitudinal_acceleration_mps2 = static_cast<float>(motion.acceleration_mps2 / spec.speed_scale);
}

void AlignmentDrive::State::make_scan(std::size_t index, double time_s, const AlignmentMotion& motion) {
  RadarState& radar = radars[index];
  const AlignmentRadar& r = radar.spec;
  const RadarConfig& config = r.config;
  const Mounting mount = mounting(index, time_s);
  const Eigen::Matrix3d to_sensor = mount.rotation.transpose();
  const std::array<double, 3> p = radar.of_car.true_position(config.mounting_pose).position_m;
  const Eigen::Vector3d velocity(motion.speed_mps - motion.yaw_rate_radps * p[1],
                                 motion.lateral_speed_mps + motion.yaw_rate_radps * p[0], motion.vertical_speed_mps);
  const double yaw = mount.yaw_pitch_roll_rad.x(), pitch = mount.yaw_pitch_roll_rad.y();
  const double cos_roll = std::cos(mount.yaw_pitch_roll_rad.z()), sin_roll = std::sin(mount.yaw_pitch_roll_rad.z());

  // Each effect of each scan has a random stream of its own: no effect shifts the draws of another.
  const auto stream = [&](std::string_view effect) { return Stream(spec.seed, effect, index, radar.cycle); };
  Stream scene = stream("alignment scene"), outliers = stream("alignment outliers");
  Stream azimuth_noise = stream("alignment azimuth noise"), elevation_noise = stream("alignment elevation noise");
  Stream rate_noise = stream("alignment rate noise"), range_noise = stream("alignment range noise");
  Stream strength = stream("alignment strength"), road_mirror = stream("real car road mirror");
  for (MovingObject& o : radar.objects) o.step(radar.movement);

  const double drawn = stream("alignment count").poisson(std::min(r.mean_detections, kMostDetections));
  const std::size_t count = static_cast<std::size_t>(
      std::clamp(drawn, std::min(10.0, r.mean_detections), static_cast<double>(kMaxDetections)));

  RadarScan& out = *scan;
  ++scan_count;
  out.header.version = RadarScan::kVersion;
  out.header.source_id = config.id;
  out.header.sequence = scan_count;
  out.header.source_sequence = radar.cycle + 1;
  const std::int64_t stamp_ns = radar.next_ns() + radar.of_car.stamp_offset_ns();
  out.header.measurement_time_ns = stamp_ns;
  out.header.time_source = TimeSource::kSensorSynchronised;
  out.header.stage(Stage::kIngest) = {stamp_ns, stamp_ns};
  out.cycle_counter = radar.cycle;
  out.number_of_valid_detections = static_cast<std::uint32_t>(count);
  out.dropped_detections = 0;
  out.integrity = 0;
  out.fields = scan_field::kRcs | scan_field::kExistence;
  if (r.measures_elevation) out.fields |= scan_field::kElevation;
  if (r.states_stds) out.fields |= scan_field::kStds;
  if (r.ambiguity_mps > 0.0) out.fields |= scan_field::kAmbiguity;
  out.range_rate_max_mps = static_cast<float>(0.5 * std::max(r.ambiguity_mps, 0.0));
  out.range_rate_min_mps = -out.range_rate_max_mps;
  truth.resize(count);

  const auto seen = [&](const Eigen::Vector3d& sight, double azimuth_vehicle, double elevation) -> Angles {
    if (spec.model == MountingModel::kExact) {
      const Eigen::Vector3d u = to_sensor * sight;
      return {std::atan2(u.y(), u.x()), std::asin(std::clamp(u.z(), -1.0, 1.0))};
    }
    // Burza 2025, (10)(11), solved for the angles that the sensor sees
    const double a = geometry::wrap_angle(azimuth_vehicle - yaw), b = elevation - pitch;
    return {cos_roll * a + sin_roll * b, -sin_roll * a + cos_roll * b};
  };

  for (std::size_t i = 0; i < count; ++i) {
    double azimuth = draw_azimuth_rad(radar.view, scene);
    double range_m = clamp_range_m(config, kMedianRange_m * std::exp(0.75 * scene.gaussian()));
    const double elevation = draw_elevation_rad(spec.elevation, radar.view, range_m, scene);

    // Every detection takes the same number of draws, so that a larger outlier share only adds outliers.
    const bool is_outlier = outliers.uniform() < spec.outlier_share;
    const double sort = outliers.uniform(), place = outliers.uniform(), spread = outliers.uniform(-1.0, 1.0);
    const MovingObject* object = nullptr;
    if (is_outlier && sort < kMovingShare) {
      object = &radar.objects[object_of(sort)];
      azimuth = std::clamp(radar.view.azimuth(0.5) + object->azimuth_rad.value() + 6.0 * kRadiansPerDegree * spread,
                           radar.view.azimuth_min_rad, radar.view.azimuth_max_rad);
      range_m = clamp_range_m(config, kMedianRange_m * std::exp(object->log_range.value()) + 2.0 * spread);
    }

    const double azimuth_vehicle = config.mounting_pose.yaw_rad + azimuth;
    const Eigen::Vector3d sight = geometry::direction(azimuth_vehicle, elevation);
    double rate = geometry::stationary_range_rate(sight, velocity);
    if (object != nullptr) rate += sight.dot(object->velocity_mps(motion.speed_mps));
    auto [seen_azimuth, seen_elevation] = seen(sight, azimuth_vehicle, elevation);
    // A ghost: its range rate is that of a stationary reflection, but its azimuth is another.
    if (is_outlier && object == nullptr) {
      seen_azimuth = radar.view.azimuth(place) * (cos_roll < 0.0 ? -1.0 : 1.0);
    }
    truth[i] = {!is_outlier, seen_azimuth, seen_elevation};
    // What the radar's noise adds to: the angles that road and bumper show, the range rate by the radar's own clock.
    Angles shown{seen_azimuth, seen_elevation};
    if (spec.real_car.road_mirror_share > 0.0 && road_mirror.uniform() < spec.real_car.road_mirror_share) {
      if (const auto image = car::mirrored_by_road(sight, range_m, p[2])) {
        const Angles of_image = seen(*image, azimuth_vehicle, std::asin(image->z()));
        const FieldOfView& f = config.field_of_view;
        if (of_image.elevation >= f.elevation_min_rad && of_image.elevation <= f.elevation_max_rad) {
          shown.elevation = of_image.elevation;
        }
      }
    }
    shown.azimuth += radar.of_car.curve.error_rad(shown.azimuth);
    rate *= radar.of_car.range_rate_scale;

    const double azimuth_std = config.noise.azimuth_std_rad / std::max(std::cos(seen_azimuth), spec.azimuth_std_edge);
    const double elevation_std = config.noise.elevation_std_rad;
    rate += config.noise.range_rate_std_mps * rate_noise.gaussian();
    if (r.ambiguity_mps > 0.0) rate -= r.ambiguity_mps * std::floor(rate / r.ambiguity_mps + 0.5);
    const double measured_elevation = shown.elevation + r.noise_scale * elevation_std * elevation_noise.gaussian();
    out.azimuth_rad[i] = static_cast<float>(shown.azimuth + r.noise_scale * azimuth_std * azimuth_noise.gaussian());
    out.elevation_rad[i] = r.measures_elevation ? static_cast<float>(measured_elevation) : 0.0F;
    out.range_rate_mps[i] = static_cast<float>(rate);
    out.range_m[i] = static_cast<float>(std::max(0.1, range_m + config.noise.range_std_m * range_noise.gaussian()));
    out.rcs_dbsm[i] = static_cast<float>(strength.uniform(-10.0, 15.0));
    out.snr_db[i] = 0.0F;
    out.range_std_m[i] = r.states_stds ? static_cast<float>(config.noise.range_std_m) : 0.0F;
    out.azimuth_std_rad[i] = r.states_stds ? static_cast<float>(azimuth_std) : 0.0F;
    out.elevation_std_rad[i] = r.states_stds && r.measures_elevation ? static_cast<float>(elevation_std) : 0.0F;
    out.range_rate_std_mps[i] = r.states_stds ? static_cast<float>(config.noise.range_rate_std_mps) : 0.0F;
    out.existence_probability[i] = 0.99F;
    out.detection_flags[i] = 0;
  }
  ++radar.cycle;
}

AlignmentDrive::AlignmentDrive(const AlignmentSpec& spec) : state_(std::make_unique<State>(spec)) {}
AlignmentDrive::~AlignmentDrive() = default;

bool AlignmentDrive::next(AlignmentEvent& event) {
  State& s = *state_;
  std::int64_t time_ns = stamp_ns(static_cast<double>(s.ego_count) / s.spec.ego_rate_hz);
  std::optional<std::size_t> radar;
  for (std::size_t i = 0; i < s.radars.size(); ++i) {
    if (s.radars[i].next_ns() < time_ns) {
      time_ns = s.radars[i].next_ns();
      radar = i;
    }
  }
  if (time_ns >= s.end_ns) return false;
  event = AlignmentEvent{};
  event.time_s = static_cast<double>(time_ns) * 1e-9;
  const AlignmentMotion motion = s.road.at(static_cast<double>(time_ns - kStart_ns) * 1e-9);
  event.speed_mps = motion.speed_mps;
  event.yaw_rate_radps = motion.yaw_rate_radps;
  event.lateral_speed_mps = motion.lateral_speed_mps;
  event.vertical_speed_mps = motion.vertical_speed_mps;
  if (radar) {
    s.make_scan(*radar, event.time_s, motion);
    event.scan = s.scan.get();
    event.radar = *radar;
    event.truth = &s.truth;
  } else {
    s.make_ego(motion);
    event.ego = &s.ego;
  }
  return true;
}

VehicleConfig AlignmentDrive::vehicle() const {
  VehicleConfig vehicle;
  vehicle.name = "alignment_drive";
  vehicle.ego.source.interface = "can0";
  vehicle.ego.speed_std_mps = stated_speed_std_mps(state_->spec);
  vehicle.ego.yaw_rate_std_radps = stated_yaw_rate_std_radps(state_->spec);
  for (const AlignmentRadar& radar : state_->spec.radars) vehicle.radars.push_back(radar.config);
  return vehicle;
}

Eigen::Matrix3d AlignmentDrive::sensor_to_vehicle(std::size_t radar, double time_s) const {
  return state_->mounting(radar, time_s).rotation;
}

}  // namespace boresight::simulator
