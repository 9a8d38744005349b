// Data for the figures of docs/ghosts.md, and the tables beside them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/summary.hpp"

namespace boresight::bench {

/// Calibration of ghost_probability: how often detections with a given probability are truly ghosts or clutter. Writes
/// table `name` of the last method, and a curve of each method in the figure "reliability", panel `title`. Counts
/// detections that the corrector classified as moving, all drives together. `outcomes`: by method.
void add_reliability(const std::string& name, const std::string& title, const std::string& how,
                     std::span<const NamedGhostMethod> methods, const std::vector<std::vector<Outcome>>& outcomes,
                     Report& report);

/// One bar of the figure "compare": percent, in the group `panel`, row `what`, of the method or source `who`.
void add_comparison(const std::string& panel, const std::string& what, const std::string& who, double percent,
                    Report& report);

}  // namespace boresight::bench
