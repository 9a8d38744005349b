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
  for (const std::string scenario : {"highway_multipath", "truck_overtaking", "curve_with_rail"}) {
    Table table{"ablation_" + scenario,
                scenario + ": the mirror method without one of its ideas, medians over " + std::to_string(seeds) +
                    " seeds of " + fixed(duration_s, 1) + " s, %",
                {"", "moving", "type 1 a ghost", "type 1 right", "type 2 a ghost", "type 2 right", "clutter not moving",
                 "ghost tracks", "lost object seconds"},
                {}};
    for (const Variant& variant : kVariants) {
      ghosts::Config config = ghost_methods().back().config;
      variant.change(config.mirror);
      const std::vector<Outcome> outcomes = run_ghost_drives(scenario, config, seeds, duration_s, options);
      const auto right = [&](Provenance truth) { return fixed(median_percent(outcomes, truth, truth), 2); };
      const TrackFaults faults = track_faults(outcomes);
      table.rows.push_back(
          {variant.name, right(Provenance::kMoving), fixed(median_percent_ghost(outcomes, Provenance::kGhostType1), 2),
           right(Provenance::kGhostType1), fixed(median_percent_ghost(outcomes, Provenance::kGhostType2), 2),
           right(Provenance::kGhostType2),
           fixed(100.0 - median_percent(outcomes, Provenance::kClutter, Provenance::kMoving), 2),
           std::to_string(faults.ghost_tracks), std::to_string(faults.lost_object_seconds)});
    }
    report.add(std::move(table));
    if (options.quick) break;
  }
}

}  // namespace boresight::bench
