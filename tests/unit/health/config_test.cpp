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
  EXPECT_EQ(s.min_rate_ratio, expected.min_rate_ratio);
  EXPECT_EQ(s.max_rejected_ratio, expected.max_rejected_ratio);
  EXPECT_EQ(s.max_suspect_ratio, expected.max_suspect_ratio);
  EXPECT_EQ(s.restart_memory_s, expected.restart_memory_s);
  EXPECT_EQ(s.start_grace_s, expected.start_grace_s);
  EXPECT_EQ(s.confidence, expected.confidence);
  EXPECT_EQ(s.set_s, expected.set_s);
  EXPECT_EQ(s.clear_s, expected.clear_s);
  EXPECT_EQ(s.clear_ratio, expected.clear_ratio);
  EXPECT_EQ(s.reference_range_m, expected.reference_range_m);
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
  EXPECT_EQ(read.dds.command_key_file, "") << "nobody may command unless the integrator wants it";
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

TEST(HealthConfig, NonsenseIsRefusedWithWhatIsAllowed) {
  EXPECT_THAT(problems_of("[debounce]\nno_dat = {set_s = 1.0}"), testing::HasSubstr("no_data"));
  EXPECT_THAT(problems_of("[debounce]\nno_data = {set_s = 11.0}"), testing::HasSubstr("10"));
  EXPECT_THAT(problems_of("[fault_memory]\nageing_cycles = 0"), testing::HasSubstr("1 … 255"));
  EXPECT_THAT(problems_of("[fault_memory]\noperation_cycle = \"drive\""), testing::HasSubstr("start"));
  EXPECT_THAT(problems_of("[misalignment]\nconfidence = 1.0"), testing::HasSubstr("0.9 … 0.9999"));
  EXPECT_THAT(problems_of("[misalignment]\nconfidence_sigma = 2.33"), testing::HasSubstr("is called 'confidence' now"));
  EXPECT_THAT(problems_of("[misalignment]\ninhibit_deg = 7.3"),
              testing::HasSubstr("is 'limit' of each radar in the vehicle file now"));
}

}  // namespace
}  // namespace boresight::health
