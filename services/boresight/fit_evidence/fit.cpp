#include "services/boresight/fit_evidence/fit.hpp"

#include <cstdint>

namespace boresight::fit_evidence {

namespace {

std::vector<DriveEvidence> run_all(std::size_t drives, const RunDrive& run, const ghosts::EvidenceWeights& weights) {
  std::vector<DriveEvidence> all;
  for (std::size_t d = 0; d < drives; ++d) all.push_back(run(d, weights));
  return all;
}

/// The weights of all drives but one. `except`: index of the drive, or beyond the last one.
ghosts::EvidenceWeights fit(const std::vector<DriveEvidence>& drives, std::size_t except = SIZE_MAX) {
  std::vector<LabelledEvidence> all;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    if (d != except) append(drives[d], all);
  }
  return fit_weights(all, {});
}

void check(const std::vector<std::string>& names, const std::vector<DriveEvidence>& drives, Fit& out) {
  for (std::size_t d = 0; d < drives.size(); ++d) {
    if (drives[d].detections() == 0) throw NoFit(names[d] + ": has no labelled moving detection");
    out.detections += drives[d].detections();
    out.real_detections += drives[d].real_detections();
  }
  if (out.real_detections == 0) throw NoFit("no moving detection of the drives is real, so no weights can be fitted");
  if (out.real_detections == out.detections) {
    throw NoFit("all moving detections of the drives are real, so no weights can be fitted");
  }
}

void add_base_rates(const DriveEvidence& drive, std::size_t lane, Scores& scores) {
  for (std::size_t i = 0; i < drive.lanes[lane].size(); ++i) {
    scores.add(static_cast<double>(drive.base_rates[i]), drive.lanes[lane][i].is_real);
  }
}

}  // namespace

Fit fit_drives(const std::vector<std::string>& names, const ghosts::EvidenceWeights& start, const RunDrive& run) {
  Fit result;
  std::vector<DriveEvidence> drives = run_all(names.size(), run, start);
  check(names, drives, result);
  for (const DriveEvidence& drive : drives) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      add_base_rates(drive, lane, result.scores[lane].base_rate);
      result.scores[lane].start.add(drive.lanes[lane], start);
    }
  }
  drives = run_all(names.size(), run, fit(drives));
  result.weights = fit(drives);
  result.judges_other_drives = names.size() > 1;
  for (std::size_t d = 0; d < names.size(); ++d) {
    const ghosts::EvidenceWeights weights = result.judges_other_drives ? fit(drives, d) : result.weights;
    const DriveEvidence judged = run(d, weights);
    for (std::size_t lane = 0; lane < kLanes; ++lane) result.scores[lane].fitted.add(judged.lanes[lane], weights);
  }
  return result;
}

}  // namespace boresight::fit_evidence
