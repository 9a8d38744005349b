// Extent of a run, and the drives that its groups share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/benchmarks/ghosts/drives/judge/figures.hpp"

namespace boresight::bench::ghosts_drives {

struct Setup {
  std::vector<std::string> scenarios;
  std::size_t seeds = 3;  ///< drives of each scenario and profile
  std::size_t highway_seeds = 20;
  std::size_t jobs = 2;
  std::uint64_t first_seed = 1;
  double longest_s = 25.0;
  bool starts_at_zero = false;  ///< all weights 0 instead of those of the profile
  bool fits_others = false;     ///< judges each scenario with weights that are fitted on the others
  std::string weights_folder;   ///< for weights fitted on the judged drives; empty: none are fitted

  [[nodiscard]] std::uint64_t last_seed() const { return first_seed + seeds - 1; }
  /// "…; seeds 101 … 103; at most 25 s"
  [[nodiscard]] std::string drives_text() const;
};

/// File of a radar profile, by name or path.
[[nodiscard]] std::string file_of_profile(const std::string& profile);
[[nodiscard]] ghosts::EvidenceWeights start_weights(const Setup& setup, const std::string& profile);

/// The drives of one radar profile, run when they are needed first. By scenario, then seed.
class ProfileDrives {
 public:
  ProfileDrives(const Setup& setup, std::string profile);

  /// Name, also if the profile was given as a file.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const ghosts::EvidenceWeights& weights() const { return weights_; }
  /// Drives of the judging seeds with the weights of the profile.
  [[nodiscard]] const std::vector<DriveResult>& judged();
  /// The same of other seeds, for fits.
  [[nodiscard]] const std::vector<DriveResult>& for_fits();
  /// Drives of the judging seeds, each with weights that are fitted on the other scenarios' drives of other seeds.
  [[nodiscard]] std::vector<DriveResult> judged_by_others();

 private:
  using WeightsByScenario = std::map<std::string, ghosts::EvidenceWeights>;
  [[nodiscard]] std::vector<DriveResult> run(std::uint64_t first_seed, const WeightsByScenario& weights) const;
  [[nodiscard]] WeightsByScenario same_weights() const;

  const Setup& setup_;
  std::string profile_, name_;
  ghosts::EvidenceWeights weights_;
  std::optional<std::vector<DriveResult>> judged_, for_fits_;
};

/// The evidence of all lanes' detections, but for drives with indices from `first` to before `end`.
[[nodiscard]] std::vector<fit_evidence::LabelledEvidence> evidence_of(const std::vector<DriveResult>& drives,
                                                                      std::size_t first = 0, std::size_t end = 0);

[[nodiscard]] Drives pointers(const std::vector<DriveResult>& drives);

}  // namespace boresight::bench::ghosts_drives
