// How often a knock would be told where there was none. No simulation lasts 1000 h, so the rate is extrapolated, for
// each of the two detectors in two steps, as the estimator has two.
// Large changes (KnockDetector):
// 1. The detector sums by how much a radar's deviation in a block exceeds its limit, at most one limit a block, and
//    suspects a knock at 1.5 limits: so at least two blocks in a row lie, on average, 1.3 limits or more off in one
//    direction. Taken is the largest such average of each minute of each radar.
// 2. A suspicion is told only if a new start, on data that come after it, lies off the estimate by more than its
//    covariance allows. Taken is the squared distance of fresh starts from the truth, without yaw-rate bias and slip,
//    as these are known by then.
// Small changes (SmallKnockDetector):
// 1. Taken is the largest sum of each minute of each radar, over the limit of a suspicion.
// 2. A suspicion is told only if the next window deviates in the same direction. Taken is what windows deviate by in
// the
//    direction of the sum before them where there was one, over what confirms: what two windows in a row may have in
//    common, an error of the estimate or of the scene, is in it.
// Of all the largest tenth are fitted by an exponential distribution, which falls more slowly than noise does, and
// tell how often the limit is exceeded, unless more was seen to exceed it. The data of the two steps are not the same,
// so that their rates are multiplied. That changes of yaw and pitch below a least size are not told is not counted on;
// a change of roll is never told, only followed, and has a line of its own.
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

/// Of what one detector saw, ascending.
struct Seen {
  std::vector<double> maxima;  ///< of each minute and radar, over what a suspicion needs
  std::vector<double> then;    ///< what came after, over what confirms

  void take(const Seen& other) {
    maxima.insert(maxima.end(), other.maxima.begin(), other.maxima.end());
    then.insert(then.end(), other.then.begin(), other.then.end());
  }
  void sort() {
    std::sort(maxima.begin(), maxima.end());
    std::sort(then.begin(), then.end());
  }
};

struct Quiet {
  Seen large, small, roll;
  double told = 0.0;
};

/// Follows the windows of one axis of one radar.
class SmallWatch {
 public:
  explicit SmallWatch(double confirms_stds) : confirms_stds_(confirms_stds) {}

  void look(const alignment::SmallStepChangeDetector& detector, std::size_t radar, std::size_t axis, double& maximum,
            std::vector<double>& then) {
    const double sum = detector.sum(radar, axis), deviation = detector.deviation(radar, axis);
    maximum = std::max(maximum, std::abs(sum));
    if (deviation == deviation_) return;  // the same window
    if (std::abs(sum_) > kSomeSum) then.push_back(std::max(0.0, std::copysign(1.0, sum_) * deviation / confirms_stds_));
    sum_ = sum;
    deviation_ = deviation;
  }

 private:
  static constexpr double kSomeSum = 0.05;
  double confirms_stds_;
  double sum_ = 0.0, deviation_ = 0.0;
};

