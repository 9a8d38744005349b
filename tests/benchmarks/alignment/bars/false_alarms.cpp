// How often a knock would be told where there was none. No simulation lasts 1000 h, so the rate is extrapolated. The
// detector sums by how much a radar's deviation in a block exceeds its limit, at most one limit a block, and suspects a
// knock at 1.5 limits: so at least two blocks in a row lie, on average, 1.3 limits or more off in one direction. Taken
// is the largest such average of each minute of each radar; the largest tenth of these are fitted by an exponential
// distribution, which falls more slowly than noise does, and tell the rate at which 1.3 is exceeded. That counts
// suspicions; the estimator tells a knock only if a new start confirms it.
#include <algorithm>
#include <cmath>
#include <mutex>

#include "services/alignment_estimator/core/filter/robust_filter.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

namespace {

using simulator::RoadKind;

struct Tail {
  double suspicions_per_1000_h;  ///< of a vehicle
  double level;                  ///< u₀, exceeded by a tenth of the minutes, over what a suspicion needs
  double mean_excess;            ///< over u₀
};

/// Largest average of two blocks in a row, in units of the limit, that a suspicion needs.
constexpr double kNeeded = 1.3;

/// `maxima`: of each minute and radar, over what a suspicion needs.
Tail extrapolate(std::vector<double> maxima, double hours) {
  std::sort(maxima.begin(), maxima.end());
  const double level = quantile(maxima, 0.9);
  double excess = 0.0, count = 0.0;
  for (const double m : maxima) {
    if (m <= level) continue;
    excess += m - level;
    count += 1.0;
  }
  if (count == 0.0) return {0.0, level, 0.0};
  const double mean = excess / count;
  return {1000.0 * count / hours * std::exp(-(1.0 - level) / mean), level, mean};
}

}  // namespace

void false_alarms(const Options& options, Report& report) {
  const double drive_s = options.quick ? 30.0 : 3600.0;
  const std::size_t seeds = options.seeds(2);
  const alignment::FilterConfig config;
  const Eigen::Array2d needed = kNeeded * Eigen::Array2d(config.knock_pitch_rad, config.knock_yaw_rad);
  Table table{
      "false_alarms",
      "drives without a knock: how many were told, and suspicions extrapolated from the largest deviation of two "
      "blocks in a row, over what a suspicion needs",
      {"drives", "hours", "told", "largest of all", "exceeded in a tenth of minutes, u₀", "mean excess over u₀",
       "suspicions per 1000 h"},
      {}};
  double worst = 0.0, told_in_all = 0.0, hours_in_all = 0.0;
  for (const bool with_disturbances : {false, true}) {
    std::vector<simulator::AlignmentSpec> specs;
    for (std::size_t seed = 0; seed < seeds; ++seed) {
      for (const RoadKind road : {RoadKind::kCity, RoadKind::kMotorway, RoadKind::kMixed}) {
        specs.push_back(with_disturbances ? disturbed_drive(road, drive_s, 5000 + seed)
                                          : clean_drive(road, drive_s, 5000 + seed));
      }
    }
    std::vector<double> maxima;
    double told = 0.0;
    std::mutex lock;
    parallel_for(specs.size(), options.jobs, [&](std::size_t i) {
      std::vector<double> minutes(specs[i].radars.size() * static_cast<std::size_t>(std::ceil(drive_s / 60.0) + 1.0));
      std::vector<std::uint32_t> counts(specs[i].radars.size());
      std::vector<Eigen::Array2d> before(specs[i].radars.size(), Eigen::Array2d::Zero());
      RunOptions run_options;
      run_options.snapshot_period_s = run_options.fine_period_s = config.knock_block_s;
      run_options.look = [&](const alignment::Method& method, double time_s) {
        const auto& filter = dynamic_cast<const alignment::RobustFilter&>(method);
        for (std::size_t r = 0; r < counts.size(); ++r) {
          double& minute = minutes[static_cast<std::size_t>(time_s / 60.0) * counts.size() + r];
          const Eigen::Array2d now = filter.knock_detector().deviation(r).array();
          minute = std::max(minute, (0.5 * (before[r] + now).abs() / needed).maxCoeff());
          before[r] = now;
          counts[r] = filter.estimate(r).knock.count;
        }
      };
      static_cast<void>(run_drive(specs[i], own_method().make, run_options));
      const std::lock_guard guard(lock);
      maxima.insert(maxima.end(), minutes.begin(), minutes.end());
      for (const std::uint32_t count : counts) told += count;
    });
    const double hours = static_cast<double>(specs.size()) * drive_s / 3600.0;
    const Tail tail = extrapolate(maxima, hours);
    worst = std::max(worst, tail.suspicions_per_1000_h);
    told_in_all += told;
    hours_in_all += hours;
    const std::string name = with_disturbances ? "disturbed" : "clean";
    table.rows.push_back({name, fixed(hours, 1), fixed(told, 0),
                          fixed(*std::max_element(maxima.begin(), maxima.end()), 2), fixed(tail.level, 2),
                          fixed(tail.mean_excess, 3), number(tail.suspicions_per_1000_h)});
    std::sort(maxima.begin(), maxima.end());
    Curve curve{"false_alarms",
                "largest deviation of two blocks in a row, over what a suspicion needs: share of minutes beyond",
                name,
                {}};
    for (std::size_t k = 0; k < maxima.size(); k += 1 + maxima.size() / 200) {
      curve.points.emplace_back(maxima[k], 1.0 - static_cast<double>(k) / static_cast<double>(maxima.size()));
    }
    report.add(std::move(curve));
  }
  report.at_most("knock", "false alarms told", told_in_all, 0.0, "",
                 "in " + fixed(hours_in_all, 1) + " h without a knock, half of them disturbed");
  report.at_most(
      "knock", "false suspicions per 1000 h of a vehicle of four radars", worst, 1.0, "",
      "the worse of clean and disturbed; extrapolated from the tail of the largest deviations of each minute");
  report.add(std::move(table));
}

}  // namespace boresight::bench
