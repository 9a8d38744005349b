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
  const std::string how = "median of " + std::to_string(cycles) + " cycles after the map is full, one thread";
  Table table{"cost", "µs a scan (µs a cycle of all radars), " + how, {"method"}, {}};
  for (const Size& size : kSizes) {
    table.header.push_back(std::to_string(size.radars) + " × " + std::to_string(size.detections));
  }
  table.header.insert(table.header.end(), {"exponent", "allocations"});
  const std::vector<NamedGhostMethod> methods = ghost_methods();
  for (const NamedGhostMethod& named : methods) {
    std::vector<std::string> row = {named.name};
    std::vector<std::pair<double, double>> points;
    std::uint64_t allocations = 0;
    double four_radars_us = 0.0;
    for (const Size& size : kSizes) {
      GhostLoad load(size.radars, size.detections);
      const auto method = ghosts::make_method(named.config);
      const GhostCost cost = measure_ghost_cycles(load, *method, cycles);
      row.push_back(fixed(cost.us_per_scan, 0) + " (" + fixed(cost.us_per_cycle, 0) + ")");
      points.emplace_back(static_cast<double>(size.radars * size.detections), cost.us_per_cycle);
      allocations += cost.allocations;
      if (size.radars == 4 && size.detections == 300) four_radars_us = cost.us_per_scan;
    }
    const double growth = exponent(points);
    row.insert(row.end(), {fixed(growth, 2), std::to_string(allocations)});
    table.rows.push_back(std::move(row));
    if (&named != &methods.back()) continue;
    report.at_most("cost", "four radars × 300 detections", four_radars_us, 300.0, "µs a scan", how);
    report.at_most("cost", "growth to 8 radars × 800: exponent", growth, 1.1, "", "of the cost of a cycle in its size");
    report.at_most("cost", "allocations", static_cast<double>(allocations), 0.0, "", how);
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
