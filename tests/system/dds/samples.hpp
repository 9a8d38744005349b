// What the tests of DDS send: a report of two radars, one of them misaligned, and a silent tracker.
#pragma once

#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/health/dds/config.hpp"

namespace boresight::dds {

inline constexpr std::int64_t kTime_ns = 1'700'000'000'250'000'000;
inline const Config kConfig{.domain = 77, .command_key_file = {}};

inline VehicleConfig vehicle() {
  VehicleConfig v;
  v.name = "test car";
  for (const auto& [id, name] : {std::pair{1u, "front_left"}, std::pair{2u, "front_right"}}) {
    RadarConfig radar;
    radar.id = id;
    radar.name = name;
    v.radars.push_back(radar);
  }
  return v;
}

inline HealthReport report() {
  HealthReport r{};
  r.overall = DataQualifier::kAvailableReduced;
  r.number_of_sensors = 2;
  r.number_of_services = 6;
  r.latency_p50_ms = 0.5F;
  r.latency_max_ms = 7.5F;
  r.stored_events = 4;
  r.pipeline = {.data_qualifier = DataQualifier::kAvailableReduced,
                .reserved = {},
                .failed_events = 1u << static_cast<unsigned>(PipelineEvent::kLosing) |
                                 1u << static_cast<unsigned>(PipelineEvent::kLate),
                .lost_scans = 12,
                .budget_hits = 3,
                .queueing_max_ms = 31.5F,
                .latency_p99_ms = 62.5F};
  for (std::uint32_t i = 0; i < 6; ++i) {
    r.services[i].service = i;
    r.services[i].condition = ServiceCondition::kAlive;
  }
  r.services[4].condition = ServiceCondition::kSilent;
  r.sensors[0].radar_id = 1;
  SensorHealth& misaligned = r.sensors[1];
  misaligned.radar_id = 2;
  misaligned.data_qualifier = DataQualifier::kAvailableReduced;
  misaligned.extended_qualifier = ExtendedQualifier::kMisaligned;
  misaligned.rate_hz = 20.0F;
  misaligned.yaw.error_rad = 0.0436F;
  misaligned.yaw.std_rad = 0.0004F;
  misaligned.yaw.tolerance_rad = 0.0262F;
  misaligned.yaw.limit_rad = 0.0524F;
  misaligned.yaw.beyond_tolerance_probability = 1.0F;
  misaligned.yaw.beyond_limit_probability = 0.25F;
  misaligned.yaw.effect = AxisEffect::kReduced;
  misaligned.yaw.observable = misaligned.yaw.beyond_tolerance = 1;
  misaligned.speed_scale = 1.012F;
  misaligned.lateral_displacement_m = 4.36F;
  misaligned.reference_range_m = 100.0F;
  misaligned.lost_coverage_ratio = 0.031F;
  misaligned.range_loss_ratio = 0.012F;
  misaligned.velocity_error_mps = 0.61F;
  misaligned.scans = 12'345'678'901ULL;
  misaligned.missed_scans = 23'456'789'012ULL;
  misaligned.suspect_scans = 34;
  misaligned.e2e_lost = 5;
  misaligned.e2e_repeated = 6;
  misaligned.e2e_wrong = 7;
  misaligned.step_changes = 3;
  misaligned.range_rate_scale = {0.0025F, 0.0004F};
  misaligned.drift = {1'500'000'000, 1e-5F, 1e-6F, -2e-5F, 2e-6F};
  r.load_change = {2'500'000'000, 0.0136F, 1};
  r.speed_change = {3'500'000'000, -0.012F, 2};
  misaligned.conditions = source_condition::kSupply | source_condition::kWithoutEgoMotion;
  return r;
}

}  // namespace boresight::dds
