// How often a knock would be told where there was none. No simulation lasts 1000 h, so the rate is extrapolated, in two
// steps as the estimator has two.
// 1. The detector sums by how much a radar's deviation in a block exceeds its limit, at most one limit a block, and
//    suspects a knock at 1.5 limits: so at least two blocks in a row lie, on average, 1.3 limits or more off in one
//    direction. Taken is the largest such average of each minute of each radar.
// 2. A suspicion is told only if a new start, on data that come after it, lies off the estimate by more than its
//    covariance allows. Taken is the squared distance of fresh starts from the truth, without yaw-rate bias and slip,
//    as these are known by then.
// Of both the largest tenth are fitted by an exponential distribution, which falls more slowly than noise does, and
// tell how often the limit is exceeded, unless more was seen to exceed it. The data of the two are not the same, so
// that their rates are multiplied.
#include <algorithm>
#include <cmath>
#include <mutex>

#include <Eigen/Cholesky>

#include "services/alignment_estimator/core/filter/robust_filter.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

namespace {

using simulator::AlignmentSpec;
using simulator::RoadKind;

/// Largest average of two blocks in a row, in units of the limit, that a suspicion needs.
constexpr double kNeeded = 1.3;
/// Squared distance, 3 degrees of freedom, beyond which a new start confirms a suspicion (RobustFilter).
constexpr double kConfirms = 21.1;
/// That start's covariance counts this many times there; the estimate's, which follows from it, is start_inflation
/// times the statistical one.
constexpr double kConfirmInflation = 4.0;
constexpr RoadKind kRoads[] = {RoadKind::kCity, RoadKind::kMotorway, RoadKind::kMixed};

struct Tail {
  double largest = 0.0;
  double level = 0.0;         ///< u₀, exceeded by a tenth of the values
  double mean_excess = 0.0;   ///< over u₀
  double share_beyond = 0.0;  ///< of the values beyond 1: extrapolated, or as seen if that is more

  [[nodiscard]] std::string shape() const {
    return fixed(largest, 2) + ", " + fixed(level, 2) + ", " + fixed(mean_excess, 3);
  }
};

/// `values` in ascending order.
Tail tail_of(const std::vector<double>& values) {
  Tail tail;
  if (values.empty()) return tail;
  tail.largest = values.back();
  tail.level = quantile(values, 0.9);
  double excess = 0.0, count = 0.0, beyond = 0.0;
  for (const double value : values) {
    if (value > 1.0) beyond += 1.0;
    if (value <= tail.level) continue;
    excess += value - tail.level;
    count += 1.0;
  }
  if (count == 0.0) return tail;
  tail.mean_excess = excess / count;
  const auto all = static_cast<double>(values.size());
  tail.share_beyond =
      std::max(count / all * std::min(1.0, std::exp(-(1.0 - tail.level) / tail.mean_excess)), beyond / all);
  return tail;
}

AlignmentSpec drive_of(bool with_disturbances, RoadKind road, double duration_s, std::uint64_t seed) {
  return with_disturbances ? disturbed_drive(road, duration_s, seed) : clean_drive(road, duration_s, seed);
}

struct Quiet {
  std::vector<double> maxima;  ///< of each minute and radar, over what a suspicion needs; ascending
  double told = 0.0;
};

Quiet drive_quietly(const std::vector<AlignmentSpec>& specs, const Options& options) {
  const alignment::FilterConfig config;
  const Eigen::Array2d needed = kNeeded * Eigen::Array2d(config.knock_pitch_rad, config.knock_yaw_rad);
  Quiet quiet;
  std::mutex lock;
  parallel_for(specs.size(), options.jobs, [&](std::size_t i) {
    const std::size_t radars = specs[i].radars.size();
    const auto minutes = static_cast<std::size_t>(std::ceil(specs[i].duration_s / 60.0));
    std::vector<double> maxima(radars * minutes, 0.0);
    std::vector<Eigen::Array2d> before(radars, Eigen::Array2d::Zero());
    double told = 0.0;
    RunOptions run_options;
    run_options.snapshot_period_s = run_options.fine_period_s = config.knock_block_s;
    run_options.look = [&](const alignment::Method& method, double time_s) {
      const auto& filter = dynamic_cast<const alignment::RobustFilter&>(method);
      const std::size_t minute = std::min(static_cast<std::size_t>(time_s / 60.0), minutes - 1);
      told = 0.0;
      for (std::size_t r = 0; r < radars; ++r) {
        const Eigen::Array2d now = filter.knock_detector().deviation(r).array();
        double& maximum = maxima[minute * radars + r];
        maximum = std::max(maximum, (0.5 * (before[r] + now).abs() / needed).maxCoeff());
        before[r] = now;
        told += filter.estimate(r).knock.count;
      }
    };
    static_cast<void>(run_drive(specs[i], own_method().make, run_options));
    const std::lock_guard guard(lock);
    quiet.maxima.insert(quiet.maxima.end(), maxima.begin(), maxima.end());
    quiet.told += told;
  });
  std::sort(quiet.maxima.begin(), quiet.maxima.end());
  return quiet;
}

/// Squared distances of fresh starts from the truth, over kConfirms; ascending.
std::vector<double> start_distances(bool with_disturbances, std::size_t seeds, const Options& options) {
  const alignment::FilterConfig config;
  std::vector<double> distances;
  std::mutex lock;
  parallel_for(seeds, options.jobs, [&](std::size_t i) {
    AlignmentSpec spec = drive_of(with_disturbances, kRoads[i % std::size(kRoads)], 4.0, 6000 + i);
    // A start that is to confirm a suspicion is made with the yaw-rate bias and slip that the estimator knows by then.
    spec.yaw_rate_bias_radps = spec.slip_coefficient_radps2pm = 0.0;
    std::vector<double> found(spec.radars.size(), -1.0);
    RunOptions run_options;
    run_options.look = [&](const alignment::Method& method, double) {
      for (std::size_t r = 0; r < found.size(); ++r) {
        const alignment::RadarEstimate e = method.estimate(r);
        if (found[r] >= 0.0 || (e.observable & alignment_axis::kVehicleYaw) == 0) continue;
        const simulator::Misalignment& m = spec.radars[r].truth;
        const Eigen::Matrix3d truth =
            geometry::sensor_to_vehicle(spec.radars[r].config.mounting_pose, m.yaw_rad, m.pitch_rad, m.roll_rad);
        const Eigen::Vector3d error = geometry::so3_log(e.sensor_to_vehicle * truth.transpose());
        const Eigen::Matrix3d covariance =
            kConfirmInflation / config.start_inflation * e.covariance.bottomRightCorner<3, 3>();
        found[r] = error.dot(covariance.llt().solve(error)) / kConfirms;
      }
    };
    static_cast<void>(run_drive(spec, own_method().make, run_options));
    const std::lock_guard guard(lock);
    for (const double distance : found) {
      if (distance >= 0.0) distances.push_back(distance);
    }
  });
  std::sort(distances.begin(), distances.end());
  return distances;
}

Curve curve_of(const std::string& name, const std::vector<double>& maxima) {
  Curve curve{"false_alarms", "share of minutes beyond", name, {}};
  for (std::size_t k = 0; k < maxima.size(); k += 1 + maxima.size() / 200) {
    curve.points.emplace_back(maxima[k], 1.0 - static_cast<double>(k) / static_cast<double>(maxima.size()));
  }
  return curve;
}

}  // namespace

