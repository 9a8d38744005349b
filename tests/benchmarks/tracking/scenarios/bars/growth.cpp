// Growth of the CPU time with the size of a made scenario.
#include <array>

#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/tracking/scenarios/bars/bars.hpp"
#include "tests/benchmarks/tracking/scenarios/common/draw.hpp"
#include "tests/benchmarks/tracking/scenarios/common/made_scenario.hpp"
#include "tests/benchmarks/tracking/scenarios/common/outcome.hpp"

namespace boresight::bench::scenarios {

namespace {

struct Size {
  std::size_t targets, measurements;
};
constexpr std::array kSizes = {Size{3, 50}, Size{6, 100}, Size{12, 200}, Size{21, 350}, Size{30, 500}};

}  // namespace

void growth(const Options& options, Report& report) {
  constexpr double kExponent = 1.2;
  const std::size_t scans = options.quick ? 10 : 60, seeds = options.seeds(4);
  Table table{"growth",
              "CPU time of a scan by the size of a made scenario in the same area; exponent: from the size before",
              {"tracker", "targets", "measurements", "CPU mean ms", "CPU worst ms", "exponent", "lost targets",
               "GOSPA squared", "oracle"},
              {}};
  for (const std::string tracker : kTrackers) {
    std::vector<double> mean_ms;
    Curve curve{"tracking_growth", "", tracker, {}};
    for (std::size_t s = 0; s < kSizes.size(); ++s) {
      const Size& size = kSizes[s];
      Runs runs{"", tracker, {}, {}};
      for (std::size_t i = 0; i < seeds; ++i) {
        const std::uint64_t seed = options.fresh_seed + i;
        const Scenario scenario = make_scenario(size.targets, size.measurements, scans, seed);
        const Measurements drawn = draw_measurements(scenario, seed);
        runs.outcomes.push_back(run_tracker(tracker, scenario, drawn, passes(options, 3)));
        runs.oracle.push_back(run_oracle(scenario, drawn));
      }
      mean_ms.push_back(runs.mean_cpu_ms());
      const auto ratio = [&](std::size_t a, std::size_t b) {
        return static_cast<double>(kSizes[b].measurements) / static_cast<double>(kSizes[a].measurements);
      };
      table.rows.push_back(
          {tracker, std::to_string(size.targets), std::to_string(size.measurements), number(mean_ms.back()),
           number(runs.worst_cpu_ms()), s == 0 ? "—" : fixed(exponent(mean_ms[s - 1], mean_ms[s], ratio(s - 1, s)), 2),
           std::to_string(runs.lost()), fixed(runs.mean().squared, 3), fixed(runs.mean_of_oracle().squared, 3)});
      curve.points.emplace_back(static_cast<double>(size.measurements), mean_ms.back());
      if (s + 1 == kSizes.size()) {
        report.at_most("growth", tracker + ": exponent of the mean CPU time",
                       exponent(mean_ms[0], mean_ms[s], ratio(0, s)), kExponent, "",
                       "from 3 targets and 50 measurements to 30 and 500, " + std::to_string(seeds) + " seeds");
      }
    }
    report.add(std::move(curve));
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench::scenarios
