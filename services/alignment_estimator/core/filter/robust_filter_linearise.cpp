// Point of linearisation (first-estimates Jacobian; Huang, Mourikis and Roumeliotis 2010;
// docs/algorithms/alignment.md (A17)).
#include <cmath>

#include "services/alignment_estimator/core/filter/robust_filter.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

constexpr double kKnownShare = 0.05, kLinearStep_rad = 5e-4;

}  // namespace

/// About known axes, the point of linearisation follows the estimate in steps large enough to matter. About other axes
/// it moves whenever the data have halved the σ. Noise along an unobservable direction never does that.
void RobustFilter::linearise(std::size_t index) {
  Eigen::Matrix3d& at = state_.linearised[index];
  const Eigen::Vector3d off = geometry::so3_log(state_.sensor_to_vehicle[index] * at.transpose());
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Index row = column::of_radar(index) + i;
    const double variance = state_.covariance(row, row);
    double& before = radars_[index].linearised_variance(i);
    const bool known = variance < square(kKnownShare * config_.prior_rotation_std_rad);
    if ((known && std::abs(off(i)) > kLinearStep_rad) || variance < 0.25 * before) {
      turn(i) = off(i);
      before = variance;
    }
  }
  const double scale_off = state_.speed_scale - state_.linearised_speed_scale;
  if (state_.covariance(column::kSpeedScale, column::kSpeedScale) <
          square(kKnownShare * config_.prior_speed_scale_std) &&
      std::abs(scale_off) > kLinearStep_rad) {
    state_.linearised_speed_scale = state_.speed_scale;
  }
  if (!turn.isZero()) at = geometry::so3_exp(turn) * at;
}

void RobustFilter::note_linearised(std::size_t index) {
  radars_[index].linearised_variance = state_.rotation_covariance(index).diagonal();
}

}  // namespace boresight::alignment
