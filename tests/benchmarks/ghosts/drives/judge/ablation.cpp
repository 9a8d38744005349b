#include "tests/benchmarks/ghosts/drives/judge/ablation.hpp"

#include "services/boresight/fit_evidence/scores.hpp"

namespace boresight::bench::ghosts_drives {

namespace {

double brier_score(const std::vector<fit_evidence::LabelledEvidence>& detections,
                   const ghosts::EvidenceWeights& weights) {
  fit_evidence::Scores scores;
  scores.add(detections, weights);
  return scores.brier();
}

std::vector<fit_evidence::LabelledEvidence> all_without(const EvidencePart& part,
                                                        std::vector<fit_evidence::LabelledEvidence> detections) {
  for (fit_evidence::LabelledEvidence& each : detections) each.levels = without(part, each.levels);
  return detections;
}

}  // namespace

std::vector<EvidencePart> evidence_parts() {
  std::vector<EvidencePart> parts;
  for (std::size_t k = 0; k < ghosts::kEvidences; ++k) {
    parts.push_back({std::string(ghosts::kEvidenceSpecs[k].key), {static_cast<ghosts::EvidenceKind>(k)}});
  }
  parts.push_back(
      {"image_type_1 and image_type_2", {ghosts::EvidenceKind::kImageType1, ghosts::EvidenceKind::kImageType2}});
  parts.push_back({"verdict and existence", {ghosts::EvidenceKind::kVerdict, ghosts::EvidenceKind::kExistence}});
  parts.push_back({"tracks", {}, true});
  return parts;
}

ghosts::Levels without(const EvidencePart& part, ghosts::Levels levels) {
  for (const ghosts::EvidenceKind kind : part.kinds) levels.of[static_cast<std::size_t>(kind)] = 0;
  if (part.is_tracks) levels.has_tracks = false;
  return levels;
}

std::array<double, kEvidenceLanes> brier_change_percent(const EvidencePart& part,
                                                        const std::vector<fit_evidence::LabelledEvidence>& fit,
                                                        const EvidenceByLane& judged,
                                                        const ghosts::EvidenceWeights& full) {
  // (G1) is fitted without the tracks anyway.
  const ghosts::EvidenceWeights reduced = part.is_tracks ? full : fit_evidence::fit_weights(all_without(part, fit), {});
  std::array<double, kEvidenceLanes> changes{};
  for (std::size_t lane = 0; lane < kEvidenceLanes; ++lane) {
    const double with = brier_score(judged[lane], full);
    changes[lane] = 100.0 * (brier_score(all_without(part, judged[lane]), reduced) / with - 1.0);
  }
  return changes;
}

}  // namespace boresight::bench::ghosts_drives
