// All other scenarios: real vehicles are kept, ghosts of each type are classified as ghosts.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/ghosts/bars/bars.hpp"
#include "tests/benchmarks/ghosts/common/curves.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/tables.hpp"

namespace boresight::bench {

namespace {

/// Scenarios whose confusion matrix is printed.
constexpr std::array<std::string_view, 5> kConfusionPrinted = {"tunnel", "city_canyon", "parking_garage",
                                                               "truck_overtaking", "curve_with_rail"};

void judge(const std::string& scenario, const std::vector<Outcome>& outcomes, const std::string& how, Report& report) {
  const Percent moving = percent_classified(outcomes, Provenance::kMoving, Provenance::kMoving);
  judge_percent(scenario, "moving classified as moving", moving, 97.0, how, report);
  for (const Provenance type : {Provenance::kGhostType1, Provenance::kGhostType2}) {
    const Percent ghost = percent_classified_ghost(outcomes, type);
    // A scenario without ghosts of a type has no figure to judge.
    if (std::isnan(ghost.median)) continue;
    judge_percent(scenario, std::string(name_of(type)) + " classified as ghost", ghost, 90.0, how, report);
    if (type != Provenance::kGhostType1) continue;
    report.beside(scenario, "type 1 more than 0.5 m from its object: classified as ghost",
                  percent_apart_classified_ghost(outcomes).median, "%",
                  how + "; these are " + fixed(percent_apart(outcomes).median, 1) + " % of type 1");
  }
  judge_tracks(scenario, outcomes, true, how, report);
}

void compare(const std::string& scenario, const std::vector<NamedGhostMethod>& methods,
             const std::vector<std::vector<Outcome>>& outcomes, Report& report) {
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto add = [&](const char* what, double percent) {
      add_comparison(scenario, what, methods[m].name, percent, report);
    };
    add("moving → moving", percent_classified(outcomes[m], Provenance::kMoving, Provenance::kMoving).median);
    add("type 1 → ghost", percent_classified_ghost(outcomes[m], Provenance::kGhostType1).median);
    add("type 2 → ghost", percent_classified_ghost(outcomes[m], Provenance::kGhostType2).median);
  }
  add_comparison(scenario, "moving → moving", "bar", 97.0, report);
  add_comparison(scenario, "type 1 → ghost", "bar", 90.0, report);
  add_comparison(scenario, "type 2 → ghost", "bar", 90.0, report);
}

}  // namespace

void scenarios(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(20);
  const double duration_s = drive_seconds(options, 20.0);
  const std::string how = std::to_string(seeds) + " seeds of " + fixed(duration_s, 0) + " s";
  const std::vector<NamedGhostMethod> methods = ghost_methods();
  Table table{
      "scenarios",
      "all scenarios, medians over " + how +
          ". In %: moving and stationary classified correctly; detections classified as moving that are direct echoes "
          "of moving objects; type 1 and type 2 classified as ghost of either type; clutter not classified as moving; "
          "moving rejected by the corrector. Type 1 apart: share of type 1 more than 0.5 m from its object's box, and "
          "of these classified as ghost. Tracks, objects and seconds: sums over the drives. Bars on the mirror method, "
          "radar profile ideal, in brackets.",
      {"scenario", "method", "moving (≥ 97)", "stationary", "truly moving", "type 1 (≥ 90)", "type 1 apart", "of these",
       "type 2 (≥ 90)", "clutter not moving", "moving rejected", "ghost tracks (0)", "other false tracks",
       "objects lost (0)", "object seconds lost (0)"},
      {}};
  std::vector<std::vector<Outcome>> together(methods.size());
  for (const std::string& scenario : simulator::scenario_names()) {
    if (scenario == "highway_multipath") continue;  // has bars of its own
    const auto outcomes = run_ghost_drives(scenario, methods, seeds, duration_s, options);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const std::vector<Outcome>& mine = outcomes[m];
      const TrackFaults faults = track_faults(mine);
      table.rows.push_back({m == 0 ? scenario : "", methods[m].name,
                            fixed(percent_classified(mine, Provenance::kMoving, Provenance::kMoving).median, 2),
                            fixed(percent_classified(mine, Provenance::kStationary, Provenance::kStationary).median, 2),
                            fixed(percent_truly_moving(mine).median, 2),
                            fixed(percent_classified_ghost(mine, Provenance::kGhostType1).median, 2),
                            fixed(percent_apart(mine).median, 1), fixed(percent_apart_classified_ghost(mine).median, 2),
                            fixed(percent_classified_ghost(mine, Provenance::kGhostType2).median, 2),
                            fixed(percent_not_moving(mine, Provenance::kClutter).median, 2),
                            fixed(percent_rejected(mine, Provenance::kMoving).median, 2),
                            std::to_string(faults.ghost_tracks), std::to_string(faults.other_tracks),
                            std::to_string(faults.lost_objects) + " of " + std::to_string(faults.objects),
                            std::to_string(faults.lost_seconds) + " of " + std::to_string(faults.object_seconds)});
      if (std::find(kConfusionPrinted.begin(), kConfusionPrinted.end(), scenario) == kConfusionPrinted.end()) continue;
      report.add(confusion_table(scenario + "_" + methods[m].name,
                                 scenario + ", " + methods[m].name + ": % of each truth, median over " + how, mine));
    }
    judge(scenario, outcomes.back(), how, report);
    compare(scenario, methods, outcomes, report);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      together[m].insert(together[m].end(), outcomes[m].begin(), outcomes[m].end());
    }
  }
  add_reliability("reliability_scenarios", "all other scenarios", how, methods, together, report);
  report.add(std::move(table));
}

}  // namespace boresight::bench
