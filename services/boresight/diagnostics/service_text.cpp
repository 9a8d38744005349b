#include "services/boresight/diagnostics/service_text.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "interfaces/messages/names.hpp"
#include "services/boresight/diagnostics/sample_time.hpp"
#include "services/boresight/json/text.hpp"
#include "services/common/text/columns.hpp"
#include "services/common/text/measured.hpp"
#include "services/common/text/printable.hpp"

namespace boresight::diagnostics_text {

namespace {

constexpr std::size_t kServiceColumns = 21;

std::string_view condition_word(const diagnostics::ServiceStatus& status) {
  return name_of(static_cast<ServiceCondition>(status.condition()));
}

std::string_view state_word(const diagnostics::ServiceStatus& status) {
  constexpr std::array<std::string_view, 4> kWords = {"starting", "running", "degraded", "stopping"};
  const auto state = static_cast<std::size_t>(status.state());
  return state < kWords.size() ? kWords[state] : "?";
}

json::Value source_object(const diagnostics::SourceStatistics& source) {
  json::Value object;
  object["radar_id"] = source.radar_id();
  object["conditions"] = source.conditions();
  object["messages"] = source.messages();
  object["rejected"] = source.rejected();
  object["lost"] = source.lost();
  object["suspect"] = source.suspect();
  object["e2e_lost"] = source.e2e_lost();
  object["e2e_repeated"] = source.e2e_repeated();
  object["e2e_wrong"] = source.e2e_wrong();
  object["last_measurement_time_ns"] = source.last_measurement_time_ns();
  return object;
}

}  // namespace

std::string to_line(const diagnostics::ServiceStatus& s) {
  std::string line = fmt::format("{} {}{}", shown_time(s.time_ns()),
                                 text::padded(text::printable(s.service_name()), kServiceColumns), condition_word(s));
  if (!s.has_heartbeat()) return line + "  no heartbeat";
  line += fmt::format("  {}  pid {}  heartbeat {} ago  {}", state_word(s), s.pid(),
                      text::fixed(s.last_heartbeat_s(), 2, " s"), text::fixed(s.output_rate_hz(), 1, " Hz"));
  if (s.latency_count() > 0) {
    line += "  latency " + text::fixed(s.window_latency_mean_us(), 0, " µs") + ", at most " +
            text::fixed(s.window_latency_max_us(), 0, " µs");
  }
  line += fmt::format("  restarts {}", s.restarts());
  if (s.deadline_missed()) line += "  output deadline missed";
  for (const diagnostics::FaultCount& fault : s.faults()) {
    if (fault.count() > 0) line += fmt::format("  {}: {}", text::printable(fault.name()), fault.count());
  }
  if (!s.last_fault().empty()) line += "  latest: " + text::printable(s.last_fault());
  return line;
}

std::string to_json(const diagnostics::ServiceStatus& s) {
  json::Value object;
  object["service"] = s.service_name();
  object["vehicle"] = s.vehicle_name();
  object["time_ns"] = s.time_ns();
  object["condition"] = condition_word(s);
  object["deadline_missed"] = s.deadline_missed();
  object["last_heartbeat_s"] = json::shortest(s.last_heartbeat_s());
  object["output_rate_hz"] = json::shortest(s.output_rate_hz());
  object["window_latency_mean_us"] = json::shortest(s.window_latency_mean_us());
  object["window_latency_max_us"] = json::shortest(s.window_latency_max_us());
  object["restarts"] = s.restarts();
  object["lost_inputs"] = s.lost_inputs();
  object["dropped_inputs"] = s.dropped_inputs();
  object["rejected_inputs"] = s.rejected_inputs();
  object["has_heartbeat"] = s.has_heartbeat();
  object["layout_version"] = s.layout_version();
  object["service_index"] = s.service_index();
  object["sequence_number"] = s.sequence_number();
  object["heartbeat_time_ns"] = s.heartbeat_time_ns();
  object["incarnation_ns"] = s.incarnation_ns();
  object["pid"] = s.pid();
  object["state"] = state_word(s);
  object["inputs"] = s.inputs();
  object["outputs"] = s.outputs();
  object["heap_allocations"] = s.heap_allocations();
  object["processing_mean_us"] = json::shortest(s.processing_mean_us());
  object["processing_max_us"] = json::shortest(s.processing_max_us());
  object["latency_mean_us"] = json::shortest(s.latency_mean_us());
  object["latency_max_us"] = json::shortest(s.latency_max_us());
  object["latency_count"] = s.latency_count();
  object["queueing_max_us"] = json::shortest(s.queueing_max_us());
  json::Value& faults = object["faults"] = json::Value::object();
  for (const diagnostics::FaultCount& fault : s.faults()) faults[fault.name()] = fault.count();
  json::Value& sources = object["sources"] = json::Value::array();
  for (const diagnostics::SourceStatistics& source : s.sources()) sources.push_back(source_object(source));
  object["last_fault"] = s.last_fault();
  return json::line(object);
}

}  // namespace boresight::diagnostics_text
