// Snapshots as a monitor would have recorded them on a drive with one misaligned radar.
#pragma once

#include <cmath>
#include <vector>

#include "services/boresight/monitor/snapshot.hpp"
#include "services/boresight/report/summary.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::report {
inline constexpr double kMisaligned_rad = 2.5 * kRadiansPerDegree;

inline Truth synthetic_truth() {
  return {.yaw_rad = {{1, 0.1 * kRadiansPerDegree}, {2, kMisaligned_rad}, {3, -0.3 * kRadiansPerDegree}, {4, 0.0}},
          .speed_scales = {{1, 1.03}, {2, 1.03}, {3, 1.03}, {4, 1.03}},
          .vehicle_rad = {},
          .scans = {}};
}

inline std::vector<monitor::Snapshot> synthetic_drive() {
  static constexpr std::array<const char*, 4> kNames = {"front_left", "front_right", "rear_left", "rear_right"};
  std::vector<monitor::Snapshot> snapshots;
  for (int step = 0; step < 120; ++step) {
    const double t_s = 0.5 * step;
    monitor::Snapshot s;
    s.time_ns = 1'000'000'000'000 + static_cast<std::int64_t>(t_s * 1e9);
    s.track_lists = static_cast<std::uint64_t>(80 * step);
    for (std::uint32_t id = 1; id <= 4; ++id) {
      monitor::RadarSnapshot radar;
      radar.id = id;
      radar.name = kNames[id - 1];
      radar.scans = static_cast<std::uint64_t>(10 * step + 10);
      radar.rate_hz = 20.0;
      radar.yaw_tolerance_rad = 1.5 * kRadiansPerDegree;
      const double std_rad = 0.6 * kRadiansPerDegree / std::sqrt(1.0 + t_s);
      const double wobble_rad = std_rad * std::sin(0.7 * t_s + id);
      radar.state = t_s < 8 ? AlignmentState::kConverging : AlignmentState::kConverged;
      radar.yaw = {synthetic_truth().yaw_rad.at(id) + wobble_rad, std_rad, true};
      radar.speed_scale = 1.0302;
      radar.speed_scale_std = 0.0005;
      radar.data_qualifier = DataQualifier::kAvailable;
      radar.extended_qualifier = ExtendedQualifier::kNormal;
      if (id == 2 && t_s > 12) {
        radar.data_qualifier = DataQualifier::kAvailableReduced;
        radar.extended_qualifier = ExtendedQualifier::kMisaligned;
      }
      s.radars.push_back(radar);
    }
    for (std::uint32_t id = 1; id <= 6; ++id) {
      const double way_m = (3.0 + id) * (t_s - 8.0 * id);
      if (std::abs(way_m) > 80.0) continue;
      s.tracks.push_back({.id = id,
                          .confirmed = true,
                          .movement = MovementState::kMoving,
                          .x_m = way_m,
                          .y_m = (id % 2 == 0 ? 3.5 : -7.0) + 0.3 * std::sin(0.2 * way_m),
                          .vx_mps = 12.0,
                          .vy_mps = 0.0,
                          .age_s = t_s});
    }
    for (std::size_t i = 0; i < catalogue::kNumberOfSupervisedServices; ++i) {
      monitor::ServiceSnapshot service;
      service.service = static_cast<catalogue::Service>(i);
      service.condition = ServiceCondition::kAlive;
      s.services.push_back(service);
    }
    for (std::size_t k = 0; k < monitor::kNumberOfLatencies; ++k) {
      for (int n = 0; n < 40 * (step + 1); ++n) {
        s.latencies[k].add(static_cast<std::int64_t>(1e3 * (k == 4 ? 900 : 150) * std::exp(0.3 * std::sin(17.0 * n))));
      }
    }
    snapshots.push_back(std::move(s));
  }
  return snapshots;
}

}  // namespace boresight::report
