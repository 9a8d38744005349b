// A drive through a stationary world as its messages show it, from either simulator, and least squares of its range
// rates against the motion that the ego signals state. Nothing here uses the simulators' own formulas.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "services/common/geometry/frames.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "services/simulator/drive.hpp"

namespace boresight::simulator {

inline constexpr std::uint64_t kSeed = 11;

enum class Simulator : std::uint8_t { kWorld, kStatistical };
inline constexpr std::array kSimulators = {Simulator::kWorld, Simulator::kStatistical};
[[nodiscard]] inline std::string name_of(Simulator simulator) {
  return simulator == Simulator::kWorld ? "world simulator" : "statistical simulator";
}

struct Motion2 {
  double t_s, speed_mps, yaw_rate_radps;
  double acceleration_mps2 = 0.0, yaw_acceleration_radps2 = 0.0;
};

struct Observed {
  struct Detection {
    std::uint32_t radar;
    double stamp_s;
    double azimuth_rad, elevation_rad, range_m, range_rate_mps;
    Eigen::Vector3d sight;  ///< in vehicle axes, by the nominal mounting
  };
  VehicleConfig vehicle;
  std::vector<Motion2> signals;
  std::vector<Detection> detections;

  /// The signalled motion, interpolated.
  [[nodiscard]] Motion2 motion(double t_s) const {
    const auto later = [](double t, const Motion2& m) { return t < m.t_s; };
    auto after = std::upper_bound(signals.begin(), signals.end(), t_s, later);
    after = std::clamp(after, signals.begin() + 1, signals.end() - 1);
    const Motion2 &a = *(after - 1), &b = *after;
    const double step_s = b.t_s - a.t_s, share = (t_s - a.t_s) / step_s;
    const double dv = b.speed_mps - a.speed_mps, dw = b.yaw_rate_radps - a.yaw_rate_radps;
    return {t_s, a.speed_mps + share * dv, a.yaw_rate_radps + share * dw, dv / step_s, dw / step_s};
  }
  [[nodiscard]] const std::array<double, 3>& position_m(std::uint32_t radar) const {
    return vehicle.radar(radar)->mounting_pose.position_m;
  }
};

/// Four corner radars without mounting errors and without noise.
[[nodiscard]] inline AlignmentSpec clean_spec(const car::RealCar& car, double duration_s) {
  AlignmentSpec spec = four_corner_radars();
  spec.seed = kSeed;
  spec.duration_s = duration_s;
  spec.road = RoadKind::kCity;
  spec.speed_scale = 1.0;
  spec.outlier_share = 0.0;
  spec.speed_std_mps = spec.yaw_rate_std_radps = 0.0;
  spec.real_car = car;
  for (AlignmentRadar& radar : spec.radars) {
    radar.truth = {};
    radar.noise_scale = 0.0;
    radar.config.noise.range_rate_std_mps = radar.config.noise.range_std_m = 0.0;
  }
  return spec;
}

/// A winding road between poles and bushes, driven at a speed that swings.
[[nodiscard]] inline Scenario clean_scenario(const car::RealCar& car, double duration_s) {
  Scenario s;
  s.name = "poles";
  s.duration_s = duration_s;
  s.road.waves = {{0.02, 30.0}};
  s.ego.speed_mps = {{0.0, 13.0}};
  s.ego.swing_mps = 4.0;
  s.ego.swing_period_s = 11.0;
  ScatterSpec poles;
  poles.from_m = -200.0;
  poles.to_m = 3000.0;
  poles.lateral_min_m = 5.0;
  poles.lateral_max_m = 15.0;
  poles.per_m = 0.05;
  ScatterSpec bushes = poles;
  bushes.kind = ScatterKind::kVegetation;
  bushes.top_min_m = 0.3;
  bushes.top_max_m = 2.0;
  s.scatter = {poles, bushes};
  RadarEffects& e = s.effects;
  e.noise = false;
  e.clutter_per_scan = 0.0;
  e.multipath.on = e.multipath.ground_bounce = false;
  e.resolution = {0.0, 0.0, 0.0};
  e.sensitivity.threshold_db = -160.0;
  e.sensitivity.max_probability = 1.0;
  e.real_car = car;
  return s;
}

inline void add_scan(const RadarScan& scan, double stamp_s, Observed& observed) {
  const RadarConfig& radar = *observed.vehicle.radar(scan.header.source_id);
  const Eigen::Matrix3d rotation = geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    const auto azimuth = static_cast<double>(scan.azimuth_rad[i]),
               elevation = static_cast<double>(scan.elevation_rad[i]);
    observed.detections.push_back({radar.id, stamp_s, azimuth, elevation, static_cast<double>(scan.range_m[i]),
                                   static_cast<double>(scan.range_rate_mps[i]),
                                   rotation * geometry::direction(azimuth, elevation)});
  }
}

[[nodiscard]] inline Observed observe(Simulator simulator, const car::RealCar& car, double duration_s = 40.0) {
  Observed observed;
  const AlignmentSpec spec = clean_spec(car, duration_s);
  AlignmentDrive statistical(spec);
  observed.vehicle = statistical.vehicle();
  if (simulator == Simulator::kStatistical) {
    AlignmentEvent event;
    while (statistical.next(event)) {
      if (event.ego != nullptr) {
        observed.signals.push_back({static_cast<double>(event.ego->header.measurement_time_ns) * 1e-9,
                                    static_cast<double>(event.ego->speed_mps),
                                    static_cast<double>(event.ego->yaw_rate_radps)});
      } else {
        add_scan(*event.scan, static_cast<double>(event.scan->header.measurement_time_ns) * 1e-9, observed);
      }
    }
    return observed;
  }
  const auto seconds = [](std::int64_t time_ns) { return static_cast<double>(time_ns - Drive::kStart_ns) * 1e-9; };
  Drive world(clean_scenario(car, duration_s), observed.vehicle, kSeed, duration_s);
  while (const Event* event = world.next()) {
    if (event->scan == nullptr) {
      observed.signals.push_back({seconds(event->stamp_ns), event->ego.speed_mps, event->ego.yaw_rate_radps});
    } else {
      add_scan(*event->scan, seconds(event->scan->header.measurement_time_ns), observed);
    }
  }
  return observed;
}

/// Velocity of the sensor at its nominal place, without side slip: (V − ω·y, ω·x, 0).
[[nodiscard]] inline Eigen::Vector3d nominal_velocity(const Motion2& m, const std::array<double, 3>& place_m) {
  return {m.speed_mps - m.yaw_rate_radps * place_m[1], m.yaw_rate_radps * place_m[0], 0.0};
}

/// Least squares of what is left of the range rates over their expectation, against N columns. `column(detection,
/// motion)` returns the row of a detection. `wanted(detection)` chooses the detections.
template <int N, typename Column, typename Wanted>
[[nodiscard]] Eigen::Matrix<double, N, 1> fit(const Observed& observed, const Column& column, const Wanted& wanted) {
  Eigen::Matrix<double, N, N> information = Eigen::Matrix<double, N, N>::Zero();
  Eigen::Matrix<double, N, 1> score = Eigen::Matrix<double, N, 1>::Zero();
  for (const Observed::Detection& d : observed.detections) {
    if (!wanted(d)) continue;
    const Motion2 m = observed.motion(d.stamp_s);
    const double left_mps = d.range_rate_mps + d.sight.dot(nominal_velocity(m, observed.position_m(d.radar)));
    const Eigen::Matrix<double, N, 1> row = column(d, m);
    information += row * row.transpose();
    score += row * left_mps;
  }
  return information.ldlt().solve(score);
}

}  // namespace boresight::simulator
