// Burza 2025 states neither the size of Nelder–Mead's simplex nor the time constant of its filter. This group varies
// both.
#include "services/alignment_estimator/core/published/published.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/alignment/common/published_result.hpp"

namespace boresight::bench {

namespace {

using alignment::published::PublishedConfig;

struct Setting {
  double filter_scans, edge;  ///< edge as a multiple of the default edge
};

constexpr double kDefaultFilter_scans = PublishedConfig{}.nelder_mead_filter_scans;
constexpr Setting kSettings[] = {{0.5 * kDefaultFilter_scans, 1.0}, {kDefaultFilter_scans, 1.0},
                                 {2.0 * kDefaultFilter_scans, 1.0}, {4.0 * kDefaultFilter_scans, 1.0},
                                 {kDefaultFilter_scans, 0.5},       {kDefaultFilter_scans, 2.0}};

MakeMethod nelder_mead_with(const Setting& setting) {
  PublishedConfig config = alignment::published::as_published();
  config.nelder_mead_filter_scans = setting.filter_scans;
  for (double& edge : config.nelder_mead_edge) edge *= setting.edge;
  return [config](const VehicleConfig& vehicle) {
    return alignment::published::make_published(alignment::published::Kind::kNelderMead, vehicle, config);
  };
}

}  // namespace

void published_filter(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(3);
  // Four times the filter's constant takes four times as long.
  const double duration_s = options.seconds(3000.0);
  RunOptions run_options;
  run_options.snapshot_period_s = 2.0;
  const auto specs = of_seeds(simulator::published_setup(), seeds, duration_s);
  const NamedMethod own = own_method_with_planar_rows();
  const PublishedResult ours = published_result(run_drives(specs, own.make, options, run_options), duration_s);
  Table table{
      "published_filter",
      "Nelder–Mead on the published set-up, unpublished constants varied. Iterations (scans of a radar) until 95 % "
      "of the initial error is removed; bias over the last fifth of " +
          fixed(duration_s, 0) + " s; mean over " + std::to_string(seeds) +
          " seeds × 4 radars. Ratio: the smallest of its biases over those of boresight_planar",
      {"filter, scans", "simplex", "k_v", "α", "β", "γ", "bias k_v", "α °", "β °", "γ °", "ratio"},
      {}};
  for (const Setting& setting : kSettings) {
    const auto result =
        published_result(run_drives(specs, nelder_mead_with(setting), options, run_options), duration_s);
    std::vector<std::string> row = published_row(fixed(setting.filter_scans, 0), result);
    row.resize(row.size() - 2);  // no residuals were counted
    row.insert(row.begin() + 1, "× " + number(setting.edge));
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < 4; ++p) least = std::min(least, result.bias[p] / ours.bias[p]);
    row.push_back(number(least) + " ×");
    table.rows.push_back(std::move(row));
  }
  table.rows.push_back({"*published*", "", "6971", "", "", "", "2.99e-05", "0.0106", "0.1380", "0.0912", ""});
  report.add(std::move(table));
}

}  // namespace boresight::bench
