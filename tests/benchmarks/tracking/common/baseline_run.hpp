// The baseline tracker over a run folder: a second run folder with its tracks.
#pragma once

#include <filesystem>

#include "services/common/vehicle/vehicle.hpp"
#include "tests/benchmarks/tracking/common/baseline_tracker.hpp"

namespace boresight::bench {

/// Reads scans.csv and detections.csv of `run`; writes scans.csv and tracks.csv into `out`, which is made if need be.
/// Ghost labels are not read: the tracker tests the range rates itself. Throws std::runtime_error.
void run_baseline(const std::filesystem::path& run, const VehicleConfig& vehicle, const std::filesystem::path& out,
                  const BaselineSettings& settings = {});

}  // namespace boresight::bench
