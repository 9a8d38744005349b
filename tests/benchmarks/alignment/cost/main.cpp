// boresight-bench-alignment_cost: computing time per cycle of all radars' scans. The product's own estimator by number
// of radars and detections; every method with four radars of 60 detections.
#include <chrono>

#include <benchmark/benchmark.h>

#include "tests/benchmarks/alignment/common/load.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/common/statistics.hpp"

namespace {

using namespace boresight::bench;

void cycles(benchmark::State& state, const NamedMethod& named, std::size_t radars, double detections) {
  using Clock = std::chrono::steady_clock;
  Load load(radars, detections, detections > 500.0 ? 5.0 : 20.0);  // scans in memory: fewer of the large ones
  const auto method = named.make(load.vehicle());
  load.warm_up(*method);
  std::vector<double> each_us, each_ns;
  for ([[maybe_unused]] auto iteration : state) {
    const auto begin = Clock::now();
    const std::size_t given = load.give_cycle(*method);
    const double s = std::chrono::duration<double>(Clock::now() - begin).count();
    state.SetIterationTime(s);
    each_us.push_back(1e6 * s);
    each_ns.push_back(1e9 * s / static_cast<double>(given));
  }
  state.counters["us/cycle"] = median(each_us);
  state.counters["ns/detection"] = median(each_ns);
}

void add(const std::string& name, const NamedMethod& method, std::size_t radars, double detections) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) { cycles(state, method, radars, detections); })
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::size_t radars : {1u, 4u, 8u, 16u}) {
    for (const int detections : {60, 300, 1000}) {
      add("own/" + std::to_string(radars) + "_radars/" + std::to_string(detections) + "_detections", own_method(),
          radars, detections);
    }
  }
  for (const NamedMethod& method : published_methods()) add("published/" + method.name + "/4_radars", method, 4, 60.0);
  std::puts("us/cycle, ns/detection: medians; a cycle is one scan of each radar");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
