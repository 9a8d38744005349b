// Runs the chain over a labelled drive and collects the evidence of its moving detections.
#pragma once

#include <cstdint>
#include <functional>

#include "services/boresight/fit_evidence/labelled_drive.hpp"
#include "services/boresight/fit_evidence/lanes.hpp"
#include "services/boresight/input/problems.hpp"
#include "services/boresight/run/chain.hpp"

namespace boresight::fit_evidence {

struct DriveRun {
  DriveEvidence evidence;
  std::uint64_t scans = 0;
  std::uint64_t moving_scans = 0;         ///< with moving detections
  std::uint64_t scans_without_truth = 0;  ///< of `moving_scans`: not fitted
  std::uint64_t scans_without_ego_motion = 0;
  std::uint64_t lines_of_unknown_radars = 0;  ///< of tables
};

/// `settings`: of the services; the method of the ghost filter must be `evidence`. Lines and frames are counted in
/// `problems`. `look`: called now and then with the share of the input that is read, negative if unknown; may throw to
/// end the work. Throws score::InputError, input::TableError or recording::OpenError for input that cannot be read.
[[nodiscard]] DriveRun run_drive(const LabelledDrive& drive, const VehicleConfig& vehicle,
                                 const run::Settings& settings, input::Problems& problems,
                                 const std::function<void(double share)>& look);

}  // namespace boresight::fit_evidence
