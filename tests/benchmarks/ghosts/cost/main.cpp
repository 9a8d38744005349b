// boresight-bench-ghosts_cost: CPU time of a scan by method and number of detections. See README.md.
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/ghost_filter/weights_file.hpp"
#include "tests/benchmarks/ghosts/common/findings.hpp"
#include "tests/benchmarks/ghosts/common/load.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"

namespace {

using namespace boresight;
using namespace boresight::bench;

constexpr int kError = 1;
constexpr std::size_t kRadars = 4, kJudged = 2, kLargest = 4;  // indices of kSizes
constexpr std::array<std::size_t, 5> kSizes = {100, 200, 300, 400, 800};
using Costs = std::array<GhostCost, kSizes.size()>;

/// Slope of a straight line through (ln detections, ln mean time), by least squares.
double growth(const Costs& costs) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  const auto n = static_cast<double>(kSizes.size());
  for (std::size_t k = 0; k < kSizes.size(); ++k) {
    const double a = std::log(static_cast<double>(kSizes[k])), b = std::log(costs[k].mean_us);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// Other load on the processor only ever lengthens a run, for seconds at a time. So the fastest of several rounds is
/// the estimate, and each round contains all sizes.
std::array<Costs, kMethods.size()> measure(const ghosts::EvidenceWeights& weights, std::size_t cycles,
                                           std::size_t rounds) {
  std::array<Costs, kMethods.size()> all{};
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t m = 0; m < kMethods.size(); ++m) {
      for (std::size_t k = 0; k < kSizes.size(); ++k) {
        GhostLoad load(kRadars, kSizes[k]);
        const GhostCost cost =
            measure_ghost_cycles(load, *ghosts::make_method(config_of(kMethods[m], weights)), cycles);
        GhostCost& best = all[m][k];
        const std::uint64_t allocations = best.allocations + cost.allocations;
        if (round == 0 || cost.mean_us < best.mean_us) best = cost;
        best.allocations = allocations;
      }
    }
  }
  return all;
}

void judge(const Costs& costs, Findings& findings) {
  Table table{"cost_bars", "method evidence", {"figure", "measured", "bar", "result"}, {}};
  const auto add = [&](const std::string& what, double figure, double bar, int digits) {
    table.rows.push_back(
        {what, fixed(figure, digits), text_of(at_most(bar)), findings.judge({figure, figure}, at_most(bar))});
  };
  add(fmt::format("{} radars × {} detections: mean, µs a scan", kRadars, kSizes[kJudged]), costs[kJudged].mean_us,
      100.0, 0);
  add(fmt::format("{} radars × {} detections: 99th percentile, µs a scan", kRadars, kSizes[kJudged]),
      costs[kJudged].p99_us, 300.0, 0);
  add(fmt::format("{} radars × {} detections: mean, µs a scan", kRadars, kSizes[kLargest]), costs[kLargest].mean_us,
      500.0, 0);
  add(fmt::format("growth exponent, {} to {} detections", kSizes.front(), kSizes.back()), growth(costs), 1.2, 2);
  std::uint64_t allocations = 0;
  for (const GhostCost& cost : costs) allocations += cost.allocations;
  add("heap allocations", static_cast<double>(allocations), 0.0, 0);
  findings.add(std::move(table));
}

void run(const std::string& profile, std::size_t cycles, std::size_t rounds, Findings& findings) {
  const auto measured = measure(ghosts::read_weights(std::filesystem::path(profile)), cycles, rounds);
  Table table{
      "cost",
      fmt::format("CPU time of the thread, µs a scan: mean / 99th percentile / maximum (map points); {} radars, "
                  "{} cycles, fastest of {} rounds",
                  kRadars, cycles, rounds),
      {"method"},
      {}};
  for (const std::size_t size : kSizes) table.header.push_back(fmt::format("{} detections", size));
  table.header.emplace_back("growth exponent");
  for (std::size_t m = 0; m < kMethods.size(); ++m) {
    table.rows.push_back({kMethods[m].name});
    for (const GhostCost& cost : measured[m]) {
      table.rows.back().push_back(
          fmt::format("{:.0f} / {:.0f} / {:.0f} ({:.0f})", cost.mean_us, cost.p99_us, cost.max_us, cost.map_points));
    }
    table.rows.back().push_back(fixed(growth(measured[m]), 2));
  }
  findings.add(std::move(table));
  judge(measured.back(), findings);
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t cycles = 400, rounds = 5;
  std::string profile = BORESIGHT_SOURCE_DIR "/config/radar_profiles/series_77ghz.toml", json, markdown;
  CLI::App app("Measures the CPU time of the ghost filter. Exit code 0 also if bars are missed, 1 on an error.");
  app.add_option("--cycles", cycles, "Measured scans of each radar")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--rounds", rounds, "Repetitions")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--profile", profile, "File with the weights of the evidence")->capture_default_str();
  app.add_option("--json", json, "Writes the tables to this file");
  app.add_option("--markdown", markdown, "Writes the tables to this file, between the marks of docs/ghosts.md");
  try {
    app.parse(argc, argv);
    Findings findings;
    run(profile, cycles, rounds, findings);
    findings.finish(json, markdown);
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kError;
  }
}
