// What a method reported of a sudden change: of one radar's mounting, or of the load.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "services/alignment_estimator/core/windows/windowed_filter.hpp"
#include "tests/benchmarks/alignment/common/runner.hpp"

namespace boresight::bench {

struct ChangeReports {
  double delay_s = std::numeric_limits<double>::infinity();  ///< until the right radar is named; infinite: never
  std::size_t before = 0;                                    ///< reports before the change, of any radar
  std::size_t other_radar = 0;                               ///< reports of another radar, from the change on
};

/// Times are since the first message.
[[nodiscard]] inline ChangeReports reports_of_change(const std::vector<StepChangeSeen>& seen, std::size_t radar,
                                                     double change_s) {
  ChangeReports reports;
  for (const StepChangeSeen& report : seen) {
    if (report.time_s < change_s) {
      ++reports.before;
    } else if (report.radar != radar) {
      ++reports.other_radar;
    } else if (std::isinf(reports.delay_s)) {
      reports.delay_s = report.time_s - change_s;
    }
  }
  return reports;
}

/// What a method reported of the load, snapshot by snapshot. Only the windowed filter reports any.
class LoadReports {
 public:
  void look(const alignment::Method& method, double time_s) {
    const auto* filter = dynamic_cast<const alignment::WindowedFilter*>(&method);
    if (filter != nullptr) add(filter->load_changes(), time_s);
  }
  void add(int changes, double time_s) {
    for (; changes_ < changes; ++changes_) times_s_.push_back(time_s);
  }
  [[nodiscard]] std::size_t before(double change_s) const {
    std::size_t count = 0;
    for (const double time_s : times_s_) count += time_s < change_s ? 1 : 0;
    return count;
  }
  /// Until the first report from the change on; infinite: never.
  [[nodiscard]] double delay_s(double change_s) const {
    for (const double time_s : times_s_) {
      if (time_s >= change_s) return time_s - change_s;
    }
    return std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] std::size_t count() const { return times_s_.size(); }

 private:
  int changes_ = 0;
  std::vector<double> times_s_;
};

}  // namespace boresight::bench
