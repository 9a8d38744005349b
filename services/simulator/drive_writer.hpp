// A simulated drive as recordings with its truth beside them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/scenario_file.hpp"

namespace boresight::simulator {

struct DriveFiles {
  std::filesystem::path radars;      ///< radars.pcap
  std::filesystem::path ego;         ///< ego.candump.log
  std::filesystem::path truth;       ///< truth.csv: truth of the whole drive
  std::filesystem::path detections;  ///< truth_detections.csv: provenance of each detection
  std::filesystem::path objects;     ///< truth_objects.csv: bodies in the ego vehicle's frame, ten times a second
  std::filesystem::path sensors;     ///< truth_sensors.csv: state of a radar at each of its scans
  std::filesystem::path visibility;  ///< truth_visibility.csv: visibility of each body from the radar at each scan
  std::uint64_t scans = 0;
  std::uint64_t number_of_detections = 0;
};

/// Simulates a drive and writes it into `folder` (made if absent). `progress` gets the share done, 0 … 1. All radars of
/// `vehicle` must use the ARS548 profile, and its ego signals the Toyota profile. The vehicle must have every radar
/// that the scenario names. Throws std::invalid_argument if it does not, and std::runtime_error if a file cannot be
/// written.
DriveFiles write_drive(const Scenario& scenario, const VehicleConfig& vehicle, std::uint64_t seed, double duration_s,
                       const std::filesystem::path& folder, const std::function<void(double)>& progress);

}  // namespace boresight::simulator
