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

void read_sight(config::Reader& root, SightConfig& c) {
  config::Reader sight = root.table("sight");
  c.least_speed_mps = sight.number("least_speed_mps", {1.0, 30.0}, c.least_speed_mps);
  c.smoothing_s = sight.number("smoothing_s", {0.1, 10.0}, c.smoothing_s);
  c.learning_s = sight.number("learning_s", {2.0, 600.0}, c.learning_s);
  c.memory_s = sight.number("memory_s", {60.0, 36000.0}, c.memory_s);
  c.least_log_count_std = sight.number("least_log_count_std", {0.1, 2.0}, c.least_log_count_std);
  c.least_log_range_std = sight.number("least_log_range_std", {0.1, 2.0}, c.least_log_range_std);
  c.sigma = sight.number("sigma", {2.0, 6.0}, c.sigma);
  c.range_quantile = sight.number("range_quantile", {0.5, 1.0}, c.range_quantile);
  c.passing_share = sight.number("passing_share", {0.1, 1.0}, c.passing_share);
  c.blind_ratio = sight.number("blind_ratio", {0.01, 0.5}, c.blind_ratio);
  c.unusual_share = sight.number("unusual_share", {0.0, 0.5}, c.unusual_share);
  c.least_detections = sight.number("least_detections", {0.5, 20.0}, c.least_detections);
  c.least_range_m = sight.number("least_range_m", {1.0, 50.0}, c.least_range_m);
}

void read_disturbance(config::Reader& root, DisturbanceConfig& c) {
  config::Reader table = root.table("disturbance");
  ExplanationConfig& e = c.explanation;
  e.stationary_tolerance_mps = table.number("stationary_tolerance_mps", {0.2, 10.0}, e.stationary_tolerance_mps);
  e.stationary_tolerance_ratio = table.number("stationary_tolerance_ratio", {0.0, 0.3}, e.stationary_tolerance_ratio);
  e.neighbour_distance_m = table.number("neighbour_distance_m", {0.5, 20.0}, e.neighbour_distance_m);
  e.neighbour_range_rate_mps = table.number("neighbour_range_rate_mps", {0.2, 10.0}, e.neighbour_range_rate_mps);
  e.fastest_reverse_mps = table.number("fastest_reverse_mps", {0.0, 20.0}, e.fastest_reverse_mps);
  e.longest_interval_s = table.number("longest_interval_s", {0.05, 1.0}, e.longest_interval_s);
  c.least_speed_mps = table.number("least_speed_mps", {1.0, 30.0}, c.least_speed_mps);
  c.smoothing_s = table.number("smoothing_s", {0.1, 10.0}, c.smoothing_s);
  c.learning_s = table.number("learning_s", {2.0, 600.0}, c.learning_s);
  c.memory_s = table.number("memory_s", {60.0, 36000.0}, c.memory_s);
  c.least_log_std = table.number("least_log_std", {0.1, 2.0}, c.least_log_std);
  c.sigma = table.number("sigma", {1.0, 6.0}, c.sigma);
  c.least_share = table.number("least_share", {0.05, 0.9}, c.least_share);
  c.passing_share = table.number("passing_share", {0.1, 1.0}, c.passing_share);
  c.unusual_share = table.number("unusual_share", {0.0, 0.5}, c.unusual_share);
}

void read_pipeline(config::Reader& root, PipelineConfig& c) {
  config::Reader table = root.table("pipeline");
  c.window_s = table.number("window_s", {0.1, 0.35}, c.window_s);  // a longer window would delay the verdict
  c.latency_budget_s = table.number("latency_budget_s", {0.001, 1.0}, c.latency_budget_s);
  c.max_late_ratio = table.number("max_late_ratio", {0.0, 0.9}, c.max_late_ratio);
  c.queueing_budget_s = table.number("queueing_budget_s", {0.001, 1.0}, c.queueing_budget_s);
  c.max_lost_ratio = table.number("max_lost_ratio", {0.0, 0.9}, c.max_lost_ratio);
  c.max_work_budget_ratio = table.number("max_work_budget_ratio", {0.0, 0.9}, c.max_work_budget_ratio);
}

