// Rate of reported step changes on drives without one. No simulation lasts 1000 h, so the rate is extrapolated. The
// estimator decides in two steps, suspicion and confirmation; the rate of each detector is the product of both.
// Large changes (StepChangeDetector):
// 1. Suspicion. The detector sums the excess of a radar's deviation over the limit, at most one limit per block, and
//    suspects a change at a sum of 1.5 limits. At least two successive blocks must then deviate by 1.3 limits or more
//    on average, in one direction. The statistic is the largest such average per minute and radar.
// 2. Confirmation. A new start on later data must differ from the estimate by more than its covariance allows. The
//    statistic is the squared distance of new starts from the truth. Yaw-rate bias and slip are set to zero, because
//    the estimator knows them by then.
// Small changes (SmallStepChangeDetector):
// 1. Suspicion. The statistic is the largest sum per minute and radar, divided by the limit of a suspicion.
// 2. Confirmation. The next window must deviate in the same direction. The statistic is the deviation of a window in
// the
//    direction of the sum before it, divided by the confirming limit. It includes any error of the estimate or of the
//    scene that two successive windows have in common.
// An exponential distribution is fitted to the largest tenth of each statistic; it falls more slowly than noise. It
// gives the share beyond the limit, unless the observed share is larger. The two steps use different data, so their
// rates are multiplied. The lower limit on reported changes of yaw and pitch is not credited. A change of roll is never
// reported, only followed; it has a table row of its own.
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

/// Average of two successive blocks, in units of the limit, that a suspicion needs at least.
constexpr double kNeeded = 1.3;
/// Squared distance, 3 degrees of freedom, beyond which a new start confirms a suspicion (RobustFilter).
constexpr double kConfirms = 21.1;
/// RobustFilter multiplies the statistical covariance of that start by this factor when it compares. The estimate
/// that begins from the start carries start_inflation instead.
constexpr double kConfirmInflation = 4.0;
/// The method whose detectors these are; other methods are judged by the group real_car_no_change.
constexpr const char* kTwoSteps = "boresight";
constexpr RoadKind kRoads[] = {RoadKind::kCity, RoadKind::kMotorway, RoadKind::kMixed};

struct Tail {
  double largest = 0.0;
  double level = 0.0;         ///< u₀: a tenth of the values exceed it
  double mean_excess = 0.0;   ///< over u₀
  double share_beyond = 0.0;  ///< share of values above 1: the extrapolated or the observed one, whichever is larger

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

/// Statistics of one detector, ascending.
struct Seen {
  std::vector<double> maxima;  ///< largest per minute and radar, over the limit of a suspicion
  std::vector<double> then;    ///< the following window or start, over the confirming limit

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
  double reported = 0.0;
};

/// Reads the small detector's windows of one axis of one radar.
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
      own.reported = 0.0;
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
        own.reported += filter.estimate(r).step_change.count;
      }
    };
    static_cast<void>(run_drive(specs[i], own_method(kTwoSteps).make, run_options));
    const std::lock_guard guard(lock);
    quiet.large.take(own.large);
    quiet.small.take(own.small);
    quiet.roll.take(own.roll);
    quiet.reported += own.reported;
  });
  for (Seen* const seen : {&quiet.large, &quiet.small, &quiet.roll}) seen->sort();
  return quiet;
}

/// Squared distances of new starts from the truth, over kConfirms; ascending.
std::vector<double> start_distances(bool with_disturbances, std::size_t seeds, const Options& options) {
  const alignment::FilterConfig config;
  std::vector<double> distances;
  std::mutex lock;
  parallel_for(seeds, options.jobs, [&](std::size_t i) {
    AlignmentSpec spec = drive_of(with_disturbances, kRoads[i % std::size(kRoads)], 4.0, 6000 + i);
    // A confirming start uses the yaw-rate bias and slip that the estimator knows by then.
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
    static_cast<void>(run_drive(spec, own_method(kTwoSteps).make, run_options));
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
              "drives without a step change, method `boresight`: tails of the suspicion statistic (a suspicion starts "
              "at 1) and of the "
              "confirmation statistic (confirmed at 1); a tenth of the values exceed u₀",
              {"change", "drives", "hours", "suspicion: largest, u₀, mean excess", "suspicions per 1000 h",
               "confirmation: number, largest, u₀, mean excess", "confirmed share", "reported per 1000 h"},
              {}};
  double worst = 0.0, reported = 0.0, all_hours = 0.0;
  for (const bool with_disturbances : {false, true}) {
    std::vector<AlignmentSpec> specs;
    for (std::size_t seed = 0; seed < options.seeds(2); ++seed) {
      for (const RoadKind road : kRoads) specs.push_back(drive_of(with_disturbances, road, drive_s, 5000 + seed));
    }
    const double hours = static_cast<double>(specs.size()) * drive_s / 3600.0;
    Quiet quiet = drive_quietly(specs, options);
    quiet.large.then = start_distances(with_disturbances, options.seeds(600), options);
    const std::string name = with_disturbances ? "disturbed" : "clean";
    const auto rate_of = [&](const char* change, const Seen& seen, bool is_reported) {
      const Tail first = tail_of(seen.maxima), then = tail_of(seen.then);
      const double suspicions = 1000.0 * first.share_beyond * static_cast<double>(seen.maxima.size()) / hours;
      const double rate = suspicions * then.share_beyond;
      table.rows.push_back({change, name, fixed(hours, 1), first.shape(), number(suspicions),
                            std::to_string(seen.then.size()) + ", " + then.shape(), number(then.share_beyond),
                            is_reported ? number(rate) : "0 (" + number(rate) + " followed)"});
      return is_reported ? rate : 0.0;
    };
    const double rate =
        rate_of("large", quiet.large, true) + rate_of("small", quiet.small, true) + rate_of("roll", quiet.roll, false);
    worst = std::max(worst, rate);
    reported += quiet.reported;
    all_hours += hours;
    report.add(curve_of(name, quiet.large.maxima));
    report.add(curve_of(name + ", small", quiet.small.maxima));
  }
  report.at_most("step change", "false alarms reported", reported, 0.0, "",
                 "method `boresight`, in " + fixed(all_hours, 1) + " h without a step change, half of them disturbed");
  report.at_most(
      "step change", "false alarms per 1000 h of a vehicle with four radars", worst, 1.0, "",
      "suspicion rate × confirmed share, large and small changes added, larger of clean and disturbed; exponential "
      "tails, or the observed share where it is larger");
  report.add(std::move(table));
}

}  // namespace boresight::bench
