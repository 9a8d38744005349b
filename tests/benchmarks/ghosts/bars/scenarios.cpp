// All other scenarios: real vehicles stay, ghosts of each type are told to be ghosts.
#include "tests/benchmarks/ghosts/bars/bars.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/tables.hpp"
#include "tests/simulator/scenario_file.hpp"

namespace boresight::bench {

void scenarios(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(20);
  const double duration_s = drive_seconds(options, 20.0);
  const std::string how = std::to_string(seeds) + " seeds of " + fixed(duration_s, 0) + " s";
  const std::vector<NamedGhostMethod> methods = ghost_methods();
  Table table{"scenarios",
              "all scenarios, medians over " + how + ": % of moving told to be moving, % of ghosts told to be ghosts",
              {"scenario", "method", "moving", "stationary", "type 1", "type 2", "clutter not moving", "ghost tracks",
               "lost object seconds"},
              {}};
  for (const std::string& scenario : simulator::scenario_names()) {
    if (scenario == "highway_multipath") continue;  // has bars of its own
    for (const NamedGhostMethod& method : methods) {
      const std::vector<Outcome> outcomes = run_ghost_drives(scenario, method.config, seeds, duration_s, options);
      const double moving = median_percent(outcomes, Provenance::kMoving, Provenance::kMoving);
      const double type1 = median_percent_ghost(outcomes, Provenance::kGhostType1);
      const double type2 = median_percent_ghost(outcomes, Provenance::kGhostType2);
      const TrackFaults faults = track_faults(outcomes);
      table.rows.push_back({scenario, method.name, fixed(moving, 2),
                            fixed(median_percent(outcomes, Provenance::kStationary, Provenance::kStationary), 2),
                            fixed(type1, 2), fixed(type2, 2),
                            fixed(100.0 - median_percent(outcomes, Provenance::kClutter, Provenance::kMoving), 2),
                            std::to_string(faults.ghost_tracks), std::to_string(faults.lost_object_seconds)});
      if (&method != &methods.back()) continue;
      report.at_least(scenario, "moving told to be moving", moving, 97.0, "%", how);
      // A scenario without ghosts of a type has no figure to judge.
      if (type1 == type1) report.at_least(scenario, "type 1 told to be a ghost", type1, 90.0, "%", how);
      if (type2 == type2) report.at_least(scenario, "type 2 told to be a ghost", type2, 90.0, "%", how);
      judge_tracks(scenario, outcomes, true, how, report);
    }
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
