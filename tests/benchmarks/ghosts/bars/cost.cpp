// CPU time of the ghost filter and its growth with the number of detections. Always on one thread, whatever --jobs is.
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

/// Repeated runs of one method with a load of one size.
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

/// A row of the table.
struct Series {
  NamedGhostMethod method;
  Surroundings surroundings;
  [[nodiscard]] std::string name() const {
    return method.name + (surroundings == Surroundings::kSame ? "" : ", larger surroundings");
  }
};

std::vector<Series> all_series() {
  std::vector<Series> all;
  for (const Surroundings surroundings : {Surroundings::kSame, Surroundings::kLarger}) {
    for (const NamedGhostMethod& method : ghost_methods()) {
      all.push_back({method, surroundings});
      // Capacity for the largest load's map: a full map would reject points and be cheaper. (The published method's
      // capacity is fixed.)
      all.back().method.config.mirror.map.capacity = 32768;
    }
  }
  return all;
}

/// Other load on the processor only ever lengthens a run, for seconds at a time. So the fastest of several rounds is
/// the estimate, and each round contains all sizes.
std::vector<RunsBySize> measure(const std::vector<Series>& series, std::size_t cycles, std::size_t rounds) {
  std::vector<RunsBySize> all(series.size());
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t s = 0; s < series.size(); ++s) {
      for (std::size_t k = 0; k < std::size(kSizes); ++k) {
        GhostLoad load(kSizes[k].radars, kSizes[k].detections, series[s].surroundings);
        all[s][k].add(measure_ghost_cycles(load, *ghosts::make_method(series[s].method.config), cycles));
      }
    }
  }
  return all;
}

/// Exponent of the growth of a cycle's cost with its number of detections.
double growth_of(const RunsBySize& runs) {
  std::vector<std::pair<double, double>> points;
  for (std::size_t k = 0; k < std::size(kSizes); ++k) {
    points.emplace_back(static_cast<double>(kSizes[k].radars * kSizes[k].detections), runs[k].quickest.mean_cycle_us);
  }
  return exponent(points);
}

std::vector<std::string> row_of(const Series& series, const RunsBySize& runs) {
  std::vector<std::string> row = {series.name()};
  std::uint64_t allocations = 0;
  for (const Runs& run : runs) {
    row.push_back(fixed(run.quickest.mean_us, 0) + " / " + fixed(run.quickest.p99_us, 0) + " / " +
                  fixed(run.quickest.max_us, 0) + " (" + fixed(run.quickest.map_points, 0) + ")");
    allocations += run.allocations;
  }
  row.insert(row.end(), {fixed(growth_of(runs), 2), std::to_string(allocations)});
  return row;
}

void judge(const RunsBySize& runs, const RunsBySize& published, const RunsBySize& larger, const std::string& how,
           Report& report) {
  constexpr std::size_t kJudged = 1;
  static_assert(kSizes[kJudged].radars == 4 && kSizes[kJudged].detections == 300);
  const Runs& judged = runs[kJudged];
  const double mean_us = judged.quickest.mean_us;
  report.at_most("cost", "4 radars × 300 detections: mean", mean_us, 300.0, "µs per scan",
                 "slowest run: " + fixed(judged.slowest_us, 0) + " µs; " + fixed(judged.quickest.map_points, 0) +
                     " map points; " + fixed(mean_us / published[kJudged].quickest.mean_us, 2) +
                     " × the published method in the same run; " + how);
  const auto points = [](const RunsBySize& of) {
    return fixed(of[kJudged].quickest.map_points, 0) + " to " + fixed(of.back().quickest.map_points, 0) + " map points";
  };
  const std::string what = "cost of a cycle ∝ (detections per cycle)^exponent; ";
  report.at_most("cost", "growth exponent, up to 8 radars × 800 detections", growth_of(runs), 1.1, "",
                 what + points(runs));
  report.at_most("cost", "growth exponent with larger surroundings", growth_of(larger), 1.1, "", what + points(larger));
  std::uint64_t allocations = 0;
  for (const RunsBySize* all : {&runs, &larger}) {
    for (const Runs& run : *all) allocations += run.allocations;
  }
  report.at_most("cost", "heap allocations", static_cast<double>(allocations), 0.0, "", "sum over all runs");
}

}  // namespace

void cost(const Options& options, Report& report) {
  const std::size_t cycles = options.quick ? 20 : 400, rounds = options.quick ? 1 : 5;
  const std::string how = std::to_string(cycles) +
                          " cycles with a full map, thread CPU time, tracks handed over after each scan, fastest of " +
                          std::to_string(rounds) + " runs";
  Table table{"cost", "µs per scan: mean / 99th percentile / maximum (map points); " + how, {"method"}, {}};
  for (const Size& size : kSizes) {
    table.header.push_back(std::to_string(size.radars) + " × " + std::to_string(size.detections));
  }
  table.header.insert(table.header.end(), {"growth exponent", "heap allocations"});
  const std::vector<Series> series = all_series();
  const std::vector<RunsBySize> measured = measure(series, cycles, rounds);
  for (std::size_t k = 0; k < series.size(); ++k) table.rows.push_back(row_of(series[k], measured[k]));
  // The product's own method is the last one.
  const std::size_t methods = series.size() / 2;
  judge(measured[methods - 1], measured[0], measured[2 * methods - 1], how, report);
  report.add(std::move(table));
}

}  // namespace boresight::bench
