#include "services/boresight/diagnostics/fault_text.hpp"

#include <cmath>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "interfaces/messages/names.hpp"
#include "services/boresight/json/text.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/columns.hpp"
#include "services/common/text/measured.hpp"
#include "services/common/text/printable.hpp"
#include "services/health/core/faults/event.hpp"
#include "services/health/core/faults/status.hpp"

namespace boresight::diagnostics_text {

namespace {

namespace status_bit = health::dtc_status;

constexpr std::int64_t kSecondOfFrame_ns = 1'000'000'000;
constexpr std::array<std::string_view, 4> kEstimateNames = {"speed scale", "yaw", "pitch", "roll"};
constexpr std::array<std::string_view, 4> kEstimateKeys = {"speed_scale", "yaw_rad", "pitch_rad", "roll_rad"};

std::string date_time(std::int64_t time_ns) {
  if (time_ns <= 0) return std::string(text::kUnknown);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::localtime(static_cast<std::time_t>(time_ns / kSecondOfFrame_ns)));
}

/// Index of the variance of parameter `i` in the upper triangle of four.
std::size_t diagonal(std::size_t i) {
  return i * 4 - i * (i + 1) / 2 + i;
}

double std_at(const diagnostics::FreezeFrame& frame, std::size_t i) {
  return std::sqrt(static_cast<double>(frame.covariance()[diagonal(i)]));
}

std::string frame_lines(std::string_view title, const diagnostics::FreezeFrame& frame) {
  if (frame.time_ns() == 0) return {};
  std::string lines = fmt::format("{}\n", title);
  const auto add = [&lines](std::string_view name, const std::string& value) {
    lines += fmt::format("  {}{}\n", text::padded(name, 28), value);
  };
  add("time", date_time(frame.time_ns()));
  add("uptime of the ECU", text::fixed(static_cast<double>(frame.uptime_ns()) * 1e-9, 3, " s"));
  add("operation cycle", fmt::format("{}", frame.operation_cycle()));
  add("signalled speed", text::fixed(frame.speed_mps(), 2, " m/s"));
  if (std::isfinite(frame.reference_range_m())) {
    add("scans", text::fixed(frame.rate_hz(), 1, " Hz"));
    add("detections per scan", text::fixed(frame.detections_per_scan(), 0));
    for (std::size_t i = 0; i < kEstimateNames.size(); ++i) {
      const double scale = i == 0 ? 1.0 : kDegreesPerRadian;
      const double value = static_cast<double>(frame.estimate()[i]) * scale;
      add(kEstimateNames[i], text::with_std(value, std_at(frame, i) * scale, i == 0 ? "" : "°"));
    }
    add("lateral displacement",
        fmt::format("{} at {:.0f} m", text::fixed(frame.lateral_displacement_m(), 2, " m"), frame.reference_range_m()));
    add("lost coverage", text::fixed(frame.lost_coverage_ratio() * 100.0, 1, " %"));
    add("loss of range", text::fixed(frame.range_loss_ratio() * 100.0, 1, " %"));
    add("velocity error", text::fixed(frame.velocity_error_mps(), 2, " m/s"));
  }
  add("software", text::printable(frame.software()));
  add("configuration", fmt::format("{:016x}", frame.configuration()));
  return lines;
}

json::Value frame_object(const diagnostics::FreezeFrame& frame) {
  json::Value object;
  object["time_ns"] = frame.time_ns();
  object["uptime_ns"] = frame.uptime_ns();
  object["operation_cycle"] = frame.operation_cycle();
  object["speed_mps"] = json::shortest(frame.speed_mps());
  object["rate_hz"] = json::shortest(frame.rate_hz());
  object["detections_per_scan"] = json::shortest(frame.detections_per_scan());
  object["lateral_displacement_m"] = json::shortest(frame.lateral_displacement_m());
  object["reference_range_m"] = json::shortest(frame.reference_range_m());
  object["lost_coverage_ratio"] = json::shortest(frame.lost_coverage_ratio());
  object["range_loss_ratio"] = json::shortest(frame.range_loss_ratio());
  object["velocity_error_mps"] = json::shortest(frame.velocity_error_mps());
  for (std::size_t i = 0; i < kEstimateKeys.size(); ++i) {
    object["estimate"][std::string(kEstimateKeys[i])] = json::shortest(frame.estimate()[i]);
  }
  json::Value& covariance = object["covariance"] = json::Value::array();
  for (const float value : frame.covariance()) covariance.push_back(json::shortest(value));
  object["configuration"] = fmt::format("{:016x}", frame.configuration());
  object["software"] = frame.software();
  return object;
}

}  // namespace

