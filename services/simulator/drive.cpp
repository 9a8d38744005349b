#include "services/simulator/drive.hpp"

#include <algorithm>
#include <cmath>

#include "services/simulator/car/signals.hpp"
#include "services/simulator/random.hpp"

namespace boresight::simulator {

namespace {

constexpr double kWheelbase_m = 2.8;
constexpr double kSteeringRatio = 15.0;
constexpr double kReserve_m = 10.0;  // from the rear axle to a radar, and a vehicle's length

}  // namespace

radar::EgoBody ego_body(const EgoSpec& ego) {
  radar::EgoBody body;
  body.rear_m = -ego.rear_overhang_m;
  body.front_m = ego.length_m - ego.rear_overhang_m;
  body.half_width_m = 0.5 * ego.width_m;
  body.height_m = ego.height_m;
  return body;
}

Drive::Drive(const Scenario& scenario, const VehicleConfig& vehicle, std::uint64_t seed, double duration_s)
    : scenario_(scenario),
      seed_(seed),
      duration_s_(duration_s),
      world_(scenario, seed, duration_s),
      side_slip_(scenario.effects.real_car, seed, duration_s),
      scan_(std::make_unique<RadarScan>()) {
  for (std::size_t i = 0; i < vehicle.radars.size(); ++i) {
    const RadarConfig& radar = vehicle.radars[i];
    // Radars are not synchronised: each starts its cycle at another phase.
    const double phase = radar.cycle_time_s * static_cast<double>(i) / static_cast<double>(vehicle.radars.size());
    const car::RadarOfCar of_car = car::radar_of_car(scenario.effects.real_car, seed, radar.id, radar.field_of_view);
    radars_.push_back({radar, RadarSensor(radar, scenario.effects, ego_body(scenario.ego), seed),
                       of_car.stamp_offset_ns(), 0.02 + phase, 0});
  }
}

double Drive::time_of(const Radar& radar) const {
  return radar.phase_s + static_cast<double>(radar.cycle) * radar.config.cycle_time_s;
}

double Drive::slip_rad(double t_s) const {
  const EgoState on_path = world_.ego(t_s);
  return car::side_slip_share(on_path.speed_mps) * side_slip_.at(t_s) +
         car::bend_slip_rad(scenario_.effects.real_car.slip_coefficient_radps2pm, on_path.speed_mps,
                            on_path.yaw_rate_radps);
}

EgoState Drive::ego(double t_s) const {
  EgoState ego = world_.ego(t_s);
  const car::RealCar& real = scenario_.effects.real_car;
  ego.body_pitch_rad = car::load_pitch_rad(real, t_s);
  if (real.side_slip_std_rad == 0.0 && real.slip_coefficient_radps2pm == 0.0) return ego;
  constexpr double kStep_s = 1e-3;
  const double slip = slip_rad(t_s);
  ego.heading_rad -= slip;
  ego.yaw_rate_radps -= (slip_rad(t_s + kStep_s) - slip_rad(t_s - kStep_s)) / (2.0 * kStep_s);
  ego.lateral_speed_mps = ego.speed_mps * std::sin(slip);
  ego.speed_mps *= std::cos(slip);
  return ego;
}

const Event* Drive::next() {
  const double ego_t = static_cast<double>(ego_index_) * kEgoPeriod_s;
  Radar* due = nullptr;
  for (Radar& radar : radars_) {
    if (time_of(radar) < ego_t && (due == nullptr || time_of(radar) < time_of(*due))) due = &radar;
  }
  event_ = Event{};
  event_.t_s = due != nullptr ? time_of(*due) : ego_t;
  if (event_.t_s > duration_s_) return nullptr;
  event_.time_ns = event_.stamp_ns = kStart_ns + std::llround(event_.t_s * 1e9);
  if (due == nullptr) {
    const EgoState state = ego(ego_t);
    Stream noise(seed_, "ego", ego_index_++);
    const double on = scenario_.effects.noise ? 1.0 : 0.0;
    const car::RealCar& real = scenario_.effects.real_car;
    event_.ego.speed_mps =
        car::quantised_speed(real, state.speed_mps / scenario_.effects.speed_scale + on * 0.02 * noise.gaussian());
    event_.ego.yaw_rate_radps = car::signalled_yaw_rate(real, state.yaw_rate_radps) + on * 0.001 * noise.gaussian();
    event_.ego.steering_angle_rad =
        kSteeringRatio * std::atan(kWheelbase_m * state.yaw_rate_radps / std::max(1.0, std::abs(state.speed_mps)));
    return &event_;
  }
  world_.at(event_.t_s, std::min(World::kReach_m, due->config.field_of_view.range_max_m + kReserve_m), scene_);
  scene_.ego = ego(event_.t_s);
  due->sensor.measure(scene_, due->cycle, *scan_, truth_);
  scan_->header = {};
  scan_->header.version = RadarScan::kVersion;
  scan_->header.source_id = due->config.id;
  scan_->header.sequence = ++sequence_;
  scan_->header.source_sequence = ++due->cycle;
  event_.stamp_ns += due->stamp_offset_ns;
  scan_->header.measurement_time_ns = event_.stamp_ns;
  scan_->header.time_source = TimeSource::kSensorSynchronised;
  event_.scan = scan_.get();
  event_.truth = &truth_;
  event_.condition = due->sensor.condition(event_.t_s);
  return &event_;
}

EgoMotion to_message(const Event& event, const EgoConfig& config) {
  EgoMotion m{};
  m.header.version = EgoMotion::kVersion;
  m.header.measurement_time_ns = event.time_ns;
  m.fields = ego_field::kSpeed | ego_field::kYawRate | ego_field::kSteeringAngle;
  m.speed_mps = static_cast<float>(event.ego.speed_mps);
  m.speed_std_mps = static_cast<float>(config.speed_std_mps);
  m.yaw_rate_radps = static_cast<float>(event.ego.yaw_rate_radps);
  m.yaw_rate_std_radps = static_cast<float>(config.yaw_rate_std_radps);
  m.steering_angle_rad = static_cast<float>(event.ego.steering_angle_rad);
  m.steering_angle_std_rad = static_cast<float>(config.steering_angle_std_rad);
  return m;
}

}  // namespace boresight::simulator
