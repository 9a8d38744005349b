// What the ghost filter takes, and how it grows. On one thread, whatever --jobs says.
#include <algorithm>
#include <array>
#include <cmath>

#include "tests/benchmarks/ghosts/bars/bars.hpp"
#include "tests/benchmarks/ghosts/common/load.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"

namespace boresight::bench {

namespace {

struct Size {
  std::size_t radars, detections;
};
constexpr Size kSizes[] = {{2, 300}, {4, 300}, {4, 600}, {8, 600}, {8, 800}};

/// Slope of a straight line through (ln size, ln cost), by least squares.
double exponent(const std::vector<std::pair<double, double>>& points) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const auto& [size, cost] : points) {
    const double a = std::log(size), b = std::log(cost);
    n += 1.0;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// Of one method with a load of one size.
struct Runs {
  GhostCost quickest{};
  double slowest_us = 0.0;
  std::uint64_t allocations = 0;
  void add(const GhostCost& run) {
    if (slowest_us == 0.0 || run.mean_us < quickest.mean_us) quickest = run;
    slowest_us = std::max(slowest_us, run.mean_us);
    allocations += run.allocations;
  }
};
using RunsBySize = std::array<Runs, std::size(kSizes)>;

/// What else runs on the processor adds to what a run takes, for seconds at a time, and never takes away: so the
/// quickest of several tells, with all sizes in each round.
std::vector<RunsBySize> measure(const std::vector<NamedGhostMethod>& methods, std::size_t cycles, std::size_t rounds) {
  std::vector<RunsBySize> all(methods.size());
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      for (std::size_t k = 0; k < std::size(kSizes); ++k) {
        GhostLoad load(kSizes[k].radars, kSizes[k].detections);
        all[m][k].add(measure_ghost_cycles(load, *ghosts::make_method(methods[m].config), cycles));
      }
    }
  }
  return all;
}

}  // namespace

void cost(const Options& options, Report& report) {
  const std::size_t cycles = options.quick ? 20 : 400, rounds = options.quick ? 1 : 5;
  const std::string how = std::to_string(cycles) +
                          " cycles after the map is full, CPU time of one thread, tracks handed over after each scan, "
                          "the quickest of " +
                          std::to_string(rounds) + " runs";
  Table table{"cost", "µs a scan: mean / 99 % / most (points in the map), " + how, {"method"}, {}};
  for (const Size& size : kSizes) {
    table.header.push_back(std::to_string(size.radars) + " × " + std::to_string(size.detections));
  }
  table.header.insert(table.header.end(), {"exponent", "allocations"});
  std::vector<NamedGhostMethod> methods = ghost_methods();
  // Room for the largest load's map, so that none is cheap because it is full. (The published one's is fixed.)
  for (NamedGhostMethod& named : methods) named.config.mirror.map.capacity = 32768;
  const std::vector<RunsBySize> measured = measure(methods, cycles, rounds);
  double published_us = 0.0;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    std::vector<std::string> row = {methods[m].name};
    std::vector<std::pair<double, double>> points;
    std::uint64_t allocations = 0;
    Runs judged{};
    for (std::size_t k = 0; k < std::size(kSizes); ++k) {
      const GhostCost& cost = measured[m][k].quickest;
      row.push_back(fixed(cost.mean_us, 0) + " / " + fixed(cost.p99_us, 0) + " / " + fixed(cost.max_us, 0) + " (" +
                    fixed(cost.map_points, 0) + ")");
      points.emplace_back(static_cast<double>(kSizes[k].radars * kSizes[k].detections), cost.mean_cycle_us);
      allocations += measured[m][k].allocations;
      if (kSizes[k].radars == 4 && kSizes[k].detections == 300) judged = measured[m][k];
    }
    const double growth = exponent(points);
    row.insert(row.end(), {fixed(growth, 2), std::to_string(allocations)});
    table.rows.push_back(std::move(row));
    const double mean_us = judged.quickest.mean_us;
    if (m + 1 < methods.size()) {
      published_us = mean_us;
      continue;
    }
    report.at_most("cost", "four radars × 300 detections, mean", mean_us, 300.0, "µs a scan",
                   "the slowest run " + fixed(judged.slowest_us, 0) + "; " + fixed(judged.quickest.map_points, 0) +
                       " points in the map; " + fixed(mean_us / published_us, 2) +
                       " times the published method's in the same run; " + how);
    report.at_most("cost", "growth to 8 radars × 800: exponent", growth, 1.1, "",
                   "of the cost of a cycle in its size; the map grows with it");
    report.at_most("cost", "allocations", static_cast<double>(allocations), 0.0, "", "in all runs");
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
