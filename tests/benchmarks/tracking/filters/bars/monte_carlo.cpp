// The published table: errors of 10,000 runs.
#include <algorithm>
#include <array>
#include <string>

#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/tracking/filters/bars/bars.hpp"
#include "tests/benchmarks/tracking/filters/common/errors.hpp"

namespace boresight::bench::filters {

namespace {

constexpr std::array kQuantities = {"range", "azimuth", "radial speed"};

struct SceneErrors {
  std::vector<RunErrors> measured;
  std::array<std::vector<RunErrors>, kForms> filtered;
};

SceneErrors run_scene(const Scene& scene, const Options& options, std::size_t runs) {
  SceneErrors errors;
  errors.measured.resize(runs);
  for (std::vector<RunErrors>& form : errors.filtered) form.resize(runs);
  const Model<double> the_model = model<double>();
  parallel_for(runs, options.jobs, [&](std::size_t i) {
    const Run run = draw_run(scene, options.fresh_seed + i);
    errors.measured[i] = errors_of_measurements(run);
    for_each_form<double>([&]<typename Filter>(std::size_t form, const Filter&) {
      errors.filtered[form][i] = errors_of<double, Filter>(run, the_model);
    });
  });
  return errors;
}

/// Relative distance of an interval to a published value: 0 if the interval holds the value.
double distance_percent(const Interval& interval, double published) {
  const double distance = std::max({0.0, interval.low - published, published - interval.high});
  return 100.0 * distance / published;
}

std::vector<std::string> row_of(const char* scene, const char* name, std::span<const RunErrors> runs) {
  const Accuracy accuracy = accuracy_of(runs);
  std::vector<std::string> row = {scene, name};
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Interval interval = rms_interval(runs, i);
    row.push_back(fixed(accuracy.rms(i), 4) + " (" + fixed(interval.low, 4) + "–" + fixed(interval.high, 4) + ")");
  }
  row.push_back(accuracy.nees > 0.0 ? fixed(accuracy.nees, 2) : "—");
  return row;
}

void judge(const Scene& scene, std::size_t form, std::span<const RunErrors> runs, Report& report) {
  constexpr double kBar_percent = 1.0;
  const Accuracy& published = form == 0 ? scene.extended : scene.unscented;
  const Accuracy accuracy = accuracy_of(runs);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const std::string what = std::string(scene.name) + ", " + kFormNames[form] + ": RMS error of " +
                             kQuantities[static_cast<std::size_t>(i)] + ", from its 95 % interval to the published one";
    const Interval interval = rms_interval(runs, i);
    const auto percent = [&](double value) { return fixed(100.0 * (value / published.rms(i) - 1.0), 2); };
    report.at_most("monte_carlo", what, distance_percent(interval, published.rms(i)), kBar_percent, "%",
                   std::to_string(runs.size()) + " runs; difference " + percent(accuracy.rms(i)) + " %, interval " +
                       percent(interval.low) + " to " + percent(interval.high) + " %");
  }
}

void judge_equality(const Scene& scene, const SceneErrors& errors, Report& report) {
  constexpr double kBar = 1e-9;
  for (const std::size_t form : {std::size_t{1}, kPublished, kCovariance, kPureRoot}) {
    double worst = 0.0;
    for (std::size_t i = 0; i < errors.measured.size(); ++i) {
      const track::ObjectState difference = errors.filtered[form][i].last_mean - errors.filtered[kFull][i].last_mean;
      worst = std::max(worst, difference.cwiseAbs().maxCoeff());
    }
    report.at_most(
        "monte_carlo",
        std::string(scene.name) + ", " + kFormNames[form] + ": largest difference of a state from the full form", worst,
        kBar, "", std::to_string(errors.measured.size()) + " runs, last step");
  }
}

}  // namespace

void monte_carlo(const Options& options, Report& report) {
  constexpr std::size_t kRuns = 10'000;
  const std::size_t runs = options.seeds(kRuns);
  Table table{"filters_monte_carlo",
              "RMS errors of " + std::to_string(runs) + " runs from step " + std::to_string(kSkipped) +
                  " on (95 % interval); NEES: normalised squared error of the state per component",
              {"scene", "filter", "range m", "azimuth °", "radial speed m/s", "NEES"},
              {}};
  for (const Scene& scene : scenes()) {
    const SceneErrors errors = run_scene(scene, options, runs);
    table.rows.push_back(row_of(scene.name, "none: measurements", errors.measured));
    std::size_t failures = 0;
    for (std::size_t form = 0; form < kForms; ++form) {
      table.rows.push_back(row_of(scene.name, kFormNames[form], errors.filtered[form]));
      judge(scene, form, errors.filtered[form], report);
      for (const RunErrors& run : errors.filtered[form]) failures += run.has_failed ? 1 : 0;
    }
    judge_equality(scene, errors, report);
    report.at_most("monte_carlo", std::string(scene.name) + ": runs in which a filter lost its covariance",
                   static_cast<double>(failures), 0.0, "", "all filters, " + std::to_string(runs) + " runs");
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench::filters
