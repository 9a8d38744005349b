#include "services/health/config.hpp"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "services/common/runtime/config/network_values.hpp"

namespace boresight::health {

namespace {
constexpr std::uint32_t kHighestDomain = 232;  // the UDP ports of higher domains exceed 65535
}

std::uint32_t domain_from_environment(std::uint32_t fallback) {
  const char* const text = std::getenv("BORESIGHT_DDS_DOMAIN");
  if (text == nullptr || *text == '\0') return fallback;
  const std::string_view word(text);
  std::uint32_t domain = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), domain);
  if (error != std::errc{} || end != word.data() + word.size() || domain > kHighestDomain) {
    throw config::Error("BORESIGHT_DDS_DOMAIN: \"" + std::string(word) + "\" is not a number from 0 to 232");
  }
  return domain;
}

namespace {

void read_faults(config::Reader& root, FaultMemoryConfig& c, FaultStoreConfig& store) {
  config::Reader memory = root.table("fault_memory");
  store.enabled = memory.boolean("enabled", store.enabled);
  store.path = memory.text("path", store.path);
  store.operation_cycle = memory.choice<OperationCycle>(
      "operation_cycle", {{"boot", OperationCycle::kBoot}, {"start", OperationCycle::kStart}}, store.operation_cycle);
  const auto cycles = [&memory](std::string_view key, std::uint8_t fallback) {
    return static_cast<std::uint8_t>(memory.integer(key, {1.0, 255.0}, fallback));
  };
  c.cycles.confirmation_cycles = cycles("confirmation_cycles", c.cycles.confirmation_cycles);
  c.cycles.healing_cycles = cycles("healing_cycles", c.cycles.healing_cycles);
  c.cycles.ageing_cycles = cycles("ageing_cycles", c.cycles.ageing_cycles);
  config::Reader debounce = root.table("debounce");
  constexpr config::Range kSet_s{0.0, 10.0};  // a longer time would switch a verdict off
  constexpr config::Range kClear_s{0.0, 60.0};
  for (const EventType& type : event_types()) {
    if (!is_debounced_here(type.kind)) continue;
    DebounceTimes& times = c.debounce[static_cast<std::size_t>(type.kind)];
    config::Reader table = debounce.table(type.name);
    times.set_s = table.number("set_s", kSet_s, times.set_s);
    times.clear_s = table.number("clear_s", kClear_s, times.clear_s);
  }
}

}  // namespace

FileConfig read_config(config::Reader root) {
  FileConfig c;
  Config& s = c.supervision;
  config::Reader supervision = root.table("supervision");
  s.window_s = supervision.number("window_s", {0.2, 60.0}, s.window_s);
  s.min_rate_ratio = supervision.number("min_rate_ratio", {0.1, 0.95}, s.min_rate_ratio);
  s.max_rejected_ratio = supervision.number("max_rejected_ratio", {0.0, 0.9}, s.max_rejected_ratio);
  s.max_suspect_ratio = supervision.number("max_suspect_ratio", {0.0, 0.9}, s.max_suspect_ratio);
  s.restart_memory_s = supervision.number("restart_memory_s", {0.0, 60.0}, s.restart_memory_s);
  s.start_grace_s = supervision.number("start_grace_s", {0.5, 60.0}, s.start_grace_s);
  config::Reader misalignment = root.table("misalignment");
  s.confidence = misalignment.number("confidence", {0.9, 0.9999}, s.confidence);
  s.set_s = misalignment.number("set_s", {0.0, 60.0}, s.set_s);
  s.clear_s = misalignment.number("clear_s", {0.0, 600.0}, s.clear_s);
  s.clear_ratio = misalignment.number("clear_ratio", {0.1, 0.99}, s.clear_ratio);
  s.reference_range_m = misalignment.number("reference_range_m", {1.0, 500.0}, s.reference_range_m);
  read_faults(root, s.faults, c.fault_store);
  config::Reader dds = root.table("dds");
  c.dds.enabled = dds.boolean("enabled", c.dds.enabled);
  c.dds.domain = static_cast<std::uint32_t>(dds.integer("domain", {0.0, kHighestDomain}, c.dds.domain));
  c.dds.interfaces = dds.texts("interfaces", c.dds.interfaces);
  if (const auto problem = config::problem_of_ipv4_addresses(c.dds.interfaces)) dds.reject("interfaces", *problem);
  c.dds.period_s = dds.number("period_s", {0.1, 60.0}, c.dds.period_s);
  c.dds.command_key_file = dds.text("command_key_file", c.dds.command_key_file);
  root.finish();
  c.dds.domain = domain_from_environment(c.dds.domain);
  return c;
}

}  // namespace boresight::health
