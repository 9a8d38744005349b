// Weights of the evidence from labelled drives, and their scores.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/boresight/fit_evidence/lanes.hpp"
#include "services/boresight/fit_evidence/scores.hpp"

namespace boresight::fit_evidence {

/// The drives do not determine weights; what() says why.
class NoFit : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The same detections by three kinds of probabilities.
struct LaneScores {
  Scores base_rate;  ///< without evidence (base_rate.hpp)
  Scores start;      ///< the chain and its filter with the weights of the start
  Scores fitted;     ///< with fitted weights
};

struct Fit {
  ghosts::EvidenceWeights weights;  ///< fitted on all drives
  std::array<LaneScores, kLanes> scores;
  /// Each drive is judged by weights that are fitted on the other drives. False with one drive: `scores.fitted` is that
  /// of the fitted drive itself.
  bool judges_other_drives = false;
  std::size_t detections = 0, real_detections = 0;  ///< moving detections of all drives

  [[nodiscard]] const LaneScores& of(Lane lane) const { return scores[static_cast<std::size_t>(lane)]; }
};

/// Runs the chain with these weights over one of the drives, by its index.
using RunDrive = std::function<DriveEvidence(std::size_t drive, const ghosts::EvidenceWeights& weights)>;

/// Runs each drive three times. The tracks of the chain depend on the weights. The final fit therefore uses the second
/// run, with weights that are fitted on the first one. The third run judges. `names`: of the drives, for messages.
/// Throws NoFit if a drive has no moving detection, or if all detections of the drives are real or all false.
[[nodiscard]] Fit fit_drives(const std::vector<std::string>& names, const ghosts::EvidenceWeights& start,
                             const RunDrive& run);

}  // namespace boresight::fit_evidence
