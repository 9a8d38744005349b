// The groups of figures that the program runs.
#pragma once

#include <string>
#include <vector>

#include "tests/benchmarks/ghosts/common/findings.hpp"
#include "tests/benchmarks/ghosts/drives/groups/setup.hpp"

namespace boresight::bench::ghosts_drives {

/// Calibration, scores and losses of the probabilities with each radar profile.
void probabilities(const Setup& setup, std::vector<ProfileDrives>& profiles, Findings& findings);
/// The scene of Le Ba Thanh 2023, radar profile ideal, by both methods.
void highway(const Setup& setup, Findings& findings);
/// The worth of each kind of evidence, with each radar profile.
void ablation(const Setup& setup, std::vector<ProfileDrives>& profiles, Findings& findings);

}  // namespace boresight::bench::ghosts_drives
