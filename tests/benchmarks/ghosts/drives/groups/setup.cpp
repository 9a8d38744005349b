#include "tests/benchmarks/ghosts/drives/groups/setup.hpp"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "services/ghost_filter/weights_file.hpp"
#include "tests/benchmarks/common/parallel.hpp"

namespace boresight::bench::ghosts_drives {

std::string Setup::drives_text() const {
  return fmt::format("{} scenarios; seeds {} … {}; at most {} s", scenarios.size(), first_seed, last_seed(), longest_s);
}

std::string file_of_profile(const std::string& profile) {
  if (profile.find('/') != std::string::npos) return profile;
  return BORESIGHT_SOURCE_DIR "/config/radar_profiles/" + profile + ".toml";
}

ghosts::EvidenceWeights start_weights(const Setup& setup, const std::string& profile) {
  if (setup.starts_at_zero) return {};
  return ghosts::read_weights(std::filesystem::path(file_of_profile(profile)));
}

std::vector<fit_evidence::LabelledEvidence> evidence_of(const std::vector<DriveResult>& drives, std::size_t first,
                                                        std::size_t end) {
  std::vector<fit_evidence::LabelledEvidence> all;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    if (d < first || d >= end) fit_evidence::append(drives[d].evidence, all);
  }
  return all;
}

Drives pointers(const std::vector<DriveResult>& drives) {
  Drives all;
  for (const DriveResult& each : drives) all.push_back(&each);
  return all;
}

ProfileDrives::ProfileDrives(const Setup& setup, std::string profile)
    : setup_(setup),
      profile_(std::move(profile)),
      name_(std::filesystem::path(file_of_profile(profile_)).stem().string()),
      weights_(start_weights(setup, profile_)) {}

std::vector<DriveResult> ProfileDrives::run(std::uint64_t first_seed, const WeightsByScenario& weights) const {
  std::vector<DriveSpec> specs;
  for (const std::string& scenario : setup_.scenarios) {
    for (std::uint64_t seed = first_seed; seed < first_seed + setup_.seeds; ++seed) {
      specs.push_back({scenario, profile_, seed, setup_.longest_s});
    }
  }
  std::vector<DriveResult> results(specs.size());
  parallel_for(specs.size(), setup_.jobs, [&](std::size_t i) {
    ghosts::Config config;
    config.evidence.weights = weights.at(specs[i].scenario);
    results[i] = run_drive(specs[i], config);
  });
  return results;
}

ProfileDrives::WeightsByScenario ProfileDrives::same_weights() const {
  WeightsByScenario weights;
  for (const std::string& scenario : setup_.scenarios) weights[scenario] = weights_;
  return weights;
}

const std::vector<DriveResult>& ProfileDrives::judged() {
  if (!judged_) judged_ = run(setup_.first_seed, same_weights());
  return *judged_;
}

const std::vector<DriveResult>& ProfileDrives::for_fits() {
  if (!for_fits_) for_fits_ = run(setup_.first_seed + setup_.seeds, same_weights());
  return *for_fits_;
}

std::vector<DriveResult> ProfileDrives::judged_by_others() {
  const std::vector<DriveResult>& fits = for_fits();
  std::vector<ghosts::EvidenceWeights> fitted(setup_.scenarios.size());
  parallel_for(fitted.size(), setup_.jobs, [&](std::size_t s) {
    fitted[s] = fit_evidence::fit_weights(evidence_of(fits, s * setup_.seeds, (s + 1) * setup_.seeds), {});
  });
  WeightsByScenario weights;
  for (std::size_t s = 0; s < fitted.size(); ++s) weights[setup_.scenarios[s]] = fitted[s];
  return run(setup_.first_seed, weights);
}

}  // namespace boresight::bench::ghosts_drives