/// Whether the files can be used is checked when the domain is joined: a certificate that expired must not end the
/// supervision.
void read_security(config::Reader& dds, dds::SecurityConfig& c) {
  config::Reader table = dds.table("security");
  c.enabled = table.boolean("enabled", c.enabled);
  c.directory = table.text("directory", c.directory);
  c.identity_ca = table.text("identity_ca", c.identity_ca);
  c.certificate = table.text("certificate", c.certificate);
  c.private_key = table.text("private_key", c.private_key);
  c.permissions_ca = table.text("permissions_ca", c.permissions_ca);
  c.governance = table.text("governance", c.governance);
  c.permissions = table.text("permissions", c.permissions);
  if (!c.directory.empty() && c.directory.front() != '/') {
    table.reject("directory", "must be an absolute path: a service has no folder of its own");
  }
}

}  // namespace

FileConfig read_config(config::Reader root) {
  FileConfig c;
  Config& s = c.supervision;
  config::Reader supervision = root.table("supervision");
  s.window_s = supervision.number("window_s", {0.2, 60.0}, s.window_s);
  DeliveryConfig& d = s.delivery;
  d.min_rate_ratio = supervision.number("min_rate_ratio", {0.1, 0.95}, d.min_rate_ratio);
  d.max_rate_ratio = supervision.number("max_rate_ratio", {1.05, 3.0}, d.max_rate_ratio);
  d.pauses_window_s = supervision.number("pauses_window_s", {1.0, 30.0}, d.pauses_window_s);
  d.judged_scans = supervision.number("judged_scans", {2.0, 100.0}, d.judged_scans);
  d.most_pauses = static_cast<std::uint64_t>(
      supervision.integer("most_pauses", {1.0, 20.0}, static_cast<std::int64_t>(d.most_pauses)));
  d.silence_scans = supervision.number("silence_scans", {3.0, 20.0}, d.silence_scans);
  d.latency_budget_s = supervision.number("latency_budget_s", {0.01, 2.0}, d.latency_budget_s);
  d.max_delayed_ratio = supervision.number("max_delayed_ratio", {0.0, 0.9}, d.max_delayed_ratio);
  s.max_rejected_ratio = supervision.number("max_rejected_ratio", {0.0, 0.9}, s.max_rejected_ratio);
  s.max_suspect_ratio = supervision.number("max_suspect_ratio", {0.0, 0.9}, s.max_suspect_ratio);
  s.restart_memory_s = supervision.number("restart_memory_s", {0.0, 60.0}, s.restart_memory_s);
  s.start_grace_s = supervision.number("start_grace_s", {0.5, 60.0}, s.start_grace_s);
  read_sight(root, s.sight);
  read_disturbance(root, s.disturbance);
  config::Reader misalignment = root.table("misalignment");
  s.confidence = misalignment.number("confidence", {0.9, 0.9999}, s.confidence);
  s.set_s = misalignment.number("set_s", {0.0, 60.0}, s.set_s);
  s.clear_s = misalignment.number("clear_s", {0.0, 600.0}, s.clear_s);
  s.clear_ratio = misalignment.number("clear_ratio", {0.1, 0.99}, s.clear_ratio);
  s.reference_range_m = misalignment.number("reference_range_m", {1.0, 500.0}, s.reference_range_m);
  read_pipeline(root, s.pipeline);
  read_faults(root, s.faults, c.fault_store);
  config::Reader levels = root.table("learnt_levels");
  c.level_store.enabled = levels.boolean("enabled", c.level_store.enabled);
  c.level_store.path = levels.text("path", c.level_store.path);
  c.level_store.first_write_s = levels.number("first_write_s", {1.0, 3600.0}, c.level_store.first_write_s);
  c.level_store.write_period_s = levels.number("write_period_s", {5.0, 3600.0}, c.level_store.write_period_s);
  config::Reader dds = root.table("dds");
  c.dds.enabled = dds.boolean("enabled", c.dds.enabled);
  c.dds.domain = static_cast<std::uint32_t>(dds.integer("domain", {0.0, kHighestDomain}, c.dds.domain));
  c.dds.interfaces = dds.texts("interfaces", c.dds.interfaces);
  if (const auto problem = config::problem_of_interfaces(c.dds.interfaces)) dds.reject("interfaces", *problem);
  c.dds.period_s = dds.number("period_s", {0.1, 60.0}, c.dds.period_s);
  c.dds.tracks = dds.boolean("tracks", c.dds.tracks);
  c.dds.tracks_period_s = dds.number("tracks_period_s", {0.0, 10.0}, c.dds.tracks_period_s);
  c.dds.farewell_s = dds.number("farewell_s", {0.0, 2.0}, c.dds.farewell_s);
  c.dds.command_key_file = dds.text("command_key_file", c.dds.command_key_file);
  read_security(dds, c.dds.security);
  root.finish();
  c.dds.domain = domain_from_environment(c.dds.domain);
  return c;
}

}  // namespace boresight::health
