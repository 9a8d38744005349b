#include "services/health/dds/to_dds.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "interfaces/catalogue/catalogue.hpp"
#include "interfaces/messages/names.hpp"
#include "services/common/alignment_words/alignment_words.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/measured.hpp"
#include "services/health/core/faults/event.hpp"
#include "services/health/dds/alignment.hpp"
#include "services/health/dds/system_health.hpp"

namespace boresight::dds {

namespace {

using diagnostic_msgs::msg::dds_::DiagnosticStatus_;
using diagnostic_msgs::msg::dds_::KeyValue_;
enum Level : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };

using alignment_words::radar_name;

diagnostics::AxisHealth to_axis(const AxisHealth& axis) {
  diagnostics::AxisHealth out;
  out.error_rad(axis.error_rad);
  out.std_rad(axis.std_rad);
  out.tolerance_rad(axis.tolerance_rad);
  out.limit_rad(axis.limit_rad);
  out.beyond_tolerance_probability(axis.beyond_tolerance_probability);
  out.beyond_limit_probability(axis.beyond_limit_probability);
  out.observable(axis.observable != 0);
  out.beyond_tolerance(axis.beyond_tolerance != 0);
  out.about_vehicle_axis(axis.about_vehicle_axis != 0);
  out.effect(static_cast<diagnostics::AxisEffect>(axis.effect));
  return out;
}

/// Whether a test other than that of missing data has failed and makes the radar unusable.
bool has_proven_fault(const SensorHealth& sensor) {
  for (std::size_t i = 0; i < kNumberOfRadarEvents; ++i) {
    const auto event = static_cast<RadarEvent>(i);
    if (event == RadarEvent::kNoData || (sensor.failed_events & bit_of(event)) == 0) continue;
    if (health::type_of(health::kind_of(event)).effect == DataQualifier::kNotAvailable) return true;
  }
  return false;
}

Level level_of(const SensorHealth& sensor) {
  if (sensor.data_qualifier == DataQualifier::kAvailable) return kOk;
  if (sensor.data_qualifier == DataQualifier::kAvailableReduced) return kWarn;
  const bool is_without_data = sensor.extended_qualifier == ExtendedQualifier::kNoData ||
                               sensor.extended_qualifier == ExtendedQualifier::kInitialising;
  return is_without_data && !has_proven_fault(sensor) ? kStale : kError;
}

Level level_of(ServiceCondition condition) {
  switch (condition) {
    case ServiceCondition::kAlive:
      return kOk;
    case ServiceCondition::kDegraded:
    case ServiceCondition::kRestarted:
      return kWarn;
    case ServiceCondition::kUnknown:
    case ServiceCondition::kSilent:
      return kStale;
  }
  return kError;
}

/// Level of the whole: STALE if nothing is proven to be faulty and something without data makes it unusable.
Level level_of_whole(const HealthReport& report, const std::vector<DiagnosticStatus_>& parts) {
  if (report.overall == DataQualifier::kAvailable) return kOk;
  if (report.overall == DataQualifier::kAvailableReduced) return kWarn;
  const auto has = [&parts](Level level) {
    return std::ranges::any_of(parts, [level](const DiagnosticStatus_& part) { return part.level_() == level; });
  };
  return has(kStale) && !has(kError) && report.pipeline.failed_events == 0 ? kStale : kError;
}

builtin_interfaces::msg::dds_::Time_ stamp_of(std::int64_t time_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  builtin_interfaces::msg::dds_::Time_ stamp;
  stamp.sec_(static_cast<std::int32_t>(time_ns / kSecond_ns));
  stamp.nanosec_(static_cast<std::uint32_t>(time_ns % kSecond_ns));
  return stamp;
}

void add_value(DiagnosticStatus_& status, std::string_view key, std::string value) {
  KeyValue_ pair;
  pair.key_(std::string(key));
  pair.value_(std::move(value));
  status.values_().push_back(std::move(pair));
}

/// Trouble codes of the failed tests of a radar, separated by blanks.
std::string trouble_codes(const SensorHealth& sensor) {
  std::string codes;
  for (std::size_t i = 0; i < kNumberOfRadarEvents; ++i) {
    const auto event = static_cast<RadarEvent>(i);
    if ((sensor.failed_events & bit_of(event)) == 0) continue;
    if (!codes.empty()) codes += ' ';
    codes += health::code_text(health::dtc_of({health::kind_of(event), static_cast<std::uint8_t>(sensor.radar_id)}));
  }
  return codes;
}

void add_axis(DiagnosticStatus_& status, std::string_view name, const AxisHealth& axis) {
  if (axis.observable == 0) {
    add_value(status, name, "not observable");
    return;
  }
  add_value(
      status, name,
      fmt::format("{}, {}: beyond the tolerance of {} with probability {:.4f}, beyond the limit of {} with {:.4f}{}",
                  alignment_words::angle_text(axis.error_rad, axis.std_rad), name_of(axis.effect),
                  alignment_words::tolerance_text(axis.tolerance_rad), axis.beyond_tolerance_probability,
                  alignment_words::tolerance_text(axis.limit_rad), axis.beyond_limit_probability,
                  axis.about_vehicle_axis != 0 ? ", about the vehicle's axis" : ""));
}

DiagnosticStatus_ status_of(const SensorHealth& sensor, const VehicleConfig& vehicle) {
  DiagnosticStatus_ status;
  const std::string name = radar_name(vehicle, sensor.radar_id);
  status.level_(level_of(sensor));
  status.name_("boresight/radar/" + name);
  status.hardware_id_(vehicle.name + "/" + name);
  const std::string explanation = alignment_words::explanation_of(sensor, vehicle);
  status.message_(fmt::format("{} {}{}{}", name_of(sensor.data_qualifier), name_of(sensor.extended_qualifier),
                              explanation.empty() ? "" : ": ", explanation));
  add_value(status, "data_qualifier", std::string(name_of(sensor.data_qualifier)));
  add_value(status, "extended_qualifier", std::string(name_of(sensor.extended_qualifier)));
  const std::string codes = trouble_codes(sensor);
  add_value(status, "trouble codes", codes.empty() ? "none" : codes);
  add_value(status, "rate_hz", fmt::format("{:.1f} of {:.1f}", sensor.rate_hz, sensor.expected_rate_hz));
  add_axis(status, "yaw error", sensor.yaw);
  add_axis(status, "pitch error", sensor.pitch);
  add_axis(status, "roll error", sensor.roll);
  add_value(status, "lateral displacement",
            fmt::format("{:+.2f} m at {:.0f} m", sensor.lateral_displacement_m, sensor.reference_range_m));
  add_value(status, "lost coverage", text::fixed(sensor.lost_coverage_ratio * 100.0, 1, " %"));
  add_value(status, "loss of range", text::fixed(sensor.range_loss_ratio * 100.0, 1, " %"));
  add_value(status, "velocity error", text::fixed(sensor.velocity_error_mps, 2, " m/s"));
  add_value(status, "alignment", std::string(alignment_words::key_of(sensor.reason)));
  add_value(status, "wrong input", std::string(alignment_words::key_of(sensor.finding)));
  add_value(status, "drift", sensor.drift.since_ns == 0 ? "none" : alignment_words::drift_sentence(sensor.drift));
  add_value(status, "step_changes", fmt::format("{}", sensor.step_changes));
  add_value(status, "speed scale", text::with_std(sensor.speed_scale, sensor.speed_scale_std));
  add_value(status, "range rate scale - 1", text::with_std(sensor.range_rate_scale.value, sensor.range_rate_scale.std));
  add_value(status, "scans", fmt::format("{}, {} lost", sensor.scans, sensor.lost_scans));
  add_value(status, "scans lost before the gateway", fmt::format("{}", sensor.missed_scans));
  add_value(status, "suspect scans", fmt::format("{}", sensor.suspect_scans));
  add_value(status, "end-to-end protection",
            fmt::format("{} lost, {} repeated, {} wrong", sensor.e2e_lost, sensor.e2e_repeated, sensor.e2e_wrong));
  add_value(status, "reported by the sensor",
            sensor.conditions == 0 ? "nothing" : words_of_conditions(sensor.conditions));
  return status;
}

DiagnosticStatus_ status_of(const ServiceHealth& service, const VehicleConfig& vehicle) {
  DiagnosticStatus_ status;
  const std::string_view name =
      service.service < catalogue::kNumberOfServices ? catalogue::kServiceNames[service.service] : "?";
  status.level_(level_of(service.condition));
  status.name_(fmt::format("boresight/service/{}", name));
  status.hardware_id_(vehicle.name);
  status.message_(std::string(name_of(service.condition)));
  add_value(status, "output deadline", service.deadline_missed != 0 ? "missed" : "kept");
  add_value(status, "last heartbeat", fmt::format("{:.2f} s ago", service.last_heartbeat_s));
  add_value(status, "output rate", fmt::format("{:.1f} Hz", service.output_rate_hz));
  add_value(status, "longest processing", fmt::format("{:.0f} us", service.processing_max_us));
  add_value(status, "latency from arrival",
            fmt::format("{:.3f} ms on average, {:.3f} ms at most", service.latency_mean_us * 1e-3F,
                        service.latency_max_us * 1e-3F));
  add_value(status, "restarts", fmt::format("{}", service.restarts));
  add_value(status, "lost inputs", fmt::format("{}", service.lost_inputs));
  add_value(status, "dropped inputs", fmt::format("{}", service.dropped_inputs));
  add_value(status, "rejected inputs", fmt::format("{}", service.rejected_inputs));
  add_value(status, "heap allocations", fmt::format("{}", service.heap_allocations));
  return status;
}

DiagnosticStatus_ status_of_pipeline(const HealthReport& report, const VehicleConfig& vehicle) {
  DiagnosticStatus_ status;
  status.name_("boresight");
  status.hardware_id_(vehicle.name);
  status.message_(std::string(name_of(report.overall)));
  const auto event = [](std::string words) { return words.empty() ? std::string("none") : words; };
  const PipelineHealth& pipeline = report.pipeline;
  const std::string codes = pipeline_trouble_codes(pipeline);
  add_value(status, "pipeline", std::string(name_of(pipeline.data_qualifier)));
  add_value(status, "pipeline trouble codes", codes.empty() ? "none" : codes);
  add_value(status, "lost scans", fmt::format("{}", pipeline.lost_scans));
  add_value(status, "scans at a work budget", fmt::format("{}", pipeline.budget_hits));
  add_value(status, "longest queueing", fmt::format("{:.3f} ms", pipeline.queueing_max_ms));
  add_value(status, "latency p99", fmt::format("{:.3f} ms", pipeline.latency_p99_ms));
  add_value(status, "load change", event(alignment_words::load_change_sentence(report.load_change)));
  add_value(status, "speed signal", event(alignment_words::speed_change_sentence(report.speed_change)));
  add_value(status, "stored trouble codes", fmt::format("{}", report.stored_events));
  add_value(status, "latency p50", fmt::format("{:.3f} ms", report.latency_p50_ms));
  add_value(status, "latency max", fmt::format("{:.3f} ms", report.latency_max_ms));
  return status;
}

}  // namespace

