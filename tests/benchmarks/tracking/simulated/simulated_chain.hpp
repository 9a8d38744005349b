// A simulated drive through the whole chain in this process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "services/boresight/run/chain.hpp"
#include "services/boresight/run/settings.hpp"
#include "services/simulator/drive.hpp"

namespace boresight::bench::tracking {

struct SimulatedDrive {
  std::string scenario, profile;  ///< names or files
  std::uint64_t seed = 1;
  double longest_s = 0.0;  ///< 0: as long as the scenario
  std::string tracker;     ///< empty: that of tracker.toml
};

/// Scenarios with moving objects, without those of the collision warnings.
[[nodiscard]] std::vector<std::string> scenarios_with_moving_objects();
/// Far from every seed that a person types, or that anything is tuned on.
[[nodiscard]] std::uint64_t draw_seed();

class SimulatedChain {
 public:
  /// `config`: folder with vehicle/ and services/. Throws what the readers of the configuration throw.
  SimulatedChain(const SimulatedDrive& drive, const std::filesystem::path& config);

  [[nodiscard]] const VehicleConfig& vehicle() const { return vehicle_; }
  [[nodiscard]] const run::Settings& settings() const { return settings_; }
  [[nodiscard]] const simulator::Drive& drive() const { return drive_; }
  /// Plays the drive; `take` gets each scan that passed the chain.
  void play(const std::function<void(const simulator::Event&, const run::Chain&)>& take);

 private:
  VehicleConfig vehicle_;
  run::Settings settings_;
  simulator::Drive drive_;
};

}  // namespace boresight::bench::tracking
