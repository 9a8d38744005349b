// The published scenario of five targets that merge and split (Xia et al. 2019), also with simulated range rates.
#include <algorithm>

#include "tests/benchmarks/tracking/scenarios/bars/bars.hpp"
#include "tests/benchmarks/tracking/scenarios/common/draw.hpp"
#include "tests/benchmarks/tracking/scenarios/common/outcome.hpp"

namespace boresight::bench::scenarios {

namespace {

Runs run_all(const std::string& tracker, const Scenario& scenario, const std::vector<Measurements>& runs,
             const Options& options) {
  Runs result{scenario.name, tracker, {}, {}};
  for (const Measurements& run : runs) {
    result.outcomes.push_back(run_tracker(tracker, scenario, run, passes(options, 3)));
    if (!run.origins.empty()) result.oracle.push_back(run_oracle(scenario, run));
  }
  return result;
}

}  // namespace

void split_merge(const Options& options, Report& report) {
  if (!has_shared_data(options.data_folder, "split_merge")) return;
  constexpr double kTrueBase = 10.6, kWithRangeRates = 0.6, kWorstCpu_ms = 3.0;
  SplitMerge published = read_split_merge(options.data_folder);
  published.runs.resize(options.seeds(published.runs.size()));

  Scenario with_rates = published.scenario;
  with_rates.name += ", range rates";
  with_rates.model.range_rate_std_mps = 0.1;
  with_rates.model.clutter_range_rate_span_mps = 40.0;
  std::vector<Measurements> runs_with_rates = published.runs;
  for (std::size_t i = 0; i < runs_with_rates.size(); ++i) {
    draw_origins(with_rates, options.fresh_seed + i, runs_with_rates[i]);
    add_range_rates(with_rates, options.fresh_seed + i, runs_with_rates[i]);
  }

  Table table{"split_merge",
              "five targets that merge and split, recorded runs; range rates are simulated, with a standard deviation "
              "of 0.1 m/s",
              outcome_header(),
              {}};
  for (const std::string tracker : kTrackers) {
    const Runs without = run_all(tracker, published.scenario, published.runs, options);
    const Runs with = run_all(tracker, with_rates, runs_with_rates, options);
    table.rows.push_back(row_of(without, nullptr));
    table.rows.push_back(row_of(with, nullptr));
    if (tracker != "pmbm") continue;
    const std::string how = std::to_string(published.runs.size()) + " recorded runs";
    report.at_most("split_merge", "pmbm: lost targets", static_cast<double>(without.lost()), 0.0, "", how);
    report.at_most("split_merge", "pmbm: GOSPA, true", without.mean().root, kTrueBase, "", how);
    report.at_most("split_merge", "pmbm: with range rates over without, squared",
                   with.mean().squared / without.mean().squared, kWithRangeRates, "", how);
    report.at_most("split_merge", "pmbm: with range rates over without, true", with.mean().root / without.mean().root,
                   kWithRangeRates, "", how);
    report.at_most("split_merge", "pmbm: CPU time of a scan, worst",
                   std::max(without.worst_cpu_ms(), with.worst_cpu_ms()), kWorstCpu_ms, "ms", how);
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench::scenarios
