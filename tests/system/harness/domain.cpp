#include "tests/system/harness/domain.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <unistd.h>

#include "deploy/roudi/pools.hpp"
#include "deploy/supervisor/domain.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/drive_writer.hpp"
#include "services/simulator/scenario/read_profile.hpp"

namespace boresight::harness {

namespace {

namespace fs = std::filesystem;

const fs::path kFolder = "/tmp/domain";
const fs::path kBinaries = BORESIGHT_BINARY_DIR;
const fs::path kConfig = fs::path(BORESIGHT_SOURCE_DIR) / "config";

supervisor::DomainConfig configuration(const std::string& vehicle, const std::vector<std::string>& without,
                                       const fs::path& folder, const std::vector<supervisor::ProcessSpec>& more) {
  fs::create_directories(kFolder / "logs");
  const fs::path pools = kFolder / "logs" / "roudi.toml";
  std::ofstream(pools) << roudi::to_toml(roudi::single_segment());
  supervisor::DomainConfig config = supervisor::domain_of_catalogue({.binaries = kBinaries,
                                                                     .config_directory = folder,
                                                                     .vehicle = vehicle,
                                                                     .run_directory = kFolder / "run",
                                                                     .log_directory = kFolder / "logs",
                                                                     .environment = {{"BORESIGHT_INPUT", "replay"}}},
                                                                    pools);
  std::erase_if(config.services, [&](const supervisor::ProcessSpec& spec) {
    return std::find(without.begin(), without.end(), spec.name) != without.end();
  });
  config.services.insert(config.services.end(), more.begin(), more.end());
  return config;
}

}  // namespace

Domain::Domain(const std::string& vehicle, const std::vector<std::string>& without, const fs::path& config,
               const std::vector<supervisor::ProcessSpec>& more)
    : supervisor_(configuration(vehicle, without, config, more)) {}

void Domain::start() {
  supervisor_.start();
  if (!until(20.0, [this] { return supervisor_.all_ready(); })) throw std::runtime_error("a service did not start");
}

void Domain::replay(const std::vector<fs::path>& recordings, std::vector<std::string> options) {
  supervisor::ProcessSpec spec;
  spec.name = "replay";
  spec.role = supervisor::Role::kIndependent;
  spec.command.arguments = {(kBinaries / "boresight-replay").string()};
  for (const std::string& option : options) spec.command.arguments.push_back(option);
  for (const fs::path& recording : recordings) spec.command.arguments.push_back(recording.string());
  spec.command.environment = {{"BORESIGHT_RUNTIME_DIR", (kFolder / "run").string()}};
  supervisor_.start_independent(spec);
}

bool Domain::until(double seconds, const std::function<bool()>& condition) {
  const std::int64_t deadline_ns = runtime::monotonic_now_ns() + static_cast<std::int64_t>(seconds * 1e9);
  while (!condition()) {
    if (runtime::monotonic_now_ns() > deadline_ns) return false;
    supervisor_.poll(5'000'000);
  }
  return true;
}

void Domain::run_for(double seconds) {
  static_cast<void>(until(seconds, [] { return false; }));
}

bool Domain::replay_has_ended() {
  const auto result = supervisor_.independent_result("replay");
  if (result) {
    EXPECT_EQ(*result, 0) << "boresight-replay: " << supervisor::describe_exit(*result);
  }
  return result.has_value();
}

fs::path shipped_configuration() {
  return kConfig;
}

fs::path log_of_alone(const std::string& service) {
  return kFolder / "logs" / (service + "-alone.log");
}

std::unique_ptr<Child> start_alone(const std::string& service, const fs::path& config) {
  fs::create_directories(kFolder / "logs");
  return std::make_unique<Child>([service, config] {
    const std::string binary = (kBinaries / ("boresight-" + service)).string();
    const std::string log = log_of_alone(service).string();
    setenv("BORESIGHT_INPUT", "replay", 1);
    setenv("BORESIGHT_RUNTIME_DIR", (kFolder / "run").c_str(), 1);
    if (std::freopen(log.c_str(), "w", stderr) == nullptr) return 1;
    execl(binary.c_str(), binary.c_str(), "--config", config.c_str(), "--vehicle", "demo", nullptr);
    return 1;
  });
}

std::vector<fs::path> simulated_drive(double duration_s, const std::string& scenario_name, const std::string& profile) {
  const VehicleConfig vehicle = config::read_vehicle_file(kConfig / "vehicle" / "demo.toml");
  simulator::Scenario scenario = simulator::scenario(scenario_name);
  if (!profile.empty()) simulator::use_profile(scenario, profile);
  const simulator::DriveFiles files =
      simulator::write_drive(scenario, vehicle, 1, duration_s, "/tmp/drive", [](double) {});
  return {files.radars, files.ego};
}

}  // namespace boresight::harness
