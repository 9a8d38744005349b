// The result of the last pass: standard deviations by jackknife, state and reason.
#include <array>
#include <cmath>

#include "services/alignment_estimator/core/batch/batch.hpp"
#include "services/alignment_estimator/core/batch/estimate_values.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"

namespace boresight::alignment::batch {

using namespace windows;

void Batch::widen_by_jackknife(std::vector<RadarEstimate>& of) const {
  constexpr int kSolutions = 2;
  const double time_s = clock_.driven_s();
  const auto loads = static_cast<int>(loads_.size());
  const int n = solved_.size();
  if (n < 2) return;
  std::vector<Values> sums(of.size(), Values::Zero()), squares(of.size(), Values::Zero());
  for (int i = 0; i < n; ++i) {
    Segments without = solved_;
    for (std::size_t r = 0; r < of.size(); ++r) without.share(i, r) = Share();
    Solver solver = solver_;
    for (int k = 0; k < kSolutions; ++k) solver.solve(without, time_s);
    const std::vector<RadarEstimate> one = estimates(solver, time_s, loads);
    for (std::size_t r = 0; r < of.size(); ++r) {
      const Eigen::Matrix3d& about = of[r].sensor_to_vehicle;
      const Values off = values_of(one[r], about) - values_of(of[r], about);
      sums[r] += off;
      squares[r] += off.cwiseAbs2();
    }
  }
  // Variance of the left-out values about their mean, times n − 1.
  const double count = n;
  for (std::size_t r = 0; r < of.size(); ++r) {
    const Values variance = (squares[r] / count - (sums[r] / count).cwiseAbs2()).cwiseMax(0.0) * (count - 1.0);
    widen(of[r], variance.cwiseSqrt());
  }
}

void Batch::finish(RadarEstimate& estimate, const Radar& radar) const {
  const RadarEstimate& start = radar.start;
  estimate.step_change = start.step_change;
  estimate.load_change = start.load_change;
  estimate.speed_change = start.speed_change;
  estimate.drift.since_ns = start.drift.since_ns;
  estimate.state = start.state;
  estimate.reason = start.reason;
  if (start.scans_used == 0) {
    estimate.observable = estimate.nuisance.observable = 0;
    return;
  }
  if (!loads_.empty()) {
    estimate.load_change.size = static_cast<float>(-solver_.shared().load_rad[loads_.size() - 1]);
  }
  if (!radar.has_elevation) {
    // Pitch and roll are held; they are known no better than before the drive.
    constexpr std::uint32_t kHeld = alignment_axis::kVehicleRoll | alignment_axis::kVehiclePitch;
    estimate.observable &= ~kHeld;
    for (const int axis : {1, 2}) {
      estimate.covariance.row(axis).setZero();
      estimate.covariance.col(axis).setZero();
      estimate.covariance(axis, axis) = square(priors_.rotation_std_rad);
    }
  }
  estimate.angle_noise_scale = radar.sums.angle_noise_scale();
  estimate.nuisance.range_rate_noise_scale = static_cast<float>(radar.sums.range_rate_noise_scale());
  const Totals& totals = radar.totals;
  estimate.inlier_ratio = totals.detections > 0.0 ? totals.stationary / totals.detections : 0.0;
  estimate.scans_used = totals.scans;
  estimate.detections_used = static_cast<std::uint64_t>(totals.inliers);
  estimate.seconds_of_drive = totals.seconds;
  constexpr double kLearntShare = 1.0 / 3.0;  // of the prior's std, as in write_solution()
  constexpr std::array<std::uint32_t, 4> kBits{alignment_axis::kSpeedScale, alignment_axis::kVehicleRoll,
                                               alignment_axis::kVehiclePitch, alignment_axis::kVehicleYaw};
  for (int i = 0; i < 4; ++i) {
    const double prior = i == 0 ? priors_.speed_scale_std : priors_.rotation_std_rad;
    if (std::sqrt(estimate.covariance(i, i)) >= kLearntShare * prior) {
      estimate.observable &= ~kBits[static_cast<std::size_t>(i)];
    }
  }
  // What contradicts the data is judged by the recursive estimator; the rest depends on the standard deviation here.
  const bool by_std = start.reason == AlignmentReason::kNone || start.reason == AlignmentReason::kLargeStd ||
                      start.reason == AlignmentReason::kShortDrive || start.reason == AlignmentReason::kNotObservable;
  if (!by_std || start.state < AlignmentState::kConverging) return;
  const bool sees_yaw = (estimate.observable & alignment_axis::kVehicleYaw) != 0;
  const bool sure = sees_yaw && std::sqrt(estimate.covariance(3, 3)) < filter_.converged_yaw_std_rad;
  estimate.state = sure ? AlignmentState::kConverged : AlignmentState::kConverging;
  estimate.reason = sure       ? AlignmentReason::kNone
                    : sees_yaw ? AlignmentReason::kLargeStd
                               : AlignmentReason::kNotObservable;
}

Result Batch::result() {
  Result result;
  result.problem = problem_;
  result.driven_s = config_.block_s * static_cast<double>(blocks_);
  result.passes = pass_;
  result.settled = settled_;
  result.before.resize(radars_.size());
  if (!problem_.empty()) {
    for (const Radar& radar : radars_) result.radars.push_back(radar.start);
    return result;
  }
  result.windows = segments_.size();
  result.radars = estimates(solver_, clock_.driven_s(), static_cast<int>(loads_.size()));
  widen_by_jackknife(result.radars);
  for (std::size_t r = 0; r < radars_.size(); ++r) finish(result.radars[r], radars_[r]);
  write_before(result);
  return result;
}

}  // namespace boresight::alignment::batch
