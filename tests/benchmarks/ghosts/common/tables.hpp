// Tables and bars of many drives.
#pragma once

#include <string>
#include <vector>

#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/ghosts/common/summary.hpp"

namespace boresight::bench {

/// Rows of truth, columns of labels in percent (medians over the drives) of what the corrector did not leave out.
[[nodiscard]] Table confusion_table(const std::string& name, const std::string& caption,
                                    const std::vector<Outcome>& outcomes);

/// A bar on the median; the worst seed is told beside.
void judge_percent(const std::string& group, const std::string& what, Percent percent, double bar,
                   const std::string& how, Report& report);

/// Bars on what is left of ghosts, and of objects, after the tracker: none in any drive. Not `judged`: beside.
void judge_tracks(const std::string& group, const std::vector<Outcome>& outcomes, bool judged, const std::string& how,
                  Report& report);

}  // namespace boresight::bench
