// The worth of parts of the evidence: change of the Brier score when one is missing.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "services/boresight/fit_evidence/fit_weights.hpp"
#include "tests/benchmarks/ghosts/drives/judge/judged.hpp"

namespace boresight::bench::ghosts_drives {

/// One or several kinds of evidence, or the tracks.
struct EvidencePart {
  std::string name;
  std::vector<ghosts::EvidenceKind> kinds;
  bool is_tracks = false;
};
/// Each kind, both kinds of mirror images, all statements of the sensor, the tracks.
[[nodiscard]] std::vector<EvidencePart> evidence_parts();

/// The lowest level of the part's kinds. Without the tracks: (G1) judges, and the other levels stay.
[[nodiscard]] ghosts::Levels without(const EvidencePart& part, ghosts::Levels levels);

using fit_evidence::EvidenceByLane;

/// Change of the Brier score in % by lane if the part is missing in the fit and in the judgement. Positive: the part
/// improves the score. `full`: weights of the same fit with all evidence.
[[nodiscard]] std::array<double, kEvidenceLanes> brier_change_percent(
    const EvidencePart& part, const std::vector<fit_evidence::LabelledEvidence>& fit, const EvidenceByLane& judged,
    const ghosts::EvidenceWeights& full);

}  // namespace boresight::bench::ghosts_drives
