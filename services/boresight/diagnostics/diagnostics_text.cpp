#include "services/boresight/diagnostics/diagnostics_text.hpp"

#include <algorithm>
#include <ctime>
#include <string_view>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "interfaces/messages/names.hpp"
#include "services/boresight/json/text.hpp"
#include "services/common/alignment_words/alignment_words.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/columns.hpp"
#include "services/common/text/measured.hpp"
#include "services/common/text/printable.hpp"

namespace boresight::diagnostics_text {

namespace {

using diagnostic_msgs::msg::dds_::DiagnosticArray_;

/// The names of the message's enumerations; those of the IDL have the same order.
std::string_view word(diagnostics::DataQualifier qualifier) {
  return name_of(static_cast<DataQualifier>(qualifier));
}
std::string_view word(diagnostics::ExtendedQualifier qualifier) {
  return name_of(static_cast<ExtendedQualifier>(qualifier));
}
std::string_view word(diagnostics::AxisEffect effect) {
  return name_of(static_cast<AxisEffect>(effect));
}

/// Key of JSON, and the sentence.
struct AbsenceWords {
  std::string_view key;
  std::string_view sentence;
};
AbsenceWords words_of(dds::Absence absence) {
  switch (absence) {
    case dds::Absence::kNone:
      return {"none", ""};
    case dds::Absence::kDeadline:
      return {"deadline", "no sample within the deadline, the health service is silent"};
    case dds::Absence::kLiveliness:
      return {"liveliness", "no sign of life, the health service is dead or not reachable"};
    case dds::Absence::kEnded:
      return {"ended", "the health service ended in order"};
    case dds::Absence::kNoWriter:
      return {"no_writer", "the health service left the domain"};
    case dds::Absence::kRefused:
      return {"refused",
              "a writer offers a longer deadline or lease than requested; compare dds.period_s of health.toml"};
  }
  return {"?", "?"};
}

double seconds_of(std::int64_t time_ns) {
  return static_cast<double>(time_ns) * 1e-9;
}

std::string clock_time(std::int64_t seconds, std::int64_t nanoseconds) {
  return fmt::format("{:%H:%M:%S}.{}", fmt::localtime(static_cast<std::time_t>(seconds)), nanoseconds / 100'000'000);
}

constexpr std::size_t kNameColumns = 13;

std::string clock_time_of(std::int64_t time_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  return clock_time(time_ns / kSecond_ns, time_ns % kSecond_ns);
}

std::string_view level_word(std::uint8_t level) {
  constexpr std::array<std::string_view, 4> kWords = {"OK", "WARN", "ERROR", "STALE"};
  return level < kWords.size() ? kWords[level] : "?";
}

std::string axis_text(std::string_view name, const diagnostics::AxisHealth& axis) {
  if (!axis.observable()) return {};
  const bool is_beyond_limit = axis.effect() == diagnostics::EFFECT_NOT_AVAILABLE;
  return fmt::format("  {} {} ({}, {} {:.2f}°)", name, alignment_words::angle_text(axis.error_rad(), axis.std_rad()),
                     word(axis.effect()), is_beyond_limit || axis.beyond_tolerance() ? "beyond" : "within",
                     (is_beyond_limit ? axis.limit_rad() : axis.tolerance_rad()) * kDegreesPerRadian);
}

AlignmentVehicleChange change_of(const diagnostics::VehicleChange& change) {
  return {change.time_ns(), change.size(), change.count()};
}

double degrees(float angle_rad) {
  return json::shortest(static_cast<float>(angle_rad * kDegreesPerRadian));
}

json::Value object_of(const diagnostics::AxisHealth& axis) {
  json::Value object;
  object["error_deg"] = degrees(axis.error_rad());
  object["std_deg"] = degrees(axis.std_rad());
  object["tolerance_deg"] = degrees(axis.tolerance_rad());
  object["limit_deg"] = degrees(axis.limit_rad());
  object["beyond_tolerance_probability"] = json::shortest(axis.beyond_tolerance_probability());
  object["beyond_limit_probability"] = json::shortest(axis.beyond_limit_probability());
  object["observable"] = axis.observable();
  object["beyond_tolerance"] = axis.beyond_tolerance();
  object["about_vehicle_axis"] = axis.about_vehicle_axis();
  object["effect"] = word(axis.effect());
  return object;
}

json::Value object_of(const diagnostics::MountingDrift& drift) {
  constexpr float kSecondsPerMinute = 60.0F;
  json::Value object;
  object["since_ns"] = drift.since_ns();
  object["yaw_degpmin"] = degrees(kSecondsPerMinute * drift.yaw_radps());
  object["yaw_std_degpmin"] = degrees(kSecondsPerMinute * drift.yaw_std_radps());
  object["pitch_degpmin"] = degrees(kSecondsPerMinute * drift.pitch_radps());
  object["pitch_std_degpmin"] = degrees(kSecondsPerMinute * drift.pitch_std_radps());
  return object;
}

json::Value object_of(const diagnostic_msgs::msg::dds_::DiagnosticStatus_& status) {
  json::Value object;
  object["level"] = status.level_();
  object["name"] = status.name_();
  object["message"] = status.message_();
  object["hardware_id"] = status.hardware_id_();
  json::Value& values = object["values"] = json::Value::object();
  for (const auto& value : status.values_()) values[value.key_()] = value.value_();
  return object;
}

}  // namespace

std::string to_line(const diagnostics::SensorHealth& s) {
  std::string line = fmt::format("{} {}{} {}  {:.1f} Hz", clock_time_of(s.time_ns()),
                                 text::padded(text::printable(s.radar_name()), kNameColumns), word(s.data_qualifier()),
                                 word(s.extended_qualifier()), s.rate_hz());
  line += axis_text("yaw", s.yaw()) + axis_text("pitch", s.pitch()) + axis_text("roll", s.roll());
  if (s.yaw().observable()) {
    line += fmt::format("  lateral displacement {} at {:.0f} m",
                        text::fixed(s.lateral_displacement_m(), 2, " m", text::Sign::kAlways), s.reference_range_m());
  }
  const bool is_beyond = s.yaw().beyond_tolerance() || s.pitch().beyond_tolerance() || s.roll().beyond_tolerance();
  if (is_beyond) {
    line +=
        fmt::format("  lost coverage {}  loss of range {}  velocity error {}",
                    text::fixed(s.lost_coverage_ratio() * 100.0, 1, " %"),
                    text::fixed(s.range_loss_ratio() * 100.0, 1, " %"), text::fixed(s.velocity_error_mps(), 2, " m/s"));
  }
  // The line has the axes already.
  if (!is_beyond && !s.explanation().empty()) line += "  " + text::printable(s.explanation());
  for (const std::string& event : {alignment_words::load_change_sentence(change_of(s.load_change())),
                                   alignment_words::speed_change_sentence(change_of(s.speed_change()))}) {
    if (!event.empty()) line += "  " + event;
  }
  if (!s.trouble_codes().empty()) line += "  " + text::printable(s.trouble_codes());
  if (s.conditions() != 0) line += "  reported by the sensor: " + words_of_conditions(s.conditions());
  return line;
}

std::string to_json(const diagnostics::SensorHealth& s) {
  json::Value object;
  object["radar_id"] = s.radar_id();
  object["radar"] = s.radar_name();
  object["vehicle"] = s.vehicle_name();
  object["time_ns"] = s.time_ns();
  object["data_qualifier"] = word(s.data_qualifier());
  object["extended_qualifier"] = word(s.extended_qualifier());
  object["trouble_codes"] = s.trouble_codes();
  object["explanation"] = s.explanation();
  object["reason"] = s.alignment_reason();
  object["finding"] = s.finding();
  object["finding_value"] = json::shortest(s.finding_value());
  object["finding_radar"] = s.finding_radar();
  object["rate_hz"] = json::shortest(s.rate_hz());
  object["expected_rate_hz"] = json::shortest(s.expected_rate_hz());
  object["last_seen_s"] = json::shortest(s.last_seen_s());
  object["yaw"] = object_of(s.yaw());
  object["pitch"] = object_of(s.pitch());
  object["roll"] = object_of(s.roll());
  object["speed_scale"] = json::shortest(s.speed_scale());
  object["speed_scale_std"] = json::shortest(s.speed_scale_std());
  object["range_rate_scale"] = json::shortest(s.range_rate_scale());
  object["range_rate_scale_std"] = json::shortest(s.range_rate_scale_std());
  object["step_changes"] = s.step_changes();
  object["drift"] = object_of(s.drift());
  object["load_change"]["time_ns"] = s.load_change().time_ns();
  object["load_change"]["pitch_deg"] = degrees(s.load_change().size());
  object["load_change"]["count"] = s.load_change().count();
  object["speed_change"]["time_ns"] = s.speed_change().time_ns();
  object["speed_change"]["scale"] = json::shortest(s.speed_change().size());
  object["speed_change"]["count"] = s.speed_change().count();
  object["lateral_displacement_m"] = json::shortest(s.lateral_displacement_m());
  object["reference_range_m"] = json::shortest(s.reference_range_m());
  object["lost_coverage_ratio"] = json::shortest(s.lost_coverage_ratio());
  object["range_loss_ratio"] = json::shortest(s.range_loss_ratio());
  object["velocity_error_mps"] = json::shortest(s.velocity_error_mps());
  object["scans"] = s.scans();
  object["lost_scans"] = s.lost_scans();
  object["missed_scans"] = s.missed_scans();
  object["suspect_scans"] = s.suspect_scans();
  object["e2e_lost"] = s.e2e_lost();
  object["e2e_repeated"] = s.e2e_repeated();
  object["e2e_wrong"] = s.e2e_wrong();
  object["conditions"] = words_of_conditions(s.conditions());
  return json::line(object);
}

std::string to_line(const diagnostics::SystemHealth& s) {
  const diagnostics::PipelineHealth& pipeline = s.pipeline();
  std::string line =
      fmt::format("{} {}{}  pipeline {}", clock_time_of(s.time_ns()), text::padded("system", kNameColumns),
                  word(s.overall()), word(pipeline.data_qualifier()));
  if (pipeline.lost_scans() != 0) line += fmt::format("  {} scans lost", pipeline.lost_scans());
  if (pipeline.budget_hits() != 0) line += fmt::format("  {} scans at a work budget", pipeline.budget_hits());
  line += fmt::format("  queueing {}  latency p99 {}", text::fixed(pipeline.queueing_max_ms(), 1, " ms"),
                      text::fixed(pipeline.latency_p99_ms(), 1, " ms"));
  const std::string services = text::printable(s.services());
  for (std::size_t begin = 0; begin < services.size();) {
    const std::size_t end = std::min(services.find(' ', begin), services.size());
    const std::string service = services.substr(begin, end - begin);
    if (!service.ends_with(":alive")) line += "  " + service;
    begin = end + 1;
  }
  if (!pipeline.trouble_codes().empty()) line += "  " + text::printable(pipeline.trouble_codes());
  return line;
}

std::string to_json(const diagnostics::SystemHealth& s) {
  json::Value object;
  object["vehicle"] = s.vehicle_name();
  object["time_ns"] = s.time_ns();
  object["overall"] = word(s.overall());
  json::Value& pipeline = object["pipeline"];
  pipeline["data_qualifier"] = word(s.pipeline().data_qualifier());
  pipeline["trouble_codes"] = s.pipeline().trouble_codes();
  pipeline["lost_scans"] = s.pipeline().lost_scans();
  pipeline["budget_hits"] = s.pipeline().budget_hits();
  pipeline["queueing_max_ms"] = json::shortest(s.pipeline().queueing_max_ms());
  pipeline["latency_p99_ms"] = json::shortest(s.pipeline().latency_p99_ms());
  object["services"] = s.services();
  object["latency_p50_ms"] = json::shortest(s.latency_p50_ms());
  object["latency_max_ms"] = json::shortest(s.latency_max_ms());
  object["stored_trouble_codes"] = s.stored_trouble_codes();
  return json::line(object);
}

std::string to_lines(const DiagnosticArray_& array) {
  const std::string time = clock_time(array.header_().stamp_().sec_(), array.header_().stamp_().nanosec_());
  std::string text;
  for (const auto& status : array.status_()) {
    if (status.level_() == 0) continue;
    if (!text.empty()) text += '\n';
    text += fmt::format("{} {:<5} {}: {}", time, level_word(status.level_()), text::printable(status.name_()),
                        text::printable(status.message_()));
  }
  return text.empty() ? fmt::format("{} OK    all {} statuses", time, array.status_().size()) : text;
}

std::string to_json(const DiagnosticArray_& array) {
  json::Value object;
  object["sec"] = array.header_().stamp_().sec_();
  object["nanosec"] = array.header_().stamp_().nanosec_();
  object["frame_id"] = array.header_().frame_id_();
  json::Value& statuses = object["status"] = json::Value::array();
  for (const auto& status : array.status_()) statuses.push_back(object_of(status));
  return json::line(object);
}

std::string to_line(const dds::Presence& presence, std::int64_t time_ns) {
  const std::string begin = clock_time_of(time_ns) + " " + text::padded(text::printable(presence.source), kNameColumns);
  const double silent_s = seconds_of(presence.silent_ns);
  const std::string_view sentence = words_of(presence.absence).sentence;
  switch (presence.absence) {
    case dds::Absence::kNone:
      return fmt::format("{}received again after {:.1f} s", begin, silent_s);
    case dds::Absence::kRefused:
      return fmt::format("{}STALE: {}", begin, sentence);
    default:
      return fmt::format("{}STALE since {:.1f} s: {}", begin, silent_s, sentence);
  }
}

std::string to_json(const dds::Presence& presence, std::int64_t time_ns) {
  json::Value object;
  object["source"] = presence.source;
  object["topic"] = presence.topic;
  object["vehicle"] = presence.vehicle;
  object["time_ns"] = time_ns;
  object["stale"] = presence.absence != dds::Absence::kNone;
  object["stale_reason"] = words_of(presence.absence).key;
  object["silent_s"] = json::significant(seconds_of(presence.silent_ns));
  return json::line(object);
}

}  // namespace boresight::diagnostics_text
