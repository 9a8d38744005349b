// All other scenarios: real vehicles stay, ghosts of each type are told to be ghosts.
#include <cmath>

#include "tests/benchmarks/ghosts/bars/bars.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/tables.hpp"
#include "tests/simulator/scenario_file.hpp"

namespace boresight::bench {

namespace {

void judge(const std::string& scenario, const std::vector<Outcome>& outcomes, const std::string& how, Report& report) {
  const Percent moving = percent_told(outcomes, Provenance::kMoving, Provenance::kMoving);
  judge_percent(scenario, "moving told to be moving", moving, 97.0, how, report);
  for (const Provenance type : {Provenance::kGhostType1, Provenance::kGhostType2}) {
    const Percent ghost = percent_told_ghost(outcomes, type);
    // A scenario without ghosts of a type has no figure to judge.
    if (std::isnan(ghost.median)) continue;
    judge_percent(scenario, std::string(name_of(type)) + " told to be a ghost", ghost, 90.0, how, report);
  }
  judge_tracks(scenario, outcomes, true, how, report);
}

}  // namespace

void scenarios(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(20);
  const double duration_s = drive_seconds(options, 20.0);
  const std::string how = std::to_string(seeds) + " seeds of " + fixed(duration_s, 0) + " s";
  const std::vector<NamedGhostMethod> methods = ghost_methods();
  Table table{"scenarios",
              "all scenarios, medians over " + how + ": % of moving told to be moving, % of ghosts told to be ghosts",
              {"scenario", "method", "moving", "stationary", "type 1", "type 2", "clutter not moving",
               "moving left out", "ghost tracks", "other false tracks", "lost object seconds"},
              {}};
  for (const std::string& scenario : simulator::scenario_names()) {
    if (scenario == "highway_multipath") continue;  // has bars of its own
    const auto outcomes = run_ghost_drives(scenario, methods, seeds, duration_s, options);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const std::vector<Outcome>& mine = outcomes[m];
      const TrackFaults faults = track_faults(mine);
      table.rows.push_back({m == 0 ? scenario : "", methods[m].name,
                            fixed(percent_told(mine, Provenance::kMoving, Provenance::kMoving).median, 2),
                            fixed(percent_told(mine, Provenance::kStationary, Provenance::kStationary).median, 2),
                            fixed(percent_told_ghost(mine, Provenance::kGhostType1).median, 2),
                            fixed(percent_told_ghost(mine, Provenance::kGhostType2).median, 2),
                            fixed(percent_not_moving(mine, Provenance::kClutter).median, 2),
                            fixed(percent_left_out(mine, Provenance::kMoving).median, 2),
                            std::to_string(faults.ghost_tracks), std::to_string(faults.other_tracks),
                            std::to_string(faults.lost_seconds)});
      report.add(confusion_table(scenario + "_" + methods[m].name,
                                 scenario + ", " + methods[m].name + ": % of each truth, median over " + how, mine));
    }
    judge(scenario, outcomes.back(), how, report);
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
