// A fit as text and as JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "services/boresight/fit_evidence/fit.hpp"

namespace boresight::fit_evidence {

/// A drive of the fit.
struct FittedDrive {
  std::string name;                                         ///< of its folder
  std::string seed;                                         ///< of a simulated drive; "": not known
  std::string folder;                                       ///< as given
  std::uint64_t moving_scans = 0, scans_without_truth = 0;  ///< as in DriveRun
  std::size_t detections = 0, real_detections = 0;          ///< moving ones
  bool has_objects = false;                                 ///< true objects: fitted with perfect tracks, too
};

/// Key `origin` of the weights: drives with their seeds, and number of their moving detections.
[[nodiscard]] std::string origin_of(const Fit& fit, const std::vector<FittedDrive>& drives);

/// The drives, and the scores of each lane.
[[nodiscard]] std::string to_text(const Fit& fit, const std::vector<FittedDrive>& drives);

/// Keys: config/schema/json.md. `profile`: file whose weights are the start; "" if there are none.
[[nodiscard]] std::string to_json(const Fit& fit, const std::vector<FittedDrive>& drives, const std::string& profile,
                                  const std::string& version);

}  // namespace boresight::fit_evidence