diagnostics::SensorHealth to_sensor_health(const HealthReport& report, std::size_t index, const VehicleConfig& vehicle,
                                           std::int64_t time_ns) {
  // The enumerations have the same order in the message and in the IDL; a value beyond them is sent as the last one.
  static_assert(static_cast<int>(DataQualifier::kNotAvailable) == diagnostics::NOT_AVAILABLE);
  static_assert(static_cast<int>(ExtendedQualifier::kDelayed) == diagnostics::DELAYED);
  static_assert(static_cast<int>(AxisEffect::kNotAvailable) == diagnostics::EFFECT_NOT_AVAILABLE);
  const SensorHealth& sensor = report.sensors.at(index);
  diagnostics::SensorHealth out;
  out.radar_id(sensor.radar_id);
  out.radar_name(radar_name(vehicle, sensor.radar_id));
  out.vehicle_name(vehicle.name);
  out.time_ns(time_ns);
  out.data_qualifier(static_cast<diagnostics::DataQualifier>(sensor.data_qualifier));
  out.extended_qualifier(static_cast<diagnostics::ExtendedQualifier>(sensor.extended_qualifier));
  out.trouble_codes(trouble_codes(sensor));
  out.explanation(alignment_words::explanation_of(sensor, vehicle));
  out.alignment_reason(std::string(alignment_words::key_of(sensor.reason)));
  out.finding(std::string(alignment_words::key_of(sensor.finding)));
  out.finding_value(sensor.finding_value);
  out.finding_radar(sensor.finding_radar);
  out.rate_hz(sensor.rate_hz);
  out.expected_rate_hz(sensor.expected_rate_hz);
  out.last_seen_s(sensor.last_seen_s);
  out.yaw(to_axis(sensor.yaw));
  out.pitch(to_axis(sensor.pitch));
  out.roll(to_axis(sensor.roll));
  out.speed_scale(sensor.speed_scale);
  out.speed_scale_std(sensor.speed_scale_std);
  out.range_rate_scale(sensor.range_rate_scale.value);
  out.range_rate_scale_std(sensor.range_rate_scale.std);
  out.step_changes(sensor.step_changes);
  out.drift(to_drift(sensor.drift));
  out.load_change(to_change(report.load_change));
  out.speed_change(to_change(report.speed_change));
  out.lateral_displacement_m(sensor.lateral_displacement_m);
  out.reference_range_m(sensor.reference_range_m);
  out.lost_coverage_ratio(sensor.lost_coverage_ratio);
  out.range_loss_ratio(sensor.range_loss_ratio);
  out.velocity_error_mps(sensor.velocity_error_mps);
  out.scans(sensor.scans);
  out.lost_scans(sensor.lost_scans);
  out.missed_scans(sensor.missed_scans);
  out.suspect_scans(sensor.suspect_scans);
  out.e2e_lost(sensor.e2e_lost);
  out.e2e_repeated(sensor.e2e_repeated);
  out.e2e_wrong(sensor.e2e_wrong);
  out.conditions(sensor.conditions);
  return out;
}

