// What each idea of the product's own method buys: the method without it, on the same drives.
#include "tests/benchmarks/ghosts/bars/bars.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/tables.hpp"

namespace boresight::bench {

namespace {

/// So rare that it is never the explanation.
constexpr double kNever = 1e-15;

struct Variant {
  const char* name;
  void (*change)(ghosts::MirrorConfig&);
};
constexpr Variant kVariants[] = {
    {"as it is", [](ghosts::MirrorConfig&) {}},
    {"without memory of reflectors", [](ghosts::MirrorConfig& c) { c.map.memory_s = 0.1; }},
    {"without arcs", [](ghosts::MirrorConfig& c) { c.map.max_curvature_per_m = 1e-4; }},
    {"without openings along reflectors", [](ghosts::MirrorConfig& c) { c.map.max_gap_m = 50.0; }},
    {"without vehicles as mirrors", [](ghosts::MirrorConfig& c) { c.classes.min_mirror_length_m = 1e9; }},
    {"without ghosts of objects not seen", [](ghosts::MirrorConfig& c) { c.classes.lone_ghost_density = kNever; }},
    {"without path lengths of type 1", [](ghosts::MirrorConfig& c) { c.classes.type1_per_object = kNever; }},
    {"without type 1 by unknown reflectors", [](ghosts::MirrorConfig& c) { c.classes.hidden_ghost_density = kNever; }},
    {"without images of the stationary world",
     [](ghosts::MirrorConfig& c) { c.classes.stationary_image_density = kNever; }},
    {"without clutter", [](ghosts::MirrorConfig& c) { c.classes.clutter_density = kNever; }},
};

}  // namespace

void ablation(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(5);
  const double duration_s = drive_seconds(options, 11.4);
  std::vector<NamedGhostMethod> methods;
  for (const Variant& variant : kVariants) {
    methods.push_back(ghost_methods().back());
    variant.change(methods.back().config.mirror);
  }
  for (const std::string scenario : {"highway_multipath", "truck_overtaking", "curve_with_rail"}) {
    Table table{"ablation_" + scenario,
                scenario + ": the mirror method without one of its ideas, medians over " + std::to_string(seeds) +
                    " seeds of " + fixed(duration_s, 1) + " s, %",
                {"", "moving", "type 1 a ghost", "type 1 right", "type 2 a ghost", "type 2 right", "clutter not moving",
                 "ghost tracks", "lost object seconds"},
                {}};
    const auto outcomes = run_ghost_drives(scenario, methods, seeds, duration_s, options);
    for (std::size_t v = 0; v < methods.size(); ++v) {
      const std::vector<Outcome>& mine = outcomes[v];
      const auto right = [&](Provenance truth) { return fixed(percent_told(mine, truth, truth).median, 2); };
      const auto ghost = [&](Provenance truth) { return fixed(percent_told_ghost(mine, truth).median, 2); };
      const TrackFaults faults = track_faults(mine);
      table.rows.push_back({kVariants[v].name, right(Provenance::kMoving), ghost(Provenance::kGhostType1),
                            right(Provenance::kGhostType1), ghost(Provenance::kGhostType2),
                            right(Provenance::kGhostType2),
                            fixed(percent_not_moving(mine, Provenance::kClutter).median, 2),
                            std::to_string(faults.ghost_tracks), std::to_string(faults.lost_seconds)});
    }
    report.add(std::move(table));
    if (options.quick) break;
  }
}

}  // namespace boresight::bench
