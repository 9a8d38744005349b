// An alignment drive as files for `boresight align`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "tests/simulator/alignment/spec.hpp"

namespace boresight::simulator {

struct AlignmentFiles {
  std::filesystem::path drive, ego, vehicle, truth;
  std::uint64_t scans = 0, detections = 0;
};

/// Drives, and writes into `folder` (made where it is not there):
///   drive.csv     t,radar,range,az,el,vr,is_stationary: s since the start, radar id, m, rad, rad, m/s, truth. `el` is
///                 empty for radars that measure none. Behind it az_std,el_std,vr_std where radars state stds, and
///                 vr_min,vr_max where an interval is ambiguous.
///   ego.csv       t,v,yaw_rate: as signalled, m/s and rad/s
///   vehicle.toml  the nominal vehicle, as in config/schema/vehicle.md
///   truth.txt     truth, residuals and the Cramér–Rao bound; angles before any knock, one line a knock with those
///   after
/// `progress` hears the share of the drive that is written, in [0, 1]. Throws std::runtime_error where a file cannot be
/// written.
AlignmentFiles write_alignment_drive(const AlignmentSpec& spec, const std::filesystem::path& folder,
                                     const std::function<void(double)>& progress);

}  // namespace boresight::simulator
