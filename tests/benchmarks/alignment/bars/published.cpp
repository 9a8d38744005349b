// The set-up of Report A's tables: planar truth, slow drive, no outliers. Every published method, and ours beside them.
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

namespace {

constexpr std::array<const char*, 4> kSensorParameters = {"k_v", "α", "β", "γ"};

/// Of one method over seeds and radars.
struct Result {
  std::array<double, 4> iterations{};  ///< to 95 % of the distance: median
  std::array<double, 4> bias{};        ///< mean of |error averaged over the last fifth|; 1, degrees
  Moments corrected, uncorrected;
};

double error_of(const RadarError& radar, std::size_t parameter) {
  return parameter == 0 ? radar.error(kSpeedScale)
                        : radar.sensor_error_rad(static_cast<Eigen::Index>(parameter) - 1) / kDegree;
}

/// Converged estimates wander; their mean over the last fifth of the drive is what the tables call bias.
double bias_of(const Run& run, std::size_t radar, std::size_t parameter, double duration_s) {
  double sum = 0.0, count = 0.0;
  for (const Snapshot& s : run.snapshots) {
    if (s.time_s < 0.8 * duration_s) continue;
    sum += error_of(s.radars[radar], parameter);
    count += 1.0;
  }
  return std::abs(sum / count);
}

Result result_of(const std::vector<Run>& runs, double duration_s) {
  Result result;
  for (std::size_t p = 0; p < 4; ++p) {
    std::vector<double> iterations;
    double bias = 0.0, count = 0.0;
    for (const Run& run : runs) {
      for (std::size_t r = 0; r < run.last().radars.size(); ++r) {
        const TimeTo95 time = p == 0 ? time_to_95(run, r, kSpeedScale, 1e-4)
                                     : time_to_95_sensor(run, r, static_cast<int>(p) - 1, 0.1 * kDegree);
        iterations.push_back(time.first_iterations);
        bias += bias_of(run, r, p, duration_s);
        count += 1.0;
      }
    }
    result.iterations[p] = median(iterations);
    result.bias[p] = bias / count;
  }
  for (const Run& run : runs) {
    result.corrected.add(run.corrected);
    result.uncorrected.add(run.uncorrected);
  }
  return result;
}

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
          sum += std::abs(error_of(radar, p));
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

std::vector<std::string> row_of(const std::string& name, const Result& result) {
  std::vector<std::string> row = {name};
  for (const double iterations : result.iterations) row.push_back(fixed(iterations, 0));
  row.push_back(number(result.bias[0]));
  for (std::size_t p = 1; p < 4; ++p) row.push_back(fixed(result.bias[p], 4));
  row.push_back(fixed(result.corrected.rmse(), 4));
  row.push_back(fixed(result.corrected.skewness(), 3) + " / " + fixed(result.corrected.kurtosis(), 2));
  return row;
}

}  // namespace

void published(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(3);
  // Long enough for the slowest published method, 24379 iterations of 50 ms.
  const double duration_s = options.seconds(1500.0);
  RunOptions run_options;
  run_options.residuals = true;
  run_options.snapshot_period_s = 2.0;
  for (const bool planar_truth : {true, false}) {
    std::vector<simulator::AlignmentSpec> specs;
    for (std::size_t seed = 0; seed < seeds; ++seed) {
      specs.push_back(simulator::published_setup());
      specs.back().seed = 40 + seed;
      specs.back().duration_s = duration_s;
      if (!planar_truth) specs.back().model = simulator::MountingModel::kExact;
    }
    const std::string figure = planar_truth ? "published" : "published_exact";
    Table table{figure,
                std::string("the published set-up, truth ") +
                    (planar_truth ? "by the planar roll model (10)(11)" : "a rotation") +
                    ": iterations (scans of a radar) to 95 %, bias, residual; last fifth of " + fixed(duration_s, 0) +
                    " s, mean over " + std::to_string(seeds) + " seeds × 4 radars",
                {"method", "k_v", "α", "β", "γ", "bias k_v", "α °", "β °", "γ °", "RMSE m/s", "skewness / kurtosis"},
                {}};
    Result nelder_mead;
    for (const NamedMethod& method : published_methods_without_gate()) {
      const auto runs = run_drives(specs, method.make, options, run_options);
      const Result result = result_of(runs, duration_s);
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
      table.rows.push_back(row_of(method.name, result));
      add_curves(method, figure, runs, report);
    }
    if (planar_truth) {
      table.rows.push_back({"*published:* uncorrected", "", "", "", "", "", "", "", "", "0.2045", "0.2459 / 2.1019"});
      table.rows.push_back({"*published:* 1-D reference", "24379", "", "", "", "6.63e-06", "0.0184", "—", "—", "0.0275",
                            "−0.0271 / 3.1994"});
      table.rows.push_back({"*published:* Nelder–Mead", "6971", "", "", "", "2.99e-05", "0.0106", "0.1380", "0.0912",
                            "0.0272", "−0.0201 / 3.2126"});
    }
    // Planar truth is no rotation: ours is judged there with Report A's rows as well, like with like.
    std::vector<NamedMethod> ours = {own_method()};
    if (planar_truth) ours.push_back(own_method_with_planar_rows());
    for (const NamedMethod& own : ours) {
      const auto runs = run_drives(specs, own.make, options, run_options);
      const Result result = result_of(runs, duration_s);
      table.rows.push_back(row_of(own.name, result));
      add_curves(own, figure, runs, report);
      if (planar_truth) report.add(histogram(own.name, result.corrected));
      for (std::size_t p = 0; p < 4; ++p) {
        report.at_least("published set-up",
                        std::string(kSensorParameters[p]) + ": Nelder–Mead's bias over that of " + own.name + ", " +
                            (planar_truth ? "planar truth" : "truth a rotation"),
                        nelder_mead.bias[p] / result.bias[p], 5.0, "×",
                        "mean |bias| over the last fifth of " + fixed(duration_s, 0) + " s, " + std::to_string(seeds) +
                            " seeds × 4 radars, both on the same drives");
      }
    }
    report.add(std::move(table));
  }
}

}  // namespace boresight::bench
