// Ablation of the mirror method: the same drives with one part of the method switched off at a time.
#include <cmath>

#include "tests/benchmarks/ghosts/bars/bars.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/tables.hpp"

namespace boresight::bench {

namespace {

/// Expected densities of detections: negligible beside all other origins, and larger than all other origins.
constexpr double kNegligibleDensity = 1e-15, kDominantDensity = 1e3;

struct Variant {
  const char* name;
  void (*change)(NamedGhostMethod&);
};
/// Each variant switches one part off and leaves the rest unchanged.
constexpr Variant kVariants[] = {
    {"complete method", [](NamedGhostMethod&) {}},
    {"stationary: fixed threshold of 2 m/s", [](NamedGhostMethod& m) { m.change.stationary_below_mps = 2.0; }},
    {"no tracks from the tracker", [](NamedGhostMethod& m) { m.change.gets_tracks = false; }},
    {"tracker receives labels instead of probabilities",
     [](NamedGhostMethod& m) { m.change.passes_probabilities = false; }},
    {"reflector map: 0.1 s of memory instead of 1 s", [](NamedGhostMethod& m) { m.config.mirror.map.memory_s = 0.1; }},
    {"reflectors: no radius of curvature below 1 km",
     [](NamedGhostMethod& m) { m.config.mirror.map.max_curvature_per_m = 1e-3; }},
    {"reflectors: no openings along them", [](NamedGhostMethod& m) { m.config.mirror.map.bin_m = 200.0; }},
    {"vehicle sides are no mirrors", [](NamedGhostMethod& m) { m.config.mirror.classes.min_mirror_length_m = 1e9; }},
    {"every reflector counts as a mirror", [](NamedGhostMethod& m) { m.config.mirror.classes.mirror_doubt = 0.0; }},
    {"type 2: any moving detection behind a reflector",
     [](NamedGhostMethod& m) { m.config.mirror.classes.lone_ghost_density = kDominantDensity; }},
    {"type 2: only of objects that are detected directly",
     [](NamedGhostMethod& m) { m.config.mirror.classes.lone_ghost_density = kNegligibleDensity; }},
    {"type 1: any moving detection behind an object",
     [](NamedGhostMethod& m) { m.config.mirror.classes.hidden_ghost_density = kDominantDensity; }},
    {"type 1: only over known reflectors",
     [](NamedGhostMethod& m) { m.config.mirror.classes.hidden_ghost_density = kNegligibleDensity; }},
    {"type 1: also of tracks without a direct echo in the scan",
     [](NamedGhostMethod& m) { m.config.mirror.classes.type1_unheard = 1.0; }},
    {"type 1: not over known reflectors",
     [](NamedGhostMethod& m) { m.config.mirror.classes.type1_per_object = kNegligibleDensity; }},
    {"no mirror images of stationary objects",
     [](NamedGhostMethod& m) { m.config.mirror.classes.stationary_image_density = kNegligibleDensity; }},
    {"echo strength (RCS) ignored by the method",
     [](NamedGhostMethod& m) { m.config.mirror.classes.strength_doubt = 1.0; }},
    {"radars without RCS measurement", [](NamedGhostMethod& m) { m.change.gets_rcs = false; }},
    {"no micro-Doppler echoes of vehicles and pedestrians",
     [](NamedGhostMethod& m) { m.config.mirror.classes.wheel_share = 0.0; }},
    {"tentative tracks ignored", [](NamedGhostMethod& m) { m.config.mirror.classes.tentative_weight = 0.0; }},
    {"no memory of sporadic detections", [](NamedGhostMethod& m) { m.config.mirror.classes.sighting_s = 0.0; }},
    {"no clutter class", [](NamedGhostMethod& m) { m.config.mirror.classes.clutter_density = kNegligibleDensity; }},
};

constexpr const char* kScenarios[] = {"highway_multipath", "tunnel",           "city_canyon",
                                      "parking_garage",    "truck_overtaking", "curve_with_rail"};

struct Figures {
  double moving, type1, type2;
};

Figures figures_of(const std::vector<Outcome>& outcomes) {
  return {percent_classified(outcomes, Provenance::kMoving, Provenance::kMoving).median,
          percent_classified_ghost(outcomes, Provenance::kGhostType1).median,
          percent_classified_ghost(outcomes, Provenance::kGhostType2).median};
}

/// With its sign; a dash where the percentage is undefined.
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
      "mirror method with one part switched off, medians over " + how +
          ": moving classified as moving / type 1 as ghost / type 2 as ghost. First row in %, other rows in "
          "percentage points of change. Clutter: % classified as moving in highway_multipath. Last three columns: "
          "sums over these scenarios.",
      {"switched off", "clutter as moving", "ghost tracks", "other false tracks", "object seconds lost"},
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
