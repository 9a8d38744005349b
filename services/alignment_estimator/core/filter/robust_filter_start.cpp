// Start of a radar's rotation: the prior of its search, and the use of the result.
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "services/alignment_estimator/core/filter/robust_filter.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

/// A suspicion that is neither confirmed nor refuted within this time is dropped.
constexpr double kMaxSuspicion_s = 20.0;

/// Column of the joint state for one of VelocityGradient.
Eigen::Index column_of(std::size_t radar, Eigen::Index touched) {
  return touched < column::kShared ? touched : column::of_radar(radar) + touched - column::kShared;
}

}  // namespace

StartPrior RobustFilter::start_prior(std::size_t index) const {
  const Radar& radar = radars_[index];
  StartPrior prior;
  // Other running radars know the speed. The speed scale of a single radar may be as wrong as its other estimates.
  const bool known = any_running_but(index);
  prior.speed_scale = known ? state_.speed_scale : 1.0;
  prior.speed_scale_variance = known ? state_.covariance(column::kSpeedScale, column::kSpeedScale) + square(1e-3)
                                     : square(config_.prior_speed_scale_std);
  // Parameters that the window does not determine keep their values.
  prior.sensor_to_vehicle =
      radar.phase == Phase::kSuspected ? radar.before_step_change : state_.sensor_to_vehicle[index];
  prior.rotation_variance = square(config_.prior_rotation_std_rad);
  const Eigen::Index noise = column::of_radar(index) + column::kAngleNoise;
  prior.log_angle_noise_std = std::sqrt(state_.covariance(noise, noise));
  prior.yaw_rate_bias_radps = state_.yaw_rate_bias_radps;
  prior.slip_radps2pm = state_.slip_radps2pm;
  const Eigen::Index elevations = column::of_radar(index) + column::kElevations;
  prior.elevation_excess = state_.elevation_excess[index];
  prior.elevation_excess_variance = known ? state_.covariance(elevations, elevations) : 0.0;
  return prior;
}

void RobustFilter::search(std::size_t index, const ScanMotion3d& motion, double elapsed_s) {
  Radar& radar = radars_[index];
  const GraduatedStart::Verdict verdict =
      radar.start.add(sightings_, radar.config.mounting_pose.position_m, motion, elapsed_s, start_prior(index),
                      radar.noise.angle_variance_factor());
  if (verdict == GraduatedStart::Verdict::kFound) {
    const StartResult& found = radar.start.result();
    if (radar.phase == Phase::kSuspected) {
      verify(index, found, radar.last_time_ns);
    } else {
      adopt(index, found);
    }
    return;
  }
  if (radar.phase == Phase::kSuspected && seconds(radar.last_time_ns - radar.suspected_ns) > kMaxSuspicion_s) {
    radar.phase = Phase::kRunning;
    radar.start.clear();
    forget_deviations(index);
  }
}

void RobustFilter::adopt(std::size_t index, const StartResult& found) {
  Radar& radar = radars_[index];
  if (!any_running_but(index)) {
    const double variance = found.covariance(0, 0);
    const double difference = found.speed_scale - state_.speed_scale;
    const double expected = variance + state_.covariance(column::kSpeedScale, column::kSpeedScale);
    // A consistent memory is better than the start; the prior is not, and a calibration leaves k_v at the prior.
    const bool scale_is_known = radar.remembered && state_.covariance(column::kSpeedScale, column::kSpeedScale) <
                                                        0.25 * square(config_.prior_speed_scale_std);
    if (!scale_is_known || square(difference) > 16.0 * expected) {
      place_speed_scale(index, found);
    }
  }
  bool agrees = false;
  if (radar.remembered) {
    const Eigen::Vector3d off =
        geometry::so3_log(found.sensor_to_vehicle * state_.sensor_to_vehicle[index].transpose());
    const Eigen::Matrix3d covariance = found.covariance.bottomRightCorner<3, 3>() + state_.rotation_covariance(index);
    const Eigen::LLT<Eigen::Matrix3d> solver(covariance);
    agrees = solver.info() == Eigen::Success && off.dot(solver.solve(off)) < kDifferentRotation;
  }
  if (!agrees) {
    if (radar.remembered) reopen(index);
    place(index, found);
  }
  radar.spread = found.spread;
  state_.lowering[index] = found.lowering;
  radar.mean_sine = found.mean_sine;
  state_.linearised[index] = state_.sensor_to_vehicle[index];
  note_linearised(index);
  radar.earlier.fill(now(index));
  radar.phase = Phase::kRunning;
  radar.remembered = false;
  radar.since_start_s = 0.0;
  radar.inlier_ratio = found.inlier_ratio;
  forget_deviations(index);
}

