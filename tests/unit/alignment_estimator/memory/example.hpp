// A vehicle, and a memory that an estimator may have learnt on it.
#pragma once

#include "services/alignment_estimator/core/memory/memory.hpp"
#include "services/common/vehicle/identity.hpp"

namespace boresight::alignment {

inline VehicleConfig example_vehicle(std::size_t radars = 4) {
  VehicleConfig vehicle;
  vehicle.name = "example";
  for (std::size_t i = 0; i < radars; ++i) {
    RadarConfig radar;
    radar.id = static_cast<std::uint32_t>(i + 1);
    radar.mounting_pose = {{3.6, 0.1 * static_cast<double>(i), 0.5}, 0.2 * static_cast<double>(i), 0.01, 0.0};
    vehicle.radars.push_back(radar);
  }
  return vehicle;
}

/// `mark` makes the memory distinguishable. The covariances are correlated throughout: D (0.5 I + 0.5 · 1 1ᵀ) D.
inline Memory example_memory(std::size_t radars = 4, double mark = 0.0) {
  Memory m;
  const auto fill = [](std::size_t n, double first_std, auto& covariance) {
    const auto std_of = [&](std::size_t i) { return first_std * static_cast<double>(i + 1); };
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < n; ++c) covariance[r * n + c] = (r == c ? 1.0 : 0.5) * std_of(r) * std_of(c);
    }
  };
  m.number_of_radars = radars;
  m.boot = 0x123456789abcdef0;
  m.since_boot_ns = 1'234'567'890'123;
  m.speed_scale = 1.01;
  m.yaw_rate_bias_radps = mark * 1e-6;
  m.yaw_rate_gain = 0.02;
  m.slip_coefficient_radps2pm = 0.003;
  m.pitch_per_acceleration_radps2pm = 0.001;
  m.time_offset_s = 0.04;
  m.load_pitch_rad = -0.01;
  m.fluctuation_variance = {1e-6, 2e-6, 1e-7};
  m.correlation_s = {15.0, 20.0, 25.0};
  fill(Memory::kShared, 1e-4, m.covariance);
  for (std::size_t i = 0; i < radars; ++i) {
    Memory::Radar& radar = m.radars[i];
    const double number = static_cast<double>(i + 1);
    radar.id = static_cast<std::uint32_t>(i + 1);
    radar.has_elevation = i != 1;
    radar.rotation_vehicle_rad = {0.01, -0.02, 0.001 * number};
    radar.range_rate_scale = 1e-4 * number;
    radar.time_offset_s = -0.01;
    radar.position_error_m = {0.01 * number, -0.02};
    for (std::size_t k = 0; k < radar.azimuth_curve_rad.size(); ++k) {
      radar.azimuth_curve_rad[k] = 1e-4 * static_cast<double>(k) * number;
    }
    radar.height_excess = 0.1;
    radar.mirror_share = 0.3;
    radar.angle_noise_scale = 1.1;
    radar.range_rate_noise_scale = 0.4;
    radar.seconds_of_drive = 1000.0;
    radar.fluctuation_variance = {1e-7 * number, 2e-7, 3e-7};
    fill(Memory::kOwn, 1e-4 * number, radar.covariance);
  }
  return m;
}

}  // namespace boresight::alignment
