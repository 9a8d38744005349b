#include "services/boresight/diagnostics/diagnostics_text.hpp"

#include <cmath>
#include <ctime>
#include <string_view>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "interfaces/messages/names.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/measured.hpp"

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

std::string clock_time(std::int64_t seconds, std::int64_t nanoseconds) {
  return fmt::format("{:%H:%M:%S}.{}", fmt::localtime(static_cast<std::time_t>(seconds)), nanoseconds / 100'000'000);
}

std::string_view level_word(std::uint8_t level) {
  constexpr std::array<std::string_view, 4> kWords = {"OK", "WARN", "ERROR", "STALE"};
  return level < kWords.size() ? kWords[level] : "?";
}

std::string axis_text(std::string_view name, const diagnostics::AxisHealth& axis) {
  if (!axis.observable()) return {};
  return fmt::format("  {} {} ({} tolerance {:.2f}°)", name,
                     text::with_std(axis.error_rad() * kDegreesPerRadian, axis.std_rad() * kDegreesPerRadian, "°",
                                    text::Sign::kAlways),
                     axis.beyond_tolerance() ? "beyond" : "within", axis.tolerance_rad() * kDegreesPerRadian);
}

/// JSON knows no NaN.
std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null";
}

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string axis_json(std::string_view name, const diagnostics::AxisHealth& axis) {
  return fmt::format(R"("{}":{{"error_deg":{},"std_deg":{},"tolerance_deg":{},"observable":{},"beyond_tolerance":{}}})",
                     name, number(axis.error_rad() * kDegreesPerRadian), number(axis.std_rad() * kDegreesPerRadian),
                     number(axis.tolerance_rad() * kDegreesPerRadian), axis.observable(), axis.beyond_tolerance());
}

}  // namespace

std::string to_line(const diagnostics::SensorHealth& s) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  std::string line =
      fmt::format("{} {:<12} {} {}  {:.1f} Hz", clock_time(s.time_ns() / kSecond_ns, s.time_ns() % kSecond_ns),
                  s.radar_name(), word(s.data_qualifier()), word(s.extended_qualifier()), s.rate_hz());
  line += axis_text("yaw", s.yaw()) + axis_text("pitch", s.pitch()) + axis_text("roll", s.roll());
  if (s.yaw().observable()) {
    line += fmt::format("  lateral displacement {} at {:.0f} m",
                        text::fixed(s.lateral_displacement_m(), 2, " m", text::Sign::kAlways), s.reference_range_m());
  }
  if (s.conditions() != 0) line += "  reported by the sensor: " + words_of_conditions(s.conditions());
  return line;
}

std::string to_json(const diagnostics::SensorHealth& s) {
  return fmt::format(
      R"({{"radar_id":{},"radar":{},"vehicle":{},"time_ns":{},"data_qualifier":"{}","extended_qualifier":"{}",)"
      R"("rate_hz":{},"expected_rate_hz":{},"last_seen_s":{},{},{},{},"speed_scale":{},"speed_scale_std":{},)"
      R"("lateral_displacement_m":{},"reference_range_m":{},"scans":{},"lost_scans":{},"missed_scans":{},)"
      R"("suspect_scans":{},"e2e_lost":{},"e2e_repeated":{},"e2e_wrong":{},"conditions":"{}"}})",
      s.radar_id(), quoted(s.radar_name()), quoted(s.vehicle_name()), s.time_ns(), word(s.data_qualifier()),
      word(s.extended_qualifier()), number(s.rate_hz()), number(s.expected_rate_hz()), number(s.last_seen_s()),
      axis_json("yaw", s.yaw()), axis_json("pitch", s.pitch()), axis_json("roll", s.roll()), number(s.speed_scale()),
      number(s.speed_scale_std()), number(s.lateral_displacement_m()), number(s.reference_range_m()), s.scans(),
      s.lost_scans(), s.missed_scans(), s.suspect_scans(), s.e2e_lost(), s.e2e_repeated(), s.e2e_wrong(),
      words_of_conditions(s.conditions()));
}

std::string to_lines(const DiagnosticArray_& array) {
  const std::string time = clock_time(array.header_().stamp_().sec_(), array.header_().stamp_().nanosec_());
  std::string text;
  for (const auto& status : array.status_()) {
    if (status.level_() == 0) continue;
    if (!text.empty()) text += '\n';
    text += fmt::format("{} {:<5} {}: {}", time, level_word(status.level_()), status.name_(), status.message_());
  }
  return text.empty() ? fmt::format("{} OK    all {} statuses", time, array.status_().size()) : text;
}

std::string to_json(const DiagnosticArray_& array) {
  std::string text = fmt::format(R"({{"sec":{},"nanosec":{},"frame_id":{},"status":[)", array.header_().stamp_().sec_(),
                                 array.header_().stamp_().nanosec_(), quoted(array.header_().frame_id_()));
  std::string_view comma;
  for (const auto& status : array.status_()) {
    text += fmt::format(R"({}{{"level":{},"name":{},"message":{},"hardware_id":{},"values":{{)", comma, status.level_(),
                        quoted(status.name_()), quoted(status.message_()), quoted(status.hardware_id_()));
    comma = ",";
    std::string_view value_comma;
    for (const auto& value : status.values_()) {
      text += fmt::format("{}{}:{}", value_comma, quoted(value.key_()), quoted(value.value_()));
      value_comma = ",";
    }
    text += "}}";
  }
  return text + "]}";
}

}  // namespace boresight::diagnostics_text
