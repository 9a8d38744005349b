// An alignment drive as files for `boresight align`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "services/simulator/alignment/spec.hpp"

namespace boresight::simulator {

struct AlignmentFiles {
  std::filesystem::path drive, ego, vehicle, truth;
  std::uint64_t scans = 0, detections = 0;
};

/// Simulates a drive and writes into `folder` (made if absent):
///   drive.csv     t,radar,range,az,el,vr,is_stationary: stamp (s since the start), radar id, m, rad, rad, m/s, truth.
///   `el` is
///                 empty for radars without elevation. Further columns: az_std,el_std,vr_std if radars state standard
///                 deviations, and vr_min,vr_max if an interval is ambiguous.
///   ego.csv       t,v,yaw_rate: as signalled, m/s and rad/s
///   vehicle.toml  the nominal vehicle, as in config/schema/vehicle.md
///   truth.txt     truth, residuals and the Cramér–Rao bound. Angles are those at the start; each step change has a
///   line
///                 with the angles after it.
/// `progress` gets the written share of the drive, in [0, 1]. Throws std::runtime_error if a file cannot be written.
AlignmentFiles write_alignment_drive(const AlignmentSpec& spec, const std::filesystem::path& folder,
                                     const std::function<void(double)>& progress);

}  // namespace boresight::simulator
