// What the ghost filter takes, and how it grows. On one thread, whatever --jobs says.
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

}  // namespace

void cost(const Options& options, Report& report) {
  const std::size_t cycles = options.quick ? 20 : 400;
  const std::string how = std::to_string(cycles) +
                          " cycles after the map is full, CPU time of one thread, tracks handed over after each scan";
  Table table{"cost", "µs a scan: mean / 99 % / most (points in the map), " + how, {"method"}, {}};
  for (const Size& size : kSizes) {
    table.header.push_back(std::to_string(size.radars) + " × " + std::to_string(size.detections));
  }
  table.header.insert(table.header.end(), {"exponent", "allocations"});
  std::vector<NamedGhostMethod> methods = ghost_methods();
  double published_us = 0.0;
  for (NamedGhostMethod& named : methods) {
    // Room for the largest load's map, so that none is cheap because it is full. (The published one's is fixed.)
    named.config.mirror.map.capacity = 32768;
    std::vector<std::string> row = {named.name};
    std::vector<std::pair<double, double>> points;
    std::uint64_t allocations = 0;
    GhostCost judged{};
    for (const Size& size : kSizes) {
      GhostLoad load(size.radars, size.detections);
      const auto method = ghosts::make_method(named.config);
      const GhostCost cost = measure_ghost_cycles(load, *method, cycles);
      row.push_back(fixed(cost.mean_us, 0) + " / " + fixed(cost.p99_us, 0) + " / " + fixed(cost.max_us, 0) + " (" +
                    fixed(cost.map_points, 0) + ")");
      points.emplace_back(static_cast<double>(size.radars * size.detections), cost.mean_cycle_us);
      allocations += cost.allocations;
      if (size.radars == 4 && size.detections == 300) judged = cost;
    }
    const double growth = exponent(points);
    row.insert(row.end(), {fixed(growth, 2), std::to_string(allocations)});
    table.rows.push_back(std::move(row));
    if (&named != &methods.back()) {
      published_us = judged.mean_us;
      continue;
    }
    report.at_most("cost", "four radars × 300 detections, mean", judged.mean_us, 300.0, "µs a scan",
                   fixed(judged.map_points, 0) + " points in the map; " + fixed(judged.mean_us / published_us, 2) +
                       " times the published method's in the same run; " + how);
    report.at_most("cost", "growth to 8 radars × 800: exponent", growth, 1.1, "",
                   "of the cost of a cycle in its size; the map grows with it");
    report.at_most("cost", "allocations", static_cast<double>(allocations), 0.0, "", how);
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
