// What a real car adds to the model: each effect alone, and all together. Errors at the end of each drive, of all
// radars.
#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/axis_errors.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/alignment/common/real_car_drives.hpp"

namespace boresight::bench {

namespace {

std::string degrees_with_interval(const AxisErrors& axis) {
  const Interval interval = axis.rms_interval();
  return with_interval(axis.rms() / kRadiansPerDegree,
                       {interval.low / kRadiansPerDegree, interval.high / kRadiansPerDegree}) +
         ", " + number(axis.median_size() / kRadiansPerDegree);
}

std::vector<std::string> row_of_kind(const std::string& name, const DriveErrors& errors) {
  std::vector<std::string> row = {name, degrees_with_interval(errors.of(kYaw)),
                                  degrees_with_interval(errors.of(kPitch))};
  for (const int p : {kSpeedScale, kYaw, kPitch, kRoll}) {
    const AxisErrors& axis = errors.of(p);
    row.push_back(axis.count() == 0.0 ? "—" : with_interval(axis.nees(), axis.nees_interval()));
  }
  std::string covered;
  for (const int p : {kSpeedScale, kYaw, kPitch, kRoll}) {
    covered += (covered.empty() ? "" : " / ") + fixed(errors.of(p).covered_percent(), 0);
  }
  row.push_back(covered);
  return row;
}

/// A row for each kind of road.
void add_roads(const std::vector<Run>& runs, Table& table) {
  for (std::size_t road = 0; road < std::min(kRoadsInTurn, runs.size()); ++road) {
    DriveErrors of_road;
    for (std::size_t i = road; i < runs.size(); i += kRoadsInTurn) of_road.add_drive(runs[i].last());
    table.rows.push_back(row_of_kind(std::string("… ") + name_of(road_in_turn(road)), of_road));
  }
}

void judge_kind(const RealCarKind& kind, const DriveErrors& errors, const std::string& drives, Report& report) {
  const auto how = [&](const Interval& interval) {
    return drives + "; 95 % interval " + number(interval.low) + "–" + number(interval.high);
  };
  const auto named = [&](const char* what, int parameter) {
    return std::string(what) + " (" + kParameters[static_cast<std::size_t>(parameter)] + "), " + kind.name;
  };
  const int least_consistent = errors.least_consistent(), least_covered = errors.least_covered();
  report.at_most("real car", named("largest NEES", least_consistent), errors.of(least_consistent).nees(), 3.0, "",
                 how(errors.of(least_consistent).nees_interval()));
  if (kind.covers) {
    report.at_least("real car", named("least coverage", least_covered), errors.of(least_covered).covered_percent(),
                    90.0, "%", how(errors.of(least_covered).covered_interval()));
  }
  if (!kind.is_whole_car) return;
  for (const auto& [parameter, bar_deg] : {std::pair{kYaw, 0.05}, std::pair{kPitch, 0.10}}) {
    const AxisErrors& axis = errors.of(parameter);
    const Interval interval = axis.rms_interval();
    report.at_most("real car", std::string(kParameters[static_cast<std::size_t>(parameter)]) + " rms, " + kind.name,
                   axis.rms() / kRadiansPerDegree, bar_deg, "°",
                   how({interval.low / kRadiansPerDegree, interval.high / kRadiansPerDegree}));
  }
}

}  // namespace

void real_car(const Options& options, Report& report) {
  const double duration_s = options.seconds(180.0);
  const NamedMethod own = own_method(options.method);
  Table table{"real_car",
              "method `" + own_method_name(options.method) +
                  "` at the end of drives with what a real car adds. Rms over drives and radars (95 % interval by "
                  "bootstrap over drives), median of the size. NEES. Share of true values in the 95 % intervals, k_v / "
                  "yaw / pitch / roll. K_v as seen through each radar. Roll where it is reported as observable",
              {"effect", "yaw °", "pitch °", "NEES k_v", "NEES yaw", "NEES pitch", "NEES roll", "covered, %"},
              {}};
  RunOptions run_options;
  run_options.snapshot_period_s = run_options.fine_period_s = duration_s;  // only the last counts
  std::uint64_t seed = first_seed_of(FreshSeeds::kKinds, options);
  for (const RealCarKind& kind : real_car_kinds()) {
    const std::size_t drives = options.seeds(kind.is_whole_car ? 36 : 12);
    const auto runs = run_drives(drives_of(kind, drives, duration_s, seed), own.make, options, run_options);
    DriveErrors errors;
    for (const Run& run : runs) errors.add_drive(run.last());
    table.rows.push_back(row_of_kind(kind.name, errors));
    if (kind.is_whole_car) add_roads(runs, table);
    judge_kind(kind, errors, drives_text(drives, duration_s, seed), report);
    seed += kSeedsOfAKind;
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
