// The result of a tracker or of the oracle on one run, and tables of many.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/tracking/scenarios/common/lost_targets.hpp"
#include "tests/benchmarks/tracking/scenarios/common/scenario.hpp"
#include "tests/benchmarks/tracking/scenarios/common/shared_data.hpp"

namespace boresight::bench::scenarios {

/// The compared trackers by their configuration names.
inline constexpr std::array kTrackers = {"pmbm", "phd"};

struct Outcome {
  MeanGospa gospa;
  LostTargets targets;
  double mean_cpu_ms = 0.0, worst_cpu_ms = 0.0;  ///< of each scan, the least of all passes
  std::size_t scans_over_budget = 0;
};

/// The tracker of the product with this configuration name. Throws std::runtime_error if two passes differ.
[[nodiscard]] Outcome run_tracker(const std::string& name, const Scenario& scenario, const Measurements& measurements,
                                  std::size_t passes);
[[nodiscard]] Outcome run_oracle(const Scenario& scenario, const Measurements& measurements);

/// The outcomes of one tracker on several runs of a scenario, and those of the oracle on the same runs, if any.
struct Runs {
  std::string scenario, tracker;
  std::vector<Outcome> outcomes, oracle;

  [[nodiscard]] MeanGospa mean() const;  ///< over the runs
  [[nodiscard]] MeanGospa mean_of_oracle() const;
  /// Tracker over oracle, by run.
  [[nodiscard]] std::vector<double> ratios(double MeanGospa::*base) const;
  [[nodiscard]] std::size_t lost() const;
  [[nodiscard]] double mean_cpu_ms() const;
  [[nodiscard]] double worst_cpu_ms() const;
};

/// Header of row_of().
[[nodiscard]] std::vector<std::string> outcome_header();
/// With more than one run, ratios have their median and its 95 % interval. `reference`: figures for comparison, or
/// nullptr.
[[nodiscard]] std::vector<std::string> row_of(const Runs& runs, const MeanGospa* reference);

/// Bars on the median of the ratio to the oracle, for both base distances.
void judge_ratio(const std::string& group, const Runs& runs, double bar, const std::string& how, Report& report);
/// Bars on the CPU time of a scan.
void judge_cpu(const std::string& group, const Runs& runs, double mean_ms, double worst_ms, const std::string& how,
               Report& report);

}  // namespace boresight::bench::scenarios
