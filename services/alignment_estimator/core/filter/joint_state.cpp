#include "services/alignment_estimator/core/filter/joint_state.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

JointState::JointState(std::size_t radars) : radars_(std::min(radars, kMaxRadars)), size_(column::of_radar(radars_)) {
  sensor_to_vehicle.fill(Eigen::Matrix3d::Identity());
  linearised.fill(Eigen::Matrix3d::Identity());
  p_.setZero(size_, size_);
  pg_.setZero(size_, 3);
  pgx_.setZero(size_, 3);
  c_.setZero();
}

void JointState::set_variance(Eigen::Index index, double variance) {
  p_.row(index).setZero();
  p_.col(index).setZero();
  p_(index, index) = variance;
}

void JointState::decay(Eigen::Index index, double keep, double added_variance) {
  p_.row(index) *= keep;
  p_.col(index) *= keep;
  p_(index, index) += added_variance;
}

void JointState::project(std::size_t radar, const VelocityGradient& gradient) {
  pg_.noalias() = p_.leftCols<column::kShared>().lazyProduct(gradient.topRows<column::kShared>());
  const Eigen::Index first = column::of_radar(radar);
  pg_.noalias() += p_.middleCols<column::kPerRadar>(first).lazyProduct(gradient.bottomRows<column::kPerRadar>());
  c_.noalias() = gradient.topRows<column::kShared>().transpose() * pg_.topRows<column::kShared>();
  c_.noalias() += gradient.bottomRows<column::kPerRadar>().transpose() * pg_.middleRows<column::kPerRadar>(first);
  c_ = (0.5 * (c_ + c_.transpose())).eval();
}

bool JointState::update(const Eigen::Matrix3d& information, const Eigen::Vector3d& score) {
  // P′ = P − P·G·X·Gᵀ·P with X = (M⁻¹ + C)⁻¹ = M·(1 + C·M)⁻¹, in a form that allows a singular M.
  const Eigen::Matrix3d inverse = (Eigen::Matrix3d::Identity() + c_ * information).inverse();
  Eigen::Matrix3d x = information * inverse;
  x = (0.5 * (x + x.transpose())).eval();
  const Eigen::Vector3d reduced = score - x * (c_ * score);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, column::kMax, 1> step = pg_.lazyProduct(reduced);
  if (!x.allFinite() || !step.allFinite()) return false;
  // An update of more than half a radian is not plausible.
  for (std::size_t r = 0; r < radars_; ++r) {
    if (!(step.segment<3>(column::of_radar(r)).cwiseAbs().maxCoeff() < 0.5)) return false;
  }
  if (!(std::abs(step(column::kSpeedScale)) < 0.3)) return false;
  pgx_.noalias() = pg_.lazyProduct(x);
  p_.noalias() -= pgx_.lazyProduct(pg_.transpose());
  move(step);
  return true;
}

void JointState::condition(Eigen::Index index, double shift, double variance) {
  const double before = p_(index, index);
  if (!(before > 0.0) || !(variance > 0.0) || !(variance <= before) || !std::isfinite(shift)) return;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, column::kMax, 1>;
  const Column gain = p_.col(index) / before;
  p_.noalias() -= (before - variance) * gain.lazyProduct(gain.transpose());
  p_(index, index) = variance;
  move(shift * gain);
}

void JointState::move(const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, column::kMax, 1>& step) {
  speed_scale += step(column::kSpeedScale);
  yaw_rate_bias_radps += step(column::kYawRateBias);
  slip_radps2pm += step(column::kSlip);
  pitch_per_acceleration_radps2pm += step(column::kPitchPerAcceleration);
  nuisances += step.segment<column::kNumberOfNuisances>(column::kNuisances);
  for (std::size_t r = 0; r < radars_; ++r) {
    const Eigen::Index first = column::of_radar(r);
    sensor_to_vehicle[r] = geometry::so3_exp(step.segment<3>(first)) * sensor_to_vehicle[r];
    elevation_excess[r] += step(first + column::kElevations);
    log_angle_noise[r] += step(first + column::kAngleNoise);
  }
}

}  // namespace boresight::alignment
