// False changes: hours of independent drives of a real car on which no mounting and no load changes.
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/changes.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/alignment/common/real_car_drives.hpp"

namespace boresight::bench {

void real_car_no_change(const Options& options, Report& report) {
  constexpr double kJudged_h = 20.0;
  const std::size_t drives = options.seeds(400);
  const double duration_s = options.seconds(180.0);
  const double hours = static_cast<double>(drives) * duration_s / 3600.0;
  const std::uint64_t seed = first_seed_of(FreshSeeds::kNoChange, options);
  const NamedMethod own = own_method(options.method);
  std::vector<std::size_t> changes(drives), loads(drives);
  parallel_for(drives, options.jobs, [&](std::size_t i) {
    LoadReports of_load;
    RunOptions run_options;
    run_options.false_changes = true;
    run_options.snapshot_period_s = run_options.fine_period_s = duration_s;
    run_options.look = [&](const alignment::Method& method, double time_s) { of_load.look(method, time_s); };
    changes[i] =
        run_drive(real_car_drive(road_in_turn(i), duration_s, seed + i), own.make, run_options).step_changes.size();
    loads[i] = of_load.count();
  });
  Table table{"real_car_no_change",
              "method `" + own_method_name(options.method) + "`, real_car without any change, " +
                  drives_text(drives, duration_s, seed) +
                  ": false reports and their number per hour (95 % interval, Poisson)",
              {"road", "hours", "sudden changes", "per hour", "drives with one", "load changes", "per hour"},
              {}};
  const auto add_row = [&](const std::string& name, std::size_t first, std::size_t step) {
    std::size_t count = 0, load_count = 0, with_one = 0, all = 0;
    for (std::size_t i = first; i < drives; i += step) {
      ++all;
      count += changes[i];
      load_count += loads[i];
      with_one += changes[i] > 0 ? 1 : 0;
    }
    if (all == 0) return;
    const double of_road_h = static_cast<double>(all) * duration_s / 3600.0;
    const auto per_hour = [&](std::size_t n) {
      const Interval interval = poisson_interval(n);
      return with_interval(static_cast<double>(n) / of_road_h, {interval.low / of_road_h, interval.high / of_road_h});
    };
    table.rows.push_back({name, fixed(of_road_h, 1), std::to_string(count), per_hour(count), std::to_string(with_one),
                          std::to_string(load_count), per_hour(load_count)});
  };
  for (std::size_t i = 0; i < kRoadsInTurn; ++i) add_row(name_of(road_in_turn(i)), i, kRoadsInTurn);
  add_row("**all**", 0, 1);
  report.add(std::move(table));
  std::size_t count = 0;
  for (const std::size_t of_drive : changes) count += of_drive;
  const double per_judged = kJudged_h / hours;
  const Interval interval = poisson_interval(count);
  report.at_most("false changes", "sudden changes reported in " + fixed(kJudged_h, 0) + " h, real_car",
                 static_cast<double>(count) * per_judged, 1.0, "",
                 std::to_string(count) + " in " + fixed(hours, 1) + " h, " + drives_text(drives, duration_s, seed) +
                     "; 95 % interval " + number(interval.low * per_judged) + "–" + number(interval.high * per_judged));
}

}  // namespace boresight::bench
