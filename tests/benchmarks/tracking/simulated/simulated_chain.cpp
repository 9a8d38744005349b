#include "tests/benchmarks/tracking/simulated/simulated_chain.hpp"

#include <algorithm>
#include <memory>
#include <random>

#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"

namespace boresight::bench::tracking {

namespace {

constexpr const char* kVehicle = "demo";

VehicleConfig vehicle_of(const SimulatedDrive& drive, const std::filesystem::path& config,
                         runtime::Configuration& files) {
  files.directory = config;
  files.vehicle_name = kVehicle;
  files.statistics = drive.profile;
  return files.vehicle(config::VehicleUse::kOffline);
}

run::Settings settings_of(const SimulatedDrive& drive, const std::filesystem::path& config) {
  runtime::Configuration files;
  const VehicleConfig vehicle = vehicle_of(drive, config, files);
  run::Settings settings = run::read_settings(files, vehicle);
  if (!drive.tracker.empty()) settings.tracker.tracker = drive.tracker;
  return settings;
}

simulator::Drive made(const SimulatedDrive& of, const VehicleConfig& vehicle) {
  simulator::Scenario scenario = simulator::scenario(of.scenario);
  simulator::use_profile(scenario, of.profile);
  const double duration_s = of.longest_s > 0.0 ? std::min(of.longest_s, scenario.duration_s) : scenario.duration_s;
  return simulator::Drive(scenario, vehicle, of.seed, duration_s);
}

}  // namespace

std::vector<std::string> scenarios_with_moving_objects() {
  std::vector<std::string> names = simulator::scenario_names();
  std::erase_if(names, [](const std::string& name) {
    if (name == "stopped_car" || name == "crossing_pedestrian" || name == "parked_row_in_curve") return true;
    const simulator::Scenario scenario = simulator::scenario(name);
    return std::all_of(scenario.bodies.begin(), scenario.bodies.end(), [](const auto& body) { return body.parked; });
  });
  return names;
}

std::uint64_t draw_seed() {
  return 1'000'000 + 1'000 * (std::random_device{}() % 1'000'000);
}

SimulatedChain::SimulatedChain(const SimulatedDrive& drive, const std::filesystem::path& config)
    : vehicle_([&] {
        runtime::Configuration files;
        return vehicle_of(drive, config, files);
      }()),
      settings_(settings_of(drive, config)),
      drive_(made(drive, vehicle_)) {}

void SimulatedChain::play(const std::function<void(const simulator::Event&, const run::Chain&)>& take) {
  run::Chain chain(vehicle_, settings_);
  const auto scan = std::make_unique<RadarScan>();
  while (const simulator::Event* event = drive_.next()) {
    chain.advance(event->stamp_ns);
    if (event->scan == nullptr) {
      EgoMotion motion = simulator::to_message(*event, vehicle_.ego);
      chain.add_ego(motion, event->stamp_ns);
      continue;
    }
    *scan = *event->scan;
    if (chain.add_scan(*scan, event->stamp_ns)) take(*event, chain);
  }
}

}  // namespace boresight::bench::tracking
