// The product's method against every published one on drives with what a real car adds: rms over drives and radars, at
// the end of each drive. The drives are those of the group real_car.
#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/axis_errors.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/alignment/common/real_car_drives.hpp"

namespace boresight::bench {

namespace {

constexpr double kMostOverBest = 1.2;

/// Own rms over that of the best published method on the same drives.
struct Comparison {
  std::string best;
  double best_deg = 0.0, own_deg = 0.0, ratio = 0.0;
  Interval interval;
};

Comparison compare_rms(const DriveErrors& own, const std::vector<std::pair<std::string, DriveErrors>>& others,
                       int parameter) {
  const auto best = std::min_element(others.begin(), others.end(), [&](const auto& a, const auto& b) {
    return a.second.of(parameter).rms() < b.second.of(parameter).rms();
  });
  const AxisErrors &ours = own.of(parameter), &theirs = best->second.of(parameter);
  return {best->first, theirs.rms() / kRadiansPerDegree, ours.rms() / kRadiansPerDegree, ours.rms() / theirs.rms(),
          ours.ratio_interval(theirs)};
}

}  // namespace

void real_car_published(const Options& options, Report& report) {
  const std::size_t drives = options.seeds(12);
  const double duration_s = options.seconds(180.0);
  const NamedMethod own = own_method(options.method);
  const std::uint64_t first_seed = first_seed_of(FreshSeeds::kKinds, options);
  Table table{"real_car_published",
              "method `" + own_method_name(options.method) +
                  "` and the best published method on the same drives: rms over drives and radars, and the ratio (95 % "
                  "interval by bootstrap over drives). " +
                  std::to_string(drives) + " drives of " + fixed(duration_s, 0) + " s of each kind, seeds from " +
                  std::to_string(first_seed) + " on",
              {"effect", "yaw °", "best yaw °", "ratio", "pitch °", "best pitch °", "ratio"},
              {}};
  RunOptions run_options;
  run_options.snapshot_period_s = run_options.fine_period_s = duration_s;
  std::uint64_t seed = first_seed;
  for (const RealCarKind& kind : real_car_kinds()) {
    const std::uint64_t of_kind = seed;
    seed += kSeedsOfAKind;
    const bool is_skipped = options.quick && !kind.is_whole_car && of_kind != first_seed;
    if (!kind.is_compared || is_skipped) continue;
    const auto specs = drives_of(kind, drives, duration_s, of_kind);
    const auto errors_of = [&](const NamedMethod& method) {
      DriveErrors errors;
      for (const Run& run : run_drives(specs, method.make, options, run_options)) errors.add_drive(run.last());
      return errors;
    };
    const DriveErrors ours = errors_of(own);
    std::vector<std::pair<std::string, DriveErrors>> others;
    for (const NamedMethod& method : published_methods()) others.emplace_back(method.name, errors_of(method));
    std::vector<std::string> row = {kind.name};
    for (const int parameter : {kYaw, kPitch}) {
      const Comparison comparison = compare_rms(ours, others, parameter);
      row.insert(row.end(), {number(comparison.own_deg), number(comparison.best_deg) + " " + comparison.best,
                             with_interval(comparison.ratio, comparison.interval)});
      report.at_most(
          "real car, published",
          std::string(kParameters[static_cast<std::size_t>(parameter)]) + " rms / best published, " + kind.name,
          comparison.ratio, kMostOverBest, "×",
          drives_text(drives, duration_s, of_kind) + "; best: " + comparison.best + "; 95 % interval " +
              number(comparison.interval.low) + "–" + number(comparison.interval.high));
    }
    table.rows.push_back(std::move(row));
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
