// Computing time and heap allocations of the methods. Always on one thread; --jobs has no effect.
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/load.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

void cost(const Options& options, Report& report) {
  const std::size_t cycles = options.quick ? 50 : 2000;
  const double load_s = options.seconds(30.0);
  Table methods{"cost",
                "four radars × 60 detections: µs per cycle of four scans, ns per detection (medians of " +
                    std::to_string(cycles) + " cycles after warm-up), heap allocations",
                {"method", "µs / cycle", "ns / detection", "allocations"},
                {}};
  std::vector<NamedMethod> all = published_methods();
  all.push_back(own_method());
  for (const NamedMethod& named : all) {
    Load load(4, 60.0, load_s);
    const auto method = named.make(load.vehicle());
    const CycleCost cost = measure_cycles(load, *method, cycles);
    methods.rows.push_back(
        {named.name, fixed(cost.us_per_cycle, 1), fixed(cost.ns_per_detection, 0), std::to_string(cost.allocations)});
    if (named.name != own_method().name) continue;
    const std::string how =
        "median of " + std::to_string(cycles) + " cycles after " + fixed(load_s, 0) + " s of driving, one thread";
    report.at_most("cost", "four radars × 60 detections", cost.us_per_cycle, 150.0, "µs", how);
    report.at_most("cost", "allocations", static_cast<double>(cost.allocations), 0.0, "", how);
  }
  report.add(std::move(methods));

  Table growth{"cost_growth",
               "method `boresight`: µs per cycle of all radars (ns per detection)",
               {"radars", "60 detections per scan", "300 detections per scan"},
               {}};
  for (const std::size_t radars : {1u, 4u, 8u, 16u}) {
    std::vector<std::string> row = {std::to_string(radars)};
    for (const double detections : {60.0, 300.0}) {
      Load load(radars, detections, options.seconds(15.0));
      const auto method = own_method().make(load.vehicle());
      const CycleCost cost = measure_cycles(load, *method, cycles / 4);
      row.push_back(fixed(cost.us_per_cycle, 1) + " (" + fixed(cost.ns_per_detection, 0) + ")");
    }
    growth.rows.push_back(row);
  }
  report.add(std::move(growth));
}

}  // namespace boresight::bench
