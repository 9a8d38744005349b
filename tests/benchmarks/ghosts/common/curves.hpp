// What the figures of docs/ghosts.md are drawn from, and the tables beside them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/summary.hpp"

namespace boresight::bench {

/// How often what was given a ghost_probability was a ghost or clutter: table `name` of the last method, and a curve of
/// each in the figure "reliability", panel `title`. Of detections that the corrector found moving, of all drives
/// together. `outcomes`: by method.
void add_reliability(const std::string& name, const std::string& title, const std::string& how,
                     std::span<const NamedGhostMethod> methods, const std::vector<std::vector<Outcome>>& outcomes,
                     Report& report);

/// One bar of the figure "compare": percent, in the group `panel`, of the row `what`.
void add_comparison(const std::string& panel, const std::string& what, const std::string& who, double percent,
                    Report& report);

}  // namespace boresight::bench