Quiet drive_quietly(const std::vector<AlignmentSpec>& specs, const Options& options) {
  const alignment::FilterConfig config;
  const Eigen::Array2d needed = kNeeded * Eigen::Array2d(config.step_change_pitch_rad, config.step_change_yaw_rad);
  Quiet quiet;
  std::mutex lock;
  parallel_for(specs.size(), options.jobs, [&](std::size_t i) {
    const std::size_t radars = specs[i].radars.size();
    const auto minutes = static_cast<std::size_t>(std::ceil(specs[i].duration_s / 60.0));
    Quiet own;
    for (Seen* const seen : {&own.large, &own.small, &own.roll}) seen->maxima.assign(radars * minutes, 0.0);
    std::vector<Eigen::Array2d> before(radars, Eigen::Array2d::Zero());
    std::vector<SmallWatch> watches;
    for (std::size_t k = 0; k < 3 * radars; ++k) {
      watches.emplace_back(alignment::SmallStepChangeDetector::confirming_stds(config, k % 3));
    }
    RunOptions run_options;
    run_options.snapshot_period_s = run_options.fine_period_s = config.step_change_block_s;
    run_options.look = [&](const alignment::Method& method, double time_s) {
      const auto& filter = dynamic_cast<const alignment::RobustFilter&>(method);
      const std::size_t minute = std::min(static_cast<std::size_t>(time_s / 60.0), minutes - 1);
      own.told = 0.0;
      for (std::size_t r = 0; r < radars; ++r) {
        const std::size_t at = minute * radars + r;
        const Eigen::Array2d now = filter.step_change_detector().deviation(r).array();
        double& maximum = own.large.maxima[at];
        maximum = std::max(maximum, (0.5 * (before[r] + now).abs() / needed).maxCoeff());
        before[r] = now;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          Seen& seen = axis == 0 ? own.roll : own.small;
          watches[3 * r + axis].look(filter.small_step_change_detector(), r, axis, seen.maxima[at], seen.then);
        }
        own.told += filter.estimate(r).step_change.count;
      }
    };
    static_cast<void>(run_drive(specs[i], own_method().make, run_options));
    const std::lock_guard guard(lock);
    quiet.large.take(own.large);
    quiet.small.take(own.small);
    quiet.roll.take(own.roll);
    quiet.told += own.told;
  });
  for (Seen* const seen : {&quiet.large, &quiet.small, &quiet.roll}) seen->sort();
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
              "drives without a knock: extrapolation from the largest deviations of two blocks in a row or the largest "
              "sums (1: suspicion) and from new starts or the next windows (1: confirmed); u₀ is exceeded by a tenth",
              {"change", "drives", "hours", "suspicion: largest, u₀, mean excess", "suspicions per 1000 h",
               "then: number, largest, u₀, mean excess", "share that confirm", "told per 1000 h"},
              {}};
  double worst = 0.0, told = 0.0, all_hours = 0.0;
  for (const bool with_disturbances : {false, true}) {
    std::vector<AlignmentSpec> specs;
    for (std::size_t seed = 0; seed < options.seeds(2); ++seed) {
      for (const RoadKind road : kRoads) specs.push_back(drive_of(with_disturbances, road, drive_s, 5000 + seed));
    }
    const double hours = static_cast<double>(specs.size()) * drive_s / 3600.0;
    Quiet quiet = drive_quietly(specs, options);
    quiet.large.then = start_distances(with_disturbances, options.seeds(600), options);
    const std::string name = with_disturbances ? "disturbed" : "clean";
    const auto rate_of = [&](const char* change, const Seen& seen, bool is_told) {
      const Tail first = tail_of(seen.maxima), then = tail_of(seen.then);
      const double suspicions = 1000.0 * first.share_beyond * static_cast<double>(seen.maxima.size()) / hours;
      const double rate = suspicions * then.share_beyond;
      table.rows.push_back({change, name, fixed(hours, 1), first.shape(), number(suspicions),
                            std::to_string(seen.then.size()) + ", " + then.shape(), number(then.share_beyond),
                            is_told ? number(rate) : "0 (" + number(rate) + " followed)"});
      return is_told ? rate : 0.0;
    };
    const double rate =
        rate_of("large", quiet.large, true) + rate_of("small", quiet.small, true) + rate_of("roll", quiet.roll, false);
    worst = std::max(worst, rate);
    told += quiet.told;
    all_hours += hours;
    report.add(curve_of(name, quiet.large.maxima));
    report.add(curve_of(name + ", small", quiet.small.maxima));
  }
  report.at_most("step_change", "false alarms told", told, 0.0, "",
                 "in " + fixed(all_hours, 1) + " h without a knock, half of them disturbed");
  report.at_most(
      "step_change", "false alarms per 1000 h of a vehicle of four radars", worst, 1.0, "",
      "the worse of clean and disturbed; extrapolated suspicions × share that would be confirmed, of large and small "
      "changes together, all from exponential tails, or as seen where that is more");
  report.add(std::move(table));
}

}  // namespace boresight::bench
