// The set-up of Burza's tables: planar truth, slow drive, no outliers. All published methods and our own.
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/alignment/common/published_result.hpp"

namespace boresight::bench {

namespace {

/// Mean over seeds and radars of the size of the error, in points spread evenly over the logarithm of iterations.
void add_curves(const NamedMethod& method, const std::string& figure, const std::vector<Run>& runs, Report& report) {
  for (std::size_t p = 0; p < 4; ++p) {
    Curve curve{figure, kSensorParameters[p], method.name, {}};
    double next = 1.0;
    for (std::size_t s = 0; s < runs.front().snapshots.size(); ++s) {
      const auto iterations = static_cast<double>(runs.front().snapshots[s].iterations);
      if (iterations < next) continue;
      next = iterations * 1.06;
      double sum = 0.0, count = 0.0;
      for (const Run& run : runs) {
        if (s >= run.snapshots.size()) continue;
        for (const RadarError& radar : run.snapshots[s].radars) {
          sum += std::abs(published_error(radar, p));
          count += 1.0;
        }
      }
      curve.points.emplace_back(iterations, sum / count);
    }
    report.add(std::move(curve));
  }
}

Curve histogram(const std::string& label, const Moments& moments) {
  Curve curve{"residuals", "residual of the range rate, m/s", label, {}};
  const double width = 2.0 * Moments::kReach_mps / static_cast<double>(Moments::kBins);
  for (std::size_t b = 0; b < Moments::kBins; ++b) {
    const double centre = -Moments::kReach_mps + (static_cast<double>(b) + 0.5) * width;
    curve.points.emplace_back(centre, static_cast<double>(moments.bins()[b]) / (moments.count() * width));
  }
  return curve;
}

/// Bias of Nelder–Mead over that of our method, per parameter; no bar where the two methods assume different models.
void compare(const PublishedResult& nelder_mead, const PublishedResult& own, const std::string& name, bool planar_truth,
             const std::string& drives, Report& report) {
  const bool like_with_like = planar_truth == (name == "boresight_planar");
  for (std::size_t p = 0; p < 4; ++p) {
    const std::string what = std::string(kSensorParameters[p]) + ": bias of Nelder–Mead / bias of " + name +
                             (planar_truth ? ", planar truth" : ", truth a rotation");
    const double ratio = nelder_mead.bias[p] / own.bias[p];
    if (like_with_like) {
      report.at_least("published set-up", what, ratio, 5.0, "×", drives);
    } else {
      report.beside("published set-up", what + " (for comparison)", ratio, "×",
                    "no bar: this truth is not a rotation; see the table of optima");
    }
  }
}

}  // namespace

void published(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(3);
  // Long enough for the slowest published method, 24379 iterations of 50 ms.
  const double duration_s = options.seconds(1500.0);
  RunOptions run_options;
  run_options.residuals = true;
  run_options.snapshot_period_s = 2.0;
  const std::string drives = "mean |bias| over the last fifth of " + fixed(duration_s, 0) + " s, " +
                             std::to_string(seeds) + " seeds × 4 radars, same drives for both";
  for (const bool planar_truth : {true, false}) {
    simulator::AlignmentSpec setup = simulator::published_setup();
    if (!planar_truth) setup.model = simulator::MountingModel::kExact;
    const std::vector<simulator::AlignmentSpec> specs = of_seeds(setup, seeds, duration_s);
    const std::string figure = planar_truth ? "published" : "published_exact";
    Table table{figure,
                std::string("the published set-up, truth ") +
                    (planar_truth ? "by the planar roll model (10)(11)" : "a rotation") +
                    ": iterations (scans of a radar) until 95 % of the initial error is removed; bias and residual "
                    "over the last fifth of " +
                    fixed(duration_s, 0) + " s; mean over " + std::to_string(seeds) + " seeds × 4 radars",
                published_header("method"),
                {}};
    PublishedResult nelder_mead;
    for (const NamedMethod& method : published_methods_without_gate()) {
      const auto runs = run_drives(specs, method.make, options, run_options);
      const PublishedResult result = published_result(runs, duration_s);
      if (table.rows.empty()) {
        table.rows.push_back(
            {"uncorrected", "", "", "", "", "", "", "", "", fixed(result.uncorrected.rmse(), 4),
             fixed(result.uncorrected.skewness(), 3) + " / " + fixed(result.uncorrected.kurtosis(), 2)});
        if (planar_truth) report.add(histogram("uncorrected", result.uncorrected));
      }
      if (method.name == "nelder_mead") {
        nelder_mead = result;
        if (planar_truth) report.add(histogram(method.name, result.corrected));
      }
      table.rows.push_back(published_row(method.name, result));
      add_curves(method, figure, runs, report);
    }
    if (planar_truth) {
      table.rows.push_back({"*published:* uncorrected", "", "", "", "", "", "", "", "", "0.2045", "0.2459 / 2.1019"});
      table.rows.push_back({"*published:* 1-D reference", "24379", "", "", "", "6.63e-06", "0.0184", "—", "—", "0.0275",
                            "−0.0271 / 3.1994"});
      table.rows.push_back({"*published:* Nelder–Mead", "6971", "", "", "", "2.99e-05", "0.0106", "0.1380", "0.0912",
                            "0.0272", "−0.0201 / 3.2126"});
    }
    // The bar compares under the model of the truth: Burza's planar rows on planar truth, the rotation on a rotation.
    std::vector<NamedMethod> ours = {own_method(options.method)};
    if (planar_truth) ours.insert(ours.begin(), own_method_with_planar_rows());
    for (const NamedMethod& own : ours) {
      const auto runs = run_drives(specs, own.make, options, run_options);
      const PublishedResult result = published_result(runs, duration_s);
      table.rows.push_back(published_row(own.name, result));
      add_curves(own, figure, runs, report);
      if (planar_truth) report.add(histogram(own.name, result.corrected));
      compare(nelder_mead, result, own.name, planar_truth, drives, report);
    }
    report.add(std::move(table));
  }
}

}  // namespace boresight::bench