void false_alarms(const Options& options, Report& report) {
  const double drive_s = options.quick ? 30.0 : 3600.0;
  Table table{"false_alarms",
              "drives without a knock: extrapolation from the largest deviations of two blocks in a row (1: suspicion) "
              "and of new starts (1: confirmed); u₀ is exceeded by a tenth of them",
              {"drives", "hours", "told", "blocks: largest, u₀, mean excess", "suspicions per 1000 h",
               "starts: number, largest, u₀, mean excess", "share that confirm", "told per 1000 h"},
              {}};
  double worst = 0.0, told = 0.0, all_hours = 0.0;
  for (const bool with_disturbances : {false, true}) {
    std::vector<AlignmentSpec> specs;
    for (std::size_t seed = 0; seed < options.seeds(2); ++seed) {
      for (const RoadKind road : kRoads) specs.push_back(drive_of(with_disturbances, road, drive_s, 5000 + seed));
    }
    const double hours = static_cast<double>(specs.size()) * drive_s / 3600.0;
    const Quiet quiet = drive_quietly(specs, options);
    const std::vector<double> distances = start_distances(with_disturbances, options.seeds(600), options);
    const Tail blocks = tail_of(quiet.maxima), starts = tail_of(distances);
    const double suspicions = 1000.0 * blocks.share_beyond * static_cast<double>(quiet.maxima.size()) / hours;
    const double rate = suspicions * starts.share_beyond;
    worst = std::max(worst, rate);
    told += quiet.told;
    all_hours += hours;
    const std::string name = with_disturbances ? "disturbed" : "clean";
    table.rows.push_back({name, fixed(hours, 1), fixed(quiet.told, 0), blocks.shape(), number(suspicions),
                          std::to_string(distances.size()) + ", " + starts.shape(), number(starts.share_beyond),
                          number(rate)});
    report.add(curve_of(name, quiet.maxima));
  }
  report.at_most("knock", "false alarms told", told, 0.0, "",
                 "in " + fixed(all_hours, 1) + " h without a knock, half of them disturbed");
  report.at_most(
      "knock", "false alarms per 1000 h of a vehicle of four radars", worst, 1.0, "",
      "the worse of clean and disturbed; extrapolated suspicions × share of new starts that would confirm one, "
      "both from exponential tails, or as seen where that is more");
  report.add(std::move(table));
}

}  // namespace boresight::bench
