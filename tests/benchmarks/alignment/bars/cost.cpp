// Computing time and heap allocations of the methods. Always on one thread; --jobs has no effect. Means and longest
// calls are CPU time of the thread, so that other programs on the machine matter little.
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/load.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/common/intervals.hpp"

namespace boresight::bench {

namespace {

/// Figures of several runs with four radars × 60 detections, for their medians and ranges.
void judge_cost(const NamedMethod& own, const Options& options, std::size_t cycles, double load_s, Report& report) {
  const std::size_t runs = options.quick ? 2 : 5;
  std::vector<double> means_us, longest_ms, fastest_ms;
  for (std::size_t run = 0; run < runs; ++run) {
    Load load(4, 60.0, load_s);
    const auto method = own.make(load.vehicle());
    means_us.push_back(measure_cycles(load, *method, cycles).mean_us);
    const std::vector<double> calls_ms = call_times_ms(load, *method, cycles);
    longest_ms.push_back(quantile(calls_ms, 1.0));
    // All runs do the same work, so what differs between them is the machine's.
    if (fastest_ms.empty()) fastest_ms = calls_ms;
    for (std::size_t i = 0; i < calls_ms.size(); ++i) fastest_ms[i] = std::min(fastest_ms[i], calls_ms[i]);
  }
  const auto how = [&](const std::vector<double>& values) {
    return "median of " + std::to_string(runs) + " runs of " + std::to_string(cycles) + " cycles after " +
           fixed(load_s, 0) + " s of driving, CPU time; " + number(quantile(values, 0.0)) + "–" +
           number(quantile(values, 1.0));
  };
  report.at_most("cost", "four radars × 60 detections, mean", median(means_us), 150.0, "µs", how(means_us));
  report.at_most("cost", "longest call of process()", median(longest_ms), 1.0, "ms", how(longest_ms));
  report.beside("cost", "longest call of process(), each at its fastest", quantile(fastest_ms, 1.0), "ms",
                "largest over calls of the smallest over " + std::to_string(runs) + " runs that do the same");
}

void judge_growth(const NamedMethod& own, const Options& options, std::size_t cycles, Report& report) {
  constexpr double kDetections[] = {60.0, 300.0, 1000.0};
  constexpr std::size_t kRadars[] = {1, 4, 8, 16};
  Table growth{"cost_growth",
               "method `" + own_method_name(options.method) +
                   "`: mean µs per cycle of all radars (ns per detection); exponent of the growth from 1 to 16 radars",
               {"radars", "60 detections per scan", "300 detections per scan", "1000 detections per scan"},
               {}};
  for (const std::size_t radars : kRadars) growth.rows.push_back({std::to_string(radars)});
  growth.rows.push_back({"exponent"});
  for (const double detections : kDetections) {
    // Scans in memory: fewer seconds of the large ones.
    const double load_s = options.quick ? 2.0 : detections > 500.0 ? 5.0 : 15.0;
    std::vector<double> means_us;
    for (std::size_t i = 0; i < std::size(kRadars); ++i) {
      Load load(kRadars[i], detections, load_s);
      const auto method = own.make(load.vehicle());
      const CycleCost cost = measure_cycles(load, *method, cycles);
      means_us.push_back(cost.mean_us);
      growth.rows[i].push_back(fixed(cost.mean_us, 1) + " (" + fixed(cost.ns_per_detection, 0) + ")");
    }
    const double power = exponent(means_us.front(), means_us.back(), 16.0);
    growth.rows.back().push_back(fixed(power, 2));
    report.at_most("cost", "exponent from 1 to 16 radars, " + number(detections) + " detections", power, 1.1, "",
                   "mean of " + std::to_string(cycles) + " cycles each, CPU time");
  }
  report.add(std::move(growth));
}

}  // namespace

void cost(const Options& options, Report& report) {
  const std::size_t cycles = options.quick ? 50 : 2000;
  const double load_s = options.seconds(30.0);
  Table methods{"cost",
                "four radars × 60 detections: µs per cycle of four scans, median and mean; ns per detection, median; "
                "longest call of process(); heap allocations. " +
                    std::to_string(cycles) + " cycles after warm-up",
                {"method", "µs / cycle", "mean", "ns / detection", "longest call, ms", "allocations"},
                {}};
  std::vector<NamedMethod> all = published_methods();
  const NamedMethod own = own_method(options.method);
  all.push_back(own);
  for (const NamedMethod& named : all) {
    Load load(4, 60.0, load_s);
    const auto method = named.make(load.vehicle());
    const CycleCost cost = measure_cycles(load, *method, cycles);
    methods.rows.push_back(
        {named.name, fixed(cost.us_per_cycle, 1), fixed(cost.mean_us, 1), fixed(cost.ns_per_detection, 0),
         fixed(quantile(call_times_ms(load, *method, cycles), 1.0), 2), std::to_string(cost.allocations)});
    if (&named != &all.back()) continue;
    const std::string how =
        "median of " + std::to_string(cycles) + " cycles after " + fixed(load_s, 0) + " s of driving, one thread";
    report.at_most("cost", "four radars × 60 detections", cost.us_per_cycle, 150.0, "µs", how);
    report.at_most("cost", "allocations", static_cast<double>(cost.allocations), 0.0, "", how);
  }
  report.add(std::move(methods));
  judge_cost(own, options, cycles, load_s, report);
  judge_growth(own, options, cycles, report);
}

}  // namespace boresight::bench