std::string status_text(std::uint8_t status) {
  const auto has = [status](std::uint8_t bits) { return (status & bits) != 0; };
  std::string words = has(status_bit::kTestFailed)                           ? "failed"
                      : has(status_bit::kTestNotCompletedThisOperationCycle) ? "not tested in this cycle"
                                                                             : "passed";
  if (has(status_bit::kConfirmed)) words += ", confirmed";
  if (has(status_bit::kPending)) words += ", pending";
  if (has(status_bit::kWarningIndicatorRequested)) words += ", warning";
  return words;
}

std::string fault_list(const std::vector<diagnostics::FaultRecord>& records, const std::string& head) {
  std::string text = text::printable(head) + "\n";
  if (records.empty()) return text;
  constexpr std::size_t kCode = 10, kSubject = 30, kName = 24, kTimes = 6;
  text += text::padded("code", kCode) + text::padded("subject", kSubject) + text::padded("event", kName) +
          text::padded("times", kTimes) + text::padded("latest", 21) + "status\n";
  for (const diagnostics::FaultRecord& record : records) {
    text += text::padded(text::printable(record.code()), kCode) +
            text::padded(text::printable(record.subject()), kSubject) +
            text::padded(text::printable(record.name()), kName) +
            text::padded(fmt::format("{}", record.occurrences()), kTimes) +
            text::padded(date_time(record.latest().time_ns()), 21) + status_text(record.status()) + "\n";
  }
  return text;
}

std::string fault_page(const diagnostics::FaultRecord& record) {
  std::string page = fmt::format("{} {}: {}\n", text::printable(record.code()), text::printable(record.subject()),
                                 text::printable(record.meaning()));
  const auto add = [&page](std::string_view name, const std::string& value) {
    page += fmt::format("  {}{}\n", text::padded(name, 28), value);
  };
  add("event", text::printable(record.name()));
  add("remedy", text::printable(record.remedy()));
  add("status", fmt::format("0x{:02X}: {}", record.status(), status_text(record.status())));
  add("fault detection counter", fmt::format("{}", static_cast<std::int8_t>(record.fault_detection_counter())));
  add("occurrences", fmt::format("{}", record.occurrences()));
  add("failed cycles", fmt::format("{}", record.failed_cycles()));
  add("passed cycles",
      fmt::format("{} towards healing, {} towards ageing", record.healed_cycles(), record.aged_cycles()));
  return page + frame_lines("first occurrence", record.first()) + frame_lines("latest occurrence", record.latest());
}

std::string to_json(const diagnostics::FaultRecord& record) {
  json::Value object;
  object["dtc"] = record.dtc();
  object["code"] = record.code();
  object["name"] = record.name();
  object["subject"] = record.subject();
  object["meaning"] = record.meaning();
  object["remedy"] = record.remedy();
  object["status"] = record.status();
  object["status_words"] = status_text(record.status());
  object["fault_detection_counter"] = static_cast<std::int8_t>(record.fault_detection_counter());
  object["occurrences"] = record.occurrences();
  object["failed_cycles"] = record.failed_cycles();
  object["healed_cycles"] = record.healed_cycles();
  object["aged_cycles"] = record.aged_cycles();
  object["first"] = frame_object(record.first());
  object["latest"] = frame_object(record.latest());
  return json::line(object);
}

std::string dtc_table() {
  std::string table = "| code | event | meaning | effect | reason | remedy |\n|---|---|---|---|---|---|\n";
  for (const health::EventType& type : health::event_types()) {
    std::string code = health::code_text(static_cast<std::uint32_t>(type.code) << 8U | type.failure_type);
    if (type.subject != health::Subject::kVehicle) code.replace(3, 2, "nn");
    const bool has_effect = type.effect != DataQualifier::kAvailable;
    table += fmt::format("| `{}` | `{}` | {} | {} | {} | {} |\n", code, type.name, type.meaning,
                         has_effect ? name_of(type.effect) : "none",
                         type.reason != ExtendedQualifier::kNormal ? name_of(type.reason) : "", type.remedy);
  }
  return table;
}

}  // namespace boresight::diagnostics_text