diagnostic_msgs::msg::dds_::DiagnosticArray_ to_diagnostic_array(const HealthReport& report,
                                                                 const VehicleConfig& vehicle, std::int64_t time_ns) {
  diagnostic_msgs::msg::dds_::DiagnosticArray_ array;
  array.header_().stamp_() = stamp_of(time_ns);
  array.header_().frame_id_(vehicle.name);
  auto& statuses = array.status_();
  statuses.push_back(status_of_pipeline(report, vehicle));
  const std::size_t sensors = std::min<std::size_t>(report.number_of_sensors, kMaxRadars);
  for (std::size_t i = 0; i < sensors; ++i) statuses.push_back(status_of(report.sensors[i], vehicle));
  const std::size_t services = std::min<std::size_t>(report.number_of_services, kMaxServices);
  for (std::size_t i = 0; i < services; ++i) statuses.push_back(status_of(report.services[i], vehicle));
  statuses.front().level_(level_of_whole(report, {statuses.begin() + 1, statuses.end()}));
  return array;
}

void to_ended(diagnostic_msgs::msg::dds_::DiagnosticArray_& array, std::int64_t time_ns) {
  array.header_().stamp_() = stamp_of(time_ns);
  for (DiagnosticStatus_& status : array.status_()) {
    status.level_(kStale);
    status.message_("the health service ended");
    status.values_().clear();
  }
}

}  // namespace boresight::dds
