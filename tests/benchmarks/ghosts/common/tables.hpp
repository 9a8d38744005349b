// Tables and bars of many drives.
#pragma once

#include <string>
#include <vector>

#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/ghosts/common/summary.hpp"

namespace boresight::bench {

/// Rows: truth. Columns: classification, in percent of the detections that the corrector did not reject (medians over
/// the drives).
[[nodiscard]] Table confusion_table(const std::string& name, const std::string& caption,
                                    const std::vector<Outcome>& outcomes);

/// A bar on the median; the note names the worst seed's figure.
void judge_percent(const std::string& group, const std::string& what, Percent percent, double bar,
                   const std::string& how, Report& report);

/// Bars on the tracker's output: no ghost track and no lost object in any drive. Not `judged`: figures without a bar.
/// `how`: "20 seeds of 20 s".
void judge_tracks(const std::string& group, const std::vector<Outcome>& outcomes, bool judged, const std::string& how,
                  Report& report);

}  // namespace boresight::bench
