// Reaction to a change of a mounting: suspicion, confirmation by a new start, or following a small change.
#include <algorithm>

#include <Eigen/Cholesky>

#include "services/alignment_estimator/core/filter/robust_filter.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

/// Smallest rotation that is confirmed as a step change.
constexpr double kMinStepChange_rad = 0.0044;
/// Ratio of the slow mean of a radar's deviation to its present value, beyond which the deviation is a drift.
constexpr double kDriftShare = 0.4;

}  // namespace

RobustFilter::Radar::Earlier RobustFilter::now(std::size_t index) const {
  return {state_.sensor_to_vehicle[index], state_.rotation_covariance(index).diagonal()};
}

void RobustFilter::watch(std::uint32_t suspicious, std::int64_t time_ns) {
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if ((suspicious >> r & 1u) == 0 || radars_[r].phase != Phase::kRunning) continue;
    radars_[r].drifted = drifts(r);
    radars_[r].phase = Phase::kSuspected;
    radars_[r].suspected_ns = time_ns;
    radars_[r].before_step_change = radars_[r].earlier[0].sensor_to_vehicle;
    radars_[r].start.clear();
  }
}

void RobustFilter::verify(std::size_t index, const StartResult& found, std::int64_t time_ns) {
  Radar& radar = radars_[index];
  const Eigen::Vector3d off = geometry::so3_log(found.sensor_to_vehicle * radar.before_step_change.transpose());
  // Twice the statistical σ instead of start_inflation, which serves the estimate that follows a start. Here two
  // rotations are compared, and a start with a larger error is only repeated.
  const Eigen::Matrix3d covariance =
      4.0 / config_.start_inflation * found.covariance.bottomRightCorner<3, 3>() + state_.rotation_covariance(index);
  const Eigen::LLT<Eigen::Matrix3d> solver(covariance);
  const double distance = solver.info() == Eigen::Success ? off.dot(solver.solve(off)) : 0.0;
  const bool another = distance > kDifferentRotation && off.tail<2>().norm() > kMinStepChange_rad;
  if (another) {
    reopen(index);
    place(index, found);
    note_linearised(index);
    radar.since_start_s = radar.since_earlier_s = 0.0;
    radar.earlier.fill(now(index));
    if (!radar.drifted) {
      radar.step_change.time_ns = time_ns;
      ++radar.step_change.count;
      measure_step_change(index);
    }
    radar.inlier_ratio = found.inlier_ratio;
  }
  radar.phase = Phase::kRunning;
  forget_deviations(index);
}

/// A small change needs no new start. The estimate returns to its earlier rotation, turned by the change in the last
/// window, with a covariance that admits the change; then the data move it on. The covariance also grows about axes
/// without a detected change, which may have changed as much. A detected roll is the exception: roll is detected last,
/// so a change of another axis would have been detected before.
void RobustFilter::follow(std::uint32_t changed, std::int64_t time_ns) {
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if ((changed >> r & 1u) == 0 || radars_[r].phase != Phase::kRunning) continue;
    Radar& radar = radars_[r];
    const bool tilted = small_step_changes_.changed(r, 1) || small_step_changes_.changed(r, 2);
    double size_squared = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (small_step_changes_.changed(r, a))
        size_squared += square(small_step_changes_.change(r)(static_cast<Eigen::Index>(a)));
    }
    // Shortly after another change, the earlier rotation is no better.
    const bool again = radar.since_change_s < static_cast<double>(radar.earlier.size()) * kEarlier_s;
    const Radar::Earlier before = again ? now(r) : radar.earlier[0];
    if (tilted) {
      Eigen::Vector3d turn = geometry::so3_log(before.sensor_to_vehicle * state_.sensor_to_vehicle[r].transpose());
      for (std::size_t a = 1; a < 3; ++a) {
        const auto i = static_cast<Eigen::Index>(a);
        if (small_step_changes_.changed(r, a)) turn(i) = small_step_changes_.change(r)(i);
      }
      state_.sensor_to_vehicle[r] = state_.linearised[r] = geometry::so3_exp(turn) * state_.sensor_to_vehicle[r];
      radar.since_change_s = 0.0;
    }
    for (Eigen::Index i = 0; i < (tilted ? 3 : 1); ++i) {
      const Eigen::Index row = column::of_radar(r) + i;
      const double variance = state_.covariance(row, row);
      const double wanted =
          std::min(std::max(variance, before.variance(i)) + size_squared, square(config_.prior_rotation_std_rad));
      state_.add_variance(row, std::max(0.0, wanted - variance));
    }
    note_linearised(r);
    // A window for roll is too long to separate a sudden change from a drift.
    if (tilted && size_squared > square(config_.step_change_least_rad) && !drifts(r)) {
      radar.before_step_change = before.sensor_to_vehicle;
      radar.since_start_s = 0.0;
      radar.step_change.time_ns = time_ns;
      ++radar.step_change.count;
      measure_step_change(r);
    }
    radar.earlier.fill(now(r));
    radar.since_earlier_s = 0.0;
    forget_deviations(r);
  }
}

void RobustFilter::measure_step_change(std::size_t index) {
  Radar& radar = radars_[index];
  const Eigen::Vector3d turn =
      geometry::so3_log(state_.sensor_to_vehicle[index] * radar.before_step_change.transpose());
  for (std::size_t i = 0; i < 3; ++i) {
    radar.step_change.rotation_vehicle_rad[i] = static_cast<float>(turn(static_cast<Eigen::Index>(i)));
  }
}

/// A deviation that grew over a minute is a drift: followed, but not reported as a step change.
bool RobustFilter::drifts(std::size_t index) const {
  const Eigen::Vector2d& own = step_changes_.deviation(index);
  return !step_changes_.collapsed(index) && own.dot(step_changes_.drift(index)) > kDriftShare * own.squaredNorm();
}

void RobustFilter::forget_deviations(std::size_t index) {
  step_changes_.clear(index);
  small_step_changes_.clear(index);
}

}  // namespace boresight::alignment
