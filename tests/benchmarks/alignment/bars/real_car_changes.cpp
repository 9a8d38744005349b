// True changes of one radar's mounting on a real car, at a random time: delay, whether the right radar is named, and
// whether the stated std covers the error 20 s later.
#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/axis_errors.hpp"
#include "tests/benchmarks/alignment/common/changes.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/alignment/common/real_car_drives.hpp"

namespace boresight::bench {

namespace {

constexpr double kAfterChange_s = 20.0;  // when the std is judged
constexpr double kInTime_s = 10.0;

struct RealCarChange {
  const char* name;
  int parameter;
  Eigen::Vector3d rotation_deg;
  double bar_s;
};
const RealCarChange kRealCarChanges[] = {{"1° yaw", kYaw, {0.0, 0.0, 1.0}, 5.0},
                                         {"2° pitch", kPitch, {0.0, 2.0, 0.0}, 6.0}};

/// The radars that change, in turn: the four at the corners, then one that looks ahead in place of the first.
constexpr std::size_t kPlaces = 5;
constexpr std::size_t kAheadPlace = 4;
constexpr const char* kPlaceNames[kPlaces] = {"front left", "front right", "rear left", "rear right", "ahead"};

struct ChangeDrive {
  simulator::AlignmentSpec spec;
  std::size_t radar, place;
  double change_s;
};

ChangeDrive change_drive(const RealCarChange& change, std::size_t i, std::uint64_t seed, bool is_quick) {
  const std::size_t place = i % kPlaces;
  const double change_s = is_quick ? 6.0 : draw_change_s(seed);
  ChangeDrive drive{real_car_drive(road_in_turn(i), change_s + (is_quick ? 6.0 : kAfterChange_s + 10.0), seed),
                    place == kAheadPlace ? 0 : place, place, change_s};
  if (place == kAheadPlace) {
    MountingPose& pose = drive.spec.radars[0].config.mounting_pose;
    pose.position_m = {3.8, 0.0, 0.5};
    pose.yaw_rad = 0.0;
  }
  const double sign = i / kPlaces % 2 == 0 ? 1.0 : -1.0;
  drive.spec.step_changes.push_back(  // measurement times start at 1 s
      {1.0 + change_s, drive.radar, sign * change.rotation_deg * kRadiansPerDegree});
  return drive;
}

const Snapshot& snapshot_at(const Run& run, double time_s) {
  for (const Snapshot& snapshot : run.snapshots) {
    if (snapshot.time_s >= time_s) return snapshot;
  }
  return run.last();
}

struct ChangeFigures {
  std::vector<double> delays_s;
  std::size_t before = 0, other_radar = 0;
  DriveErrors after;

  void take(const ChangeReports& reports) {
    delays_s.push_back(reports.delay_s);
    before += reports.before;
    other_radar += reports.other_radar;
  }
  [[nodiscard]] double in_time_percent() const {
    const auto in_time = std::count_if(delays_s.begin(), delays_s.end(), [](double d) { return d <= kInTime_s; });
    return 100.0 * static_cast<double>(in_time) / static_cast<double>(delays_s.size());
  }
  [[nodiscard]] std::vector<std::string> row(const std::string& name, const std::string& place) const {
    const auto covered = [&](int p) { return fixed(after.of(p).covered_percent(), 0); };
    return {name,
            place,
            std::to_string(delays_s.size()),
            with_interval(median(delays_s), median_interval(delays_s)),
            number(quantile(delays_s, 0.95)),
            fixed(in_time_percent(), 0),
            std::to_string(other_radar),
            std::to_string(before),
            number(after.of(kYaw).median_size() / kRadiansPerDegree),
            number(after.of(kPitch).median_size() / kRadiansPerDegree),
            covered(kYaw) + " / " + covered(kPitch)};
  }
};

}  // namespace

void real_car_changes(const Options& options, Report& report) {
  const std::size_t drives = options.seeds(40);
  const NamedMethod own = own_method(options.method);
  std::uint64_t seed = first_seed_of(FreshSeeds::kChanges, options);
  Table table{"real_car_changes",
              "method `" + own_method_name(options.method) +
                  "`, real_car, one radar turned at a random time from 60 to 120 s. Delay of the report in s, median "
                  "(95 % interval) and 95 % quantile. Share reported within 10 s. Reports of another radar and before "
                  "the change. 20 s later: median of the error's size, and share in the 95 % interval, yaw / pitch. " +
                  std::to_string(drives) + " drives of each change, seeds from " + std::to_string(seed) + " on",
              {"change", "radar", "drives", "delay s", "95 % s", "in 10 s, %", "other radar", "before", "yaw °",
               "pitch °", "covered, %"},
              {}};
  for (const RealCarChange& change : kRealCarChanges) {
    std::vector<ChangeDrive> changed;
    std::vector<simulator::AlignmentSpec> specs;
    for (std::size_t i = 0; i < drives; ++i) {
      changed.push_back(change_drive(change, i, seed + i, options.quick));
      specs.push_back(changed.back().spec);
    }
    const auto runs = run_drives(specs, own.make, options);
    ChangeFigures all;
    std::array<ChangeFigures, kPlaces> of_place;
    for (std::size_t i = 0; i < drives; ++i) {
      const ChangeReports reports = reports_of_change(runs[i].step_changes, changed[i].radar, changed[i].change_s);
      for (ChangeFigures* figures : {&all, &of_place[changed[i].place]}) {
        figures->take(reports);
        figures->after.add_drive(snapshot_at(runs[i], changed[i].change_s + kAfterChange_s), {changed[i].radar});
      }
    }
    for (std::size_t p = 0; p < kPlaces; ++p) {
      if (!of_place[p].delays_s.empty()) table.rows.push_back(of_place[p].row(change.name, kPlaceNames[p]));
    }
    table.rows.push_back(all.row(change.name, "**all**"));
    const std::string name = std::string(change.name) + ", real_car";
    const std::string how = std::to_string(drives) + " drives, seeds from " + std::to_string(seed) +
                            " on, four corner radars and one that looks ahead in turn, both signs";
    const Interval of_median = median_interval(all.delays_s);
    report.at_most("true changes", name + ": delay", median(all.delays_s), change.bar_s, "s",
                   "median over " + how + "; 95 % interval " + number(of_median.low) + "–" + number(of_median.high));
    report.at_least("true changes", name + ": reported within 10 s", all.in_time_percent(), 95.0, "%", how);
    const AxisErrors& axis = all.after.of(change.parameter);
    const Interval covered = axis.covered_interval();
    report.at_least("true changes", name + ": coverage 20 s later", axis.covered_percent(), 90.0, "%",
                    how + "; 95 % interval " + number(covered.low) + "–" + number(covered.high));
    report.beside("true changes", name + ": reports of another radar", static_cast<double>(all.other_radar), "", how);
    seed += kSeedsOfAKind;
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
