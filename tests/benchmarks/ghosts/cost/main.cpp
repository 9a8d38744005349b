// boresight-bench-ghosts_cost: time per scan by method, number of radars and number of detections.
#include <chrono>
#include <string>

#include <benchmark/benchmark.h>

#include "tests/benchmarks/common/statistics.hpp"
#include "tests/benchmarks/ghosts/common/load.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"

namespace {

using namespace boresight::bench;

void cycles(benchmark::State& state, const NamedGhostMethod& named, std::size_t radars, std::size_t detections) {
  using Clock = std::chrono::steady_clock;
  GhostLoad load(radars, detections, Surroundings::kSame);
  const auto method = boresight::ghosts::make_method(named.config);
  load.warm_up(*method);
  std::vector<double> each_us;
  for ([[maybe_unused]] auto iteration : state) {
    const auto begin = Clock::now();
    load.give_cycle(*method, [](std::size_t) {});
    const double s = std::chrono::duration<double>(Clock::now() - begin).count();
    state.SetIterationTime(s);
    each_us.push_back(1e6 * s / static_cast<double>(radars));
  }
  state.counters["us/scan"] = median(each_us);
}

}  // namespace

int main(int argc, char** argv) {
  for (const NamedGhostMethod& method : ghost_methods()) {
    for (const auto& [radars, detections] :
         {std::pair<std::size_t, std::size_t>{1, 300}, {4, 300}, {8, 300}, {4, 800}, {8, 800}}) {
      const std::string name =
          method.name + "/" + std::to_string(radars) + "_radars/" + std::to_string(detections) + "_detections";
      benchmark::RegisterBenchmark(
          name.c_str(), [=, r = radars, d = detections](benchmark::State& state) { cycles(state, method, r, d); })
          ->UseManualTime()
          ->Unit(benchmark::kMicrosecond);
    }
  }
  std::puts("us/scan: median time of one scan. One iteration is a cycle: one scan of each radar.");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
