// A vehicle, and a memory that an estimator may have learnt on it.
#pragma once

#include "services/alignment_estimator/core/memory/identity.hpp"
#include "services/alignment_estimator/core/memory/memory.hpp"

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

/// `mark` makes the memory distinguishable. The covariance is correlated throughout: D (0.5 I + 0.5 · 1 1ᵀ) D.
inline Memory example_memory(std::size_t radars = 4, double mark = 0.0) {
  Memory m;
  m.number_of_radars = radars;
  m.speed_scale = 1.01;
  m.yaw_rate_bias_radps = mark * 1e-6;
  m.slip_coefficient_radps2pm = 0.003;
  for (std::size_t i = 0; i < radars; ++i) {
    m.radars[i].id = static_cast<std::uint32_t>(i + 1);
    m.radars[i].rotation_vehicle_rad = {0.01, -0.02, 0.001 * static_cast<double>(i + 1)};
    m.radars[i].angle_noise_scale = 1.1;
    m.radars[i].seconds_of_drive = 1000.0;
  }
  const std::size_t n = m.number_of_parameters();
  const auto std_of = [](std::size_t i) { return 1e-4 * static_cast<double>(i + 1); };
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = 0; c < n; ++c) m.covariance[r * n + c] = (r == c ? 1.0 : 0.5) * std_of(r) * std_of(c);
  }
  return m;
}

}  // namespace boresight::alignment
