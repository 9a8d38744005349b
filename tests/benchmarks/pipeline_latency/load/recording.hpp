// The crowded road as a recording that the gateway plays.
#pragma once

#include <cstdint>
#include <filesystem>

#include "services/common/vehicle/vehicle.hpp"
#include "tests/benchmarks/pipeline_latency/load/crowded_road.hpp"

namespace boresight::bench {

inline constexpr std::int64_t kCycle_ns = 50'000'000;

/// Writes `seconds` of all radars of `vehicle`: ARS548 lists over UDP, the cycles of the radars evenly apart. The
/// stamps begin with those of a simulated drive, so that its ego motion belongs to them.
void write_recording(const CrowdedRoad& road, const VehicleConfig& vehicle, double seconds,
                     const std::filesystem::path& file);

}  // namespace boresight::bench
