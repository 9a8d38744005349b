// What each idea of the product's own method buys: the method without it, on the same drives.
#include <cmath>

#include "tests/benchmarks/ghosts/bars/bars.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/tables.hpp"

namespace boresight::bench {

namespace {

/// Densities beside which all others are nothing, and the other way round.
constexpr double kNever = 1e-15, kAlways = 1e3;

struct Variant {
  const char* name;
  void (*change)(NamedGhostMethod&);
};
/// Each switches one idea off and leaves the rest as it is.
constexpr Variant kVariants[] = {
    {"as it is", [](NamedGhostMethod&) {}},
    {"what stands still by a constant of 2 m/s", [](NamedGhostMethod& m) { m.change.stationary_below_mps = 2.0; }},
    {"without tracks", [](NamedGhostMethod& m) { m.change.gets_tracks = false; }},
    {"the tracker gets labels, not probabilities", [](NamedGhostMethod& m) { m.change.tells_probabilities = false; }},
    {"reflectors of 0.1 s instead of accumulated ones",
     [](NamedGhostMethod& m) { m.config.mirror.map.memory_s = 0.1; }},
    {"no reflector with a radius under 1 km",
     [](NamedGhostMethod& m) { m.config.mirror.map.max_curvature_per_m = 1e-3; }},
    {"reflectors without openings", [](NamedGhostMethod& m) { m.config.mirror.map.bin_m = 200.0; }},
    {"vehicles are no mirrors", [](NamedGhostMethod& m) { m.config.mirror.classes.min_mirror_length_m = 1e9; }},
    {"every reflector mirrors", [](NamedGhostMethod& m) { m.config.mirror.classes.mirror_doubt = 0.0; }},
    {"type 2: to be behind a reflector is proof",
     [](NamedGhostMethod& m) { m.config.mirror.classes.lone_ghost_density = kAlways; }},
    {"type 2: only of objects that are seen",
     [](NamedGhostMethod& m) { m.config.mirror.classes.lone_ghost_density = kNever; }},
    {"type 1: to be behind an object is proof",
     [](NamedGhostMethod& m) { m.config.mirror.classes.hidden_ghost_density = kAlways; }},
    {"type 1: by path lengths only",
     [](NamedGhostMethod& m) { m.config.mirror.classes.hidden_ghost_density = kNever; }},
    {"type 1: of tracks that were not heard, too",
     [](NamedGhostMethod& m) { m.config.mirror.classes.type1_unheard = 1.0; }},
    {"type 1: not by path lengths", [](NamedGhostMethod& m) { m.config.mirror.classes.type1_per_object = kNever; }},
    {"no images of the stationary world",
     [](NamedGhostMethod& m) { m.config.mirror.classes.stationary_image_density = kNever; }},
    {"strength (RCS) tells nothing", [](NamedGhostMethod& m) { m.config.mirror.classes.strength_doubt = 1.0; }},
    {"radars that measure no RCS", [](NamedGhostMethod& m) { m.change.gets_rcs = false; }},
    {"no wheels and limbs of other range rates",
     [](NamedGhostMethod& m) { m.config.mirror.classes.wheel_share = 0.0; }},
    {"confirmed tracks only", [](NamedGhostMethod& m) { m.config.mirror.classes.tentative_weight = 0.0; }},
    {"what is seen now and then is forgotten in between",
     [](NamedGhostMethod& m) { m.config.mirror.classes.sighting_s = 0.0; }},
    {"no class for clutter", [](NamedGhostMethod& m) { m.config.mirror.classes.clutter_density = kNever; }},
};

constexpr const char* kScenarios[] = {"highway_multipath", "tunnel",           "city_canyon",
                                      "parking_garage",    "truck_overtaking", "curve_with_rail"};

struct Figures {
  double moving, type1, type2;
};

Figures figures_of(const std::vector<Outcome>& outcomes) {
  return {percent_told(outcomes, Provenance::kMoving, Provenance::kMoving).median,
          percent_told_ghost(outcomes, Provenance::kGhostType1).median,
          percent_told_ghost(outcomes, Provenance::kGhostType2).median};
}

/// With its sign; nothing where there is nothing to tell.
std::string change(double from, double to) {
  const double by = to - from;
  if (std::isnan(by)) return "—";
  return std::abs(by) < 0.05 ? "0" : (by > 0.0 ? "+" : "−") + fixed(std::abs(by), 1);
}

}  // namespace

void ablation(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(3);
  const double duration_s = drive_seconds(options, 8.0);
  const std::string how = std::to_string(seeds) + " seeds of " + fixed(duration_s, 1) + " s";
  std::vector<NamedGhostMethod> variants;
  Table table{
      "ablation",
      "the mirror method without one of its ideas, medians over " + how +
          ": moving told to be moving / type 1 told to be a ghost / type 2 told to be a ghost, %, and by how many "
          "points that changes; last columns: of clutter in highway_multipath, % told to be moving; and sums over "
          "these "
          "scenarios",
      {"", "clutter moving, %", "ghost tracks", "other false tracks", "lost object seconds"},
      {}};
  std::vector<TrackFaults> faults;
  std::vector<double> clutter;
  for (const Variant& variant : kVariants) {
    variants.push_back(ghost_methods().back());
    variant.change(variants.back());
    table.rows.push_back({variant.name});
    faults.emplace_back();
  }
  std::size_t column = 1;
  for (const char* scenario : kScenarios) {
    const auto outcomes = run_ghost_drives(scenario, variants, seeds, duration_s, options);
    table.header.insert(table.header.begin() + static_cast<std::ptrdiff_t>(column++), scenario);
    const Figures whole = figures_of(outcomes.front());
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const Figures f = figures_of(outcomes[v]);
      table.rows[v].push_back(v == 0 ? fixed(f.moving, 1) + " / " + fixed(f.type1, 1) + " / " + fixed(f.type2, 1)
                                     : change(whole.moving, f.moving) + " / " + change(whole.type1, f.type1) + " / " +
                                           change(whole.type2, f.type2));
      faults[v] += track_faults(outcomes[v]);
      if (column == 2) clutter.push_back(100.0 - percent_not_moving(outcomes[v], Provenance::kClutter).median);
    }
    if (options.quick) break;
  }
  for (std::size_t v = 0; v < variants.size(); ++v) {
    table.rows[v].insert(table.rows[v].end(),
                         {fixed(clutter[v], 1), std::to_string(faults[v].ghost_tracks),
                          std::to_string(faults[v].other_tracks), std::to_string(faults[v].lost_seconds)});
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