/// The error of k_v includes that of the parameters that the search took as known.
void RobustFilter::place_speed_scale(std::size_t index, const StartResult& found) {
  state_.speed_scale = state_.linearised_speed_scale = found.speed_scale;
  state_.set_variance(column::kSpeedScale, 0.0);
  double variance = found.covariance(0, 0);
  const auto& by = found.speed_scale_by_known;
  const auto with = [&](Eigen::Index x) {
    double sum = 0.0;
    for (Eigen::Index c = 0; c < column::kTouched; ++c) sum += by(c) * state_.covariance(column_of(index, c), x);
    return sum;
  };
  for (Eigen::Index c = 0; c < column::kTouched; ++c) variance += by(c) * with(column_of(index, c));
  for (Eigen::Index x = 0; x < state_.size(); ++x) {
    if (x != column::kSpeedScale) state_.set_covariance(column::kSpeedScale, x, with(x));
  }
  state_.set_covariance(column::kSpeedScale, column::kSpeedScale, variance);
}

/// The error of the rotation includes that of the parameters that the search took as known. Speed scale, slip, yaw-rate
/// bias, roll and the angles' noise stay correlated with it; the body motion during the window stays in it. Axes that
/// were not searched keep their values.
void RobustFilter::place(std::size_t index, const StartResult& found) {
  const Eigen::Index first = column::of_radar(index);
  const auto& by = found.by_known;
  const Eigen::Vector4d known(state_.speed_scale, state_.yaw_rate_bias_radps, state_.slip_radps2pm,
                              state_.pitch_per_acceleration_radps2pm);
  const Eigen::Vector3d turn = by.leftCols<column::kNuisances>() * (known - found.taken);
  state_.sensor_to_vehicle[index] = state_.linearised[index] = geometry::so3_exp(turn) * found.sensor_to_vehicle;
  const auto searched = [&](Eigen::Index x) {
    return x >= first && x < first + 3 && found.searched[static_cast<std::size_t>(x - first)];
  };
  for (Eigen::Index i = first; i < first + 3; ++i) {
    if (searched(i)) state_.set_variance(i, 0.0);
  }
  Eigen::Matrix3d covariance = found.rotation_covariance;
  for (Eigen::Index n = 0; n < column::kNumberOfNuisances; ++n) {
    const auto process = static_cast<std::size_t>(n);
    const double mean_share =
        std::min(1.0, 2.0 * nuisance_model_.correlation_s(process) / std::max(found.seconds, 1e-3));
    const Eigen::Vector3d turned = by.col(column::kNuisances + n);
    covariance += mean_share * nuisance_model_.variance(process) * turned * turned.transpose();
  }
  const auto with = [&](Eigen::Index x) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Eigen::Index c = 0; c < column::kTouched; ++c) {
      const bool at_an_instant = c >= column::kNuisances && c < column::kShared;
      if (!at_an_instant) sum += state_.covariance(column_of(index, c), x) * by.col(c);
    }
    return sum;
  };
  for (Eigen::Index c = 0; c < column::kTouched; ++c) {
    const bool at_an_instant = c >= column::kNuisances && c < column::kShared;
    if (!at_an_instant) covariance += with(column_of(index, c)) * by.col(c).transpose();
  }
  for (Eigen::Index x = 0; x < state_.size(); ++x) {
    if (searched(x)) continue;
    const Eigen::Vector3d shared = with(x);
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (searched(first + i)) state_.set_covariance(first + i, x, shared(i));
    }
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      if (!searched(first + i) || !searched(first + j)) continue;
      state_.set_covariance(first + i, first + j, 0.5 * (covariance(i, j) + covariance(j, i)));
    }
  }
}

/// Resets the covariance of the rotation to the prior.
void RobustFilter::reopen(std::size_t index) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    state_.set_variance(column::of_radar(index) + i, square(config_.prior_rotation_std_rad));
  }
}

}  // namespace boresight::alignment
