#include "services/health/config.hpp"

#include <filesystem>

#include <gmock/gmock.h>

namespace boresight::health {
namespace {

std::string problems_of(const std::string& text) {
  try {
    static_cast<void>(read_config(config::Reader::parse(text, "health.toml")));
  } catch (const config::Error& error) {
    return error.what();
  }
  return {};
}

TEST(HealthConfig, TheShippedFileHasTheDefaults) {
  const FileConfig read =
      read_config(config::Reader::open(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/services/health.toml"));
  const Config expected;
  const Config& s = read.supervision;
  EXPECT_EQ(s.window_s, expected.window_s);
  EXPECT_EQ(s.delivery.min_rate_ratio, expected.delivery.min_rate_ratio);
  EXPECT_EQ(s.delivery.max_rate_ratio, expected.delivery.max_rate_ratio);
  EXPECT_EQ(s.delivery.pauses_window_s, expected.delivery.pauses_window_s);
  EXPECT_EQ(s.delivery.judged_scans, expected.delivery.judged_scans);
  EXPECT_EQ(s.delivery.most_pauses, expected.delivery.most_pauses);
  EXPECT_EQ(s.delivery.silence_scans, expected.delivery.silence_scans);
  EXPECT_EQ(s.delivery.latency_budget_s, expected.delivery.latency_budget_s);
  EXPECT_EQ(s.delivery.max_delayed_ratio, expected.delivery.max_delayed_ratio);
  EXPECT_EQ(s.sight.least_speed_mps, expected.sight.least_speed_mps);
  EXPECT_EQ(s.sight.smoothing_s, expected.sight.smoothing_s);
  EXPECT_EQ(s.sight.learning_s, expected.sight.learning_s);
  EXPECT_EQ(s.sight.memory_s, expected.sight.memory_s);
  EXPECT_EQ(s.sight.least_log_count_std, expected.sight.least_log_count_std);
  EXPECT_EQ(s.sight.least_log_range_std, expected.sight.least_log_range_std);
  EXPECT_EQ(s.sight.sigma, expected.sight.sigma);
  EXPECT_EQ(s.sight.range_quantile, expected.sight.range_quantile);
  EXPECT_EQ(s.sight.passing_share, expected.sight.passing_share);
  EXPECT_EQ(s.sight.blind_ratio, expected.sight.blind_ratio);
  EXPECT_EQ(s.sight.unusual_share, expected.sight.unusual_share);
  EXPECT_EQ(s.sight.least_detections, expected.sight.least_detections);
  EXPECT_EQ(s.sight.least_range_m, expected.sight.least_range_m);
  const DisturbanceConfig &d = s.disturbance, &usual = expected.disturbance;
  EXPECT_EQ(d.explanation.stationary_tolerance_mps, usual.explanation.stationary_tolerance_mps);
  EXPECT_EQ(d.explanation.stationary_tolerance_ratio, usual.explanation.stationary_tolerance_ratio);
  EXPECT_EQ(d.explanation.neighbour_distance_m, usual.explanation.neighbour_distance_m);
  EXPECT_EQ(d.explanation.neighbour_range_rate_mps, usual.explanation.neighbour_range_rate_mps);
  EXPECT_EQ(d.explanation.fastest_reverse_mps, usual.explanation.fastest_reverse_mps);
  EXPECT_EQ(d.explanation.longest_interval_s, usual.explanation.longest_interval_s);
  EXPECT_EQ(d.least_speed_mps, usual.least_speed_mps);
  EXPECT_EQ(d.smoothing_s, usual.smoothing_s);
  EXPECT_EQ(d.learning_s, usual.learning_s);
  EXPECT_EQ(d.memory_s, usual.memory_s);
  EXPECT_EQ(d.least_log_std, usual.least_log_std);
  EXPECT_EQ(d.sigma, usual.sigma);
  EXPECT_EQ(d.least_share, usual.least_share);
  EXPECT_EQ(d.passing_share, usual.passing_share);
  EXPECT_EQ(d.unusual_share, usual.unusual_share);
  EXPECT_EQ(s.max_rejected_ratio, expected.max_rejected_ratio);
  EXPECT_EQ(s.max_suspect_ratio, expected.max_suspect_ratio);
  EXPECT_EQ(s.restart_memory_s, expected.restart_memory_s);
  EXPECT_EQ(s.start_grace_s, expected.start_grace_s);
  EXPECT_EQ(s.confidence, expected.confidence);
  EXPECT_EQ(s.set_s, expected.set_s);
  EXPECT_EQ(s.clear_s, expected.clear_s);
  EXPECT_EQ(s.clear_ratio, expected.clear_ratio);
  EXPECT_EQ(s.reference_range_m, expected.reference_range_m);
  EXPECT_EQ(s.pipeline.window_s, expected.pipeline.window_s);
  EXPECT_EQ(s.pipeline.latency_budget_s, expected.pipeline.latency_budget_s);
  EXPECT_EQ(s.pipeline.max_late_ratio, expected.pipeline.max_late_ratio);
  EXPECT_EQ(s.pipeline.queueing_budget_s, expected.pipeline.queueing_budget_s);
  EXPECT_EQ(s.pipeline.max_lost_ratio, expected.pipeline.max_lost_ratio);
  EXPECT_EQ(s.pipeline.max_work_budget_ratio, expected.pipeline.max_work_budget_ratio);
  EXPECT_EQ(s.faults.cycles.confirmation_cycles, expected.faults.cycles.confirmation_cycles);
  EXPECT_EQ(s.faults.cycles.healing_cycles, expected.faults.cycles.healing_cycles);
  EXPECT_EQ(s.faults.cycles.ageing_cycles, expected.faults.cycles.ageing_cycles);
  for (const EventType& type : event_types()) {
    const auto i = static_cast<std::size_t>(type.kind);
    EXPECT_EQ(s.faults.debounce[i].set_s, expected.faults.debounce[i].set_s) << type.name;
    EXPECT_EQ(s.faults.debounce[i].clear_s, expected.faults.debounce[i].clear_s) << type.name;
  }
  EXPECT_TRUE(read.fault_store.enabled);
  EXPECT_EQ(read.fault_store.path, "");
  EXPECT_EQ(read.fault_store.operation_cycle, OperationCycle::kBoot);
  const dds::Config diagnostics;
  EXPECT_EQ(read.dds.domain, diagnostics.domain);
  EXPECT_EQ(read.dds.interfaces, diagnostics.interfaces);
  EXPECT_EQ(read.dds.period_s, diagnostics.period_s);
  EXPECT_EQ(read.dds.farewell_s, diagnostics.farewell_s);
  EXPECT_EQ(read.dds.tracks, diagnostics.tracks);
  EXPECT_EQ(read.dds.tracks_period_s, diagnostics.tracks_period_s);
  EXPECT_THAT(read.dds.interfaces, testing::ElementsAre("127.0.0.1")) << "no other machine can listen";
  EXPECT_TRUE(read.level_store.enabled);
  EXPECT_EQ(read.level_store.path, "");
  EXPECT_EQ(read.level_store.first_write_s, LevelStoreConfig().first_write_s);
  EXPECT_EQ(read.level_store.write_period_s, LevelStoreConfig().write_period_s);
  EXPECT_EQ(read.dds.command_key_file, "") << "nobody may command unless the integrator wants it";
  const dds::SecurityConfig security;
  EXPECT_EQ(read.dds.security.enabled, security.enabled);
  EXPECT_EQ(read.dds.security.directory, security.directory);
  EXPECT_EQ(read.dds.security.identity_ca, security.identity_ca);
  EXPECT_EQ(read.dds.security.certificate, security.certificate);
  EXPECT_EQ(read.dds.security.private_key, security.private_key);
  EXPECT_EQ(read.dds.security.permissions_ca, security.permissions_ca);
  EXPECT_EQ(read.dds.security.governance, security.governance);
  EXPECT_EQ(read.dds.security.permissions, security.permissions);
}

TEST(HealthConfig, DebounceTimesOfEachEventAreReadIntoTheirPlace) {
  for (const EventType& type : event_types()) {
    const std::string text = "[debounce]\n" + std::string(type.name) + " = {set_s = 1.5, clear_s = 2.5}\n";
    if (!is_debounced_here(type.kind)) {
      EXPECT_THAT(problems_of(text), testing::HasSubstr("unknown key")) << type.name;
      continue;
    }
    const FileConfig read = read_config(config::Reader::parse(text, "health.toml"));
    const DebounceTimes& times = read.supervision.faults.debounce[static_cast<std::size_t>(type.kind)];
    EXPECT_EQ(times.set_s, 1.5) << type.name;
    EXPECT_EQ(times.clear_s, 2.5) << type.name;
  }
}

TEST(HealthConfig, SecurityIsReadKeyByKey) {
  const FileConfig read = read_config(config::Reader::parse(
      "[dds.security]\nenabled = true\ndirectory = \"/d\"\nidentity_ca = \"i\"\ncertificate = \"c\"\nprivate_key = "
      "\"k\"\npermissions_ca = \"p\"\ngovernance = \"g\"\npermissions = \"r\"\n",
      "health.toml"));
  const dds::SecurityConfig& security = read.dds.security;
  EXPECT_TRUE(security.enabled);
  EXPECT_EQ(security.directory, "/d");
  EXPECT_EQ(security.identity_ca + security.certificate + security.private_key, "ick");
  EXPECT_EQ(security.permissions_ca + security.governance + security.permissions, "pgr");
}

TEST(HealthConfig, NonsenseIsRefusedWithWhatIsAllowed) {
  EXPECT_THAT(problems_of("[dds.security]\ndirectory = \"keys\""), testing::HasSubstr("absolute path"));
  EXPECT_THAT(problems_of("[dds.security]\nenable = true"), testing::HasSubstr("enabled"));
  EXPECT_THAT(problems_of("[debounce]\nno_dat = {set_s = 1.0}"), testing::HasSubstr("no_data"));
  EXPECT_THAT(problems_of("[debounce]\nno_data = {set_s = 11.0}"), testing::HasSubstr("10"));
  EXPECT_THAT(problems_of("[pipeline]\nwindow_s = 0.4"), testing::HasSubstr("0.1 … 0.35")) << "too late a verdict";
  EXPECT_THAT(problems_of("[sight]\nleast_detections = 0.0"), testing::HasSubstr("0.5 … 20"));
  EXPECT_THAT(problems_of("[disturbance]\nleast_share = 1.0"), testing::HasSubstr("0.05 … 0.9"));
  EXPECT_THAT(problems_of("[learnt_levels]\nwrite_period_s = 0.1"), testing::HasSubstr("5 … 3600")) << "wear";
  EXPECT_THAT(problems_of("[fault_memory]\nageing_cycles = 0"), testing::HasSubstr("1 … 255"));
  EXPECT_THAT(problems_of("[fault_memory]\noperation_cycle = \"drive\""), testing::HasSubstr("start"));
  EXPECT_THAT(problems_of("[misalignment]\nconfidence = 1.0"), testing::HasSubstr("0.9 … 0.9999"));
  EXPECT_THAT(problems_of("[misalignment]\nconfidence_sigma = 2.33"), testing::HasSubstr("is called 'confidence' now"));
  EXPECT_THAT(problems_of("[misalignment]\ninhibit_deg = 7.3"),
              testing::HasSubstr("is 'limit' of each radar in the vehicle file now"));
}

}  // namespace
}  // namespace boresight::health
