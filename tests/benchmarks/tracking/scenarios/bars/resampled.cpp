// New measurements of the recorded scenarios' truth, drawn with fresh seeds, beside the oracle.
#include "tests/benchmarks/common/statistics.hpp"
#include "tests/benchmarks/tracking/scenarios/bars/bars.hpp"
#include "tests/benchmarks/tracking/scenarios/common/draw.hpp"
#include "tests/benchmarks/tracking/scenarios/common/made_scenario.hpp"
#include "tests/benchmarks/tracking/scenarios/common/outcome.hpp"

namespace boresight::bench::scenarios {

namespace {

/// Each tracker on the same draws; the order is that of kTrackers.
std::vector<Runs> run_draws(const Scenario& scenario, std::size_t seeds, const Options& options) {
  std::vector<Runs> all;
  for (const std::string tracker : kTrackers) all.push_back({scenario.name, tracker, {}, {}});
  for (std::size_t i = 0; i < seeds; ++i) {
    const Measurements drawn = draw_measurements(scenario, options.fresh_seed + i);
    const Outcome oracle = run_oracle(scenario, drawn);
    for (Runs& runs : all) {
      runs.outcomes.push_back(run_tracker(runs.tracker, scenario, drawn, passes(options, 3)));
      runs.oracle.push_back(oracle);
    }
  }
  return all;
}

void add_table(const std::string& name, const std::string& caption, const std::vector<Runs>& all, Report& report) {
  Table table{name, caption, outcome_header(), {}};
  for (const Runs& runs : all) table.rows.push_back(row_of(runs, nullptr));
  report.add(std::move(table));
}

std::string how_of(std::size_t seeds) {
  return "median over " + std::to_string(seeds) + " fresh seeds";
}

}  // namespace

void resampled(const Options& options, Report& report) {
  if (!has_shared_data(options.data_folder, "resampled")) return;
  const std::size_t seeds = options.seeds(8);
  std::vector<Runs> all;
  for (const auto& [name, bar] :
       {std::pair{"xia_c30_s2", 1.02}, std::pair{"xia_c60_s1", 1.02}, std::pair{"hwy_c15_s11", 1.10}}) {
    const Scenario scenario = read_recorded_scenario(options.data_folder, name).scenario;
    std::vector<Runs> of_scenario = run_draws(scenario, seeds, options);
    judge_ratio("resampled", of_scenario.front(), bar, how_of(seeds), report);
    all.insert(all.end(), of_scenario.begin(), of_scenario.end());
  }
  add_table("resampled", "new measurements of the recorded scenarios' truth", all, report);
}

void hard_highway(const Options& options, Report& report) {
  if (!has_shared_data(options.data_folder, "hard_highway")) return;
  constexpr double kRatio = 1.3;
  const std::size_t seeds = options.seeds(12);
  Scenario scenario = read_recorded_scenario(options.data_folder, "hwy_c15_s11").scenario;
  scenario.name = "hwy, P_D 0.7, 120 clutter";
  scenario.model.detection_probability = 0.7;
  scenario.model.clutter_per_scan = 120.0;
  const std::vector<Runs> all = run_draws(scenario, seeds, options);
  judge_ratio("hard_highway", all.front(), kRatio, how_of(seeds), report);
  add_table("hard_highway", "the highway with P_D 0.7 and 120 clutter measurements a scan", all, report);
}

void made(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(8), scans = options.quick ? 20 : 60;
  const std::vector<Runs> all = run_draws(make_scenario(15, 250, scans, options.fresh_seed), seeds, options);
  for (const Runs& runs : all) {
    report.beside("made", runs.tracker + ": ratio to the oracle, squared", median(runs.ratios(&MeanGospa::squared)), "",
                  how_of(seeds));
  }
  add_table("made", "a made scenario of cars all over the area, which needs no shared data", all, report);
}

}  // namespace boresight::bench::scenarios
