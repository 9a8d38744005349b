#include "tests/system/dds_silence/bench.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "services/health/core/faults/event.hpp"
#include "services/health/core/faults/status.hpp"
#include "tests/system/harness/domain.hpp"

namespace boresight::dds {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kDomain = 79;
const fs::path kConfig = "/tmp/config";

}  // namespace

Tool::Tool(const Config& config)
    : reader_(config, {.on_sensor_health =
                           [this](const diagnostics::SensorHealth& sensor) {
                             const std::lock_guard lock(mutex_);
                             states_.try_emplace(sensor.radar_name(), Absence::kNone);
                           },
                       .on_system_health =
                           [this](const diagnostics::SystemHealth&) {
                             const std::lock_guard lock(mutex_);
                             states_.try_emplace("system", Absence::kNone);
                           },
                       .on_diagnostic_array =
                           [this](const diagnostic_msgs::msg::dds_::DiagnosticArray_& array) {
                             const std::lock_guard lock(mutex_);
                             levels_.clear();
                             for (const auto& status : array.status_()) levels_.push_back(status.level_());
                             ++arrays_;
                           },
                       .on_presence =
                           [this](const Presence& presence) {
                             const std::lock_guard lock(mutex_);
                             if (presence.topic != kDiagnosticsTopic.name) states_[presence.source] = presence.absence;
                           }}) {}

std::size_t Tool::sources() {
  const std::lock_guard lock(mutex_);
  return states_.size();
}

std::size_t Tool::in_state(Absence absence) {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(
      std::ranges::count_if(states_, [absence](const auto& state) { return state.second == absence; }));
}

std::size_t Tool::absent() {
  const std::size_t present = in_state(Absence::kNone);
  return sources() - present;
}

std::vector<int> Tool::levels() {
  const std::lock_guard lock(mutex_);
  return levels_;
}

std::size_t Tool::arrays() {
  const std::lock_guard lock(mutex_);
  return arrays_;
}

std::unique_ptr<network::TwoHosts> SilenceTest::hosts_;
std::unique_ptr<harness::Roudi> SilenceTest::roudi_;

void SilenceTest::SetUpTestSuite() {
  if (hosts_) return;
  hosts_ = std::make_unique<network::TwoHosts>();
  fs::copy(harness::shipped_configuration(), kConfig,
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  setenv("BORESIGHT_DDS_DOMAIN", std::to_string(kDomain).c_str(), 1);
  roudi_ = std::make_unique<harness::Roudi>();
}

void SilenceTest::TearDownTestSuite() {
  roudi_.reset();
  hosts_.reset();
}

void SilenceTest::start_health(const std::string& interfaces) {
  const fs::path shipped = harness::shipped_configuration() / "services" / "health.toml";
  std::ifstream input(shipped);
  std::string text{std::istreambuf_iterator<char>(input), {}};
  const std::string default_interfaces = "interfaces = [\"127.0.0.1\"]";
  const std::size_t at = text.find(default_interfaces);
  ASSERT_NE(at, std::string::npos);
  std::ofstream(kConfig / "services" / "health.toml")
      << text.replace(at, default_interfaces.size(), "interfaces = " + interfaces);
  health_ = harness::start_alone("health", kConfig);
}

Config SilenceTest::config(const std::vector<std::string>& interfaces) {
  return {.domain = kDomain, .interfaces = interfaces, .command_key_file = {}};
}

bool SilenceTest::mute_becomes(bool is_failed, FaultMemoryClient& client, double seconds) {
  const std::uint32_t dtc = health::dtc_of({health::EventKind::kDiagnosticsMute});
  return harness::eventually(seconds, [&] {
    client.poll();
    const auto record = client.records().find(dtc);
    if (record == client.records().end()) return client.is_complete() && !is_failed;
    return ((record->second.status() & health::dtc_status::kTestFailed) != 0) == is_failed;
  });
}

}  // namespace boresight::dds
