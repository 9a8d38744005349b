// Priors from an earlier drive, and rotations from a static calibration.
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/alignment_estimator/core/windows/solver.hpp"

namespace boresight::alignment::windows {

namespace {

constexpr double kPrecisionOfFixed = 1e18;  // of a parameter that is not estimated

/// Inverse of a covariance whose parameters with variance zero are fixed.
template <int kN>
Eigen::Matrix<double, kN, kN> precision_from(const Eigen::Matrix<double, kN, kN>& covariance) {
  constexpr double kRounding = 1e-9;  // added to each variance, relative to it
  Eigen::Matrix<double, kN, 1> inverse_std;
  for (int i = 0; i < kN; ++i) inverse_std(i) = covariance(i, i) > 0.0 ? 1.0 / std::sqrt(covariance(i, i)) : 0.0;
  Eigen::Matrix<double, kN, kN> correlation = inverse_std.asDiagonal() * covariance * inverse_std.asDiagonal();
  correlation.diagonal().setConstant(1.0 + kRounding);
  const Eigen::LLT<Eigen::Matrix<double, kN, kN>> solver(correlation);
  Eigen::Matrix<double, kN, kN> inverse = Eigen::Matrix<double, kN, kN>::Identity();
  if (solver.info() == Eigen::Success) solver.solveInPlace(inverse);
  Eigen::Matrix<double, kN, kN> precision = inverse_std.asDiagonal() * inverse * inverse_std.asDiagonal();
  for (int i = 0; i < kN; ++i) {
    if (!(covariance(i, i) > 0.0)) precision(i, i) = kPrecisionOfFixed;
  }
  return precision;
}

}  // namespace

void Solver::restore(std::size_t index, const OwnState& state, const OwnMatrix& covariance,
                     const Fluctuation& fluctuation) {
  stop();
  constexpr int kRemembered = own::kPitchDrift;
  RadarSolution& radar = radars_[index];
  radar.state = state;
  radar.state.drift_radps.setZero();
  radar.prior_state = radar.state;
  radar.fluctuation = fluctuation;
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    radar.median_std[k] = std::max(radar.median_std[k], std::sqrt(fluctuation.variance[k]));
    if (fluctuation.variance[k] > 0.0) radar.fluctuation.variance[k] = square(radar.median_std[k]);
  }
  const Eigen::Matrix<double, kRemembered, kRemembered> remembered =
      covariance.topLeftCorner<kRemembered, kRemembered>();
  radar.pitch_variance_before = std::max(remembered(own::kRotation + 1, own::kRotation + 1), 1e-12);
  radar.prior.setZero();
  radar.prior.topLeftCorner<kRemembered, kRemembered>() = precision_from<kRemembered>(remembered);
  const Eigen::Vector2d of_drift = radar.covariance.diagonal().tail<2>();
  radar.covariance.setZero();
  radar.covariance.topLeftCorner<kRemembered, kRemembered>() = remembered;
  radar.covariance.diagonal().tail<2>() = of_drift;
  radar.conditional = radar.covariance;
  radar.with_shared.setZero();
}

void Solver::restore(const SharedState& state, const SharedMatrix& covariance, const Fluctuation& common,
                     const std::array<double, kFluctuations>& correlation_s) {
  stop();
  shared_ = prior_shared_ = state;
  shared_covariance_ = covariance;
  shared_prior_ = precision_from<shared::kConstants>(covariance);
  common_ = common;
  correlation_s_ = correlation_s;
  // A short drive does not show slow fluctuations: a memory makes them larger only.
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    if (!(common.variance[k] > 0.0)) continue;
    median_common_std_[k] = std::max(median_common_std_[k], std::sqrt(common.variance[k]));
    common_.variance[k] = square(median_common_std_[k]);
  }
}

void Solver::set_rotation_prior(RadarSolution& radar, const Eigen::Matrix3d& mean, const Eigen::Matrix3d& covariance) {
  stop();
  radar.state.sensor_to_vehicle = radar.prior_state.sensor_to_vehicle = mean;
  radar.state.drift_radps.setZero();
  radar.pitch_variance_before = std::max(covariance(1, 1), 1e-12);
  Eigen::Matrix3d known = covariance;
  if (!radar.has_elevation) {
    known.topRows<2>().setZero();
    known.leftCols<2>().setZero();
  }
  // What the other parameters are known to without the rotation.
  OwnMatrix rest = radar.prior;
  rest.middleRows<3>(own::kRotation).setZero();
  rest.middleCols<3>(own::kRotation).setZero();
  const Eigen::Matrix<double, own::kCount, 3> cross = radar.prior.middleCols<3>(own::kRotation);
  const Eigen::Matrix3d own = radar.prior.block<3, 3>(own::kRotation, own::kRotation);
  rest.noalias() -= cross * own.inverse() * cross.transpose();
  rest.middleRows<3>(own::kRotation).setZero();
  rest.middleCols<3>(own::kRotation).setZero();
  radar.prior = rest;
  radar.prior.block<3, 3>(own::kRotation, own::kRotation) = precision_from<3>(known);
  radar.covariance.middleRows<3>(own::kRotation).setZero();
  radar.covariance.middleCols<3>(own::kRotation).setZero();
  radar.covariance.block<3, 3>(own::kRotation, own::kRotation) = known;
  radar.conditional.middleRows<3>(own::kRotation) = radar.covariance.middleRows<3>(own::kRotation);
  radar.conditional.middleCols<3>(own::kRotation) = radar.covariance.middleCols<3>(own::kRotation);
  radar.with_shared.middleRows<3>(own::kRotation).setZero();
}

void Solver::forget_rotation(std::size_t index, const Eigen::Matrix3d& nominal) {
  const Eigen::Vector3d variances = Eigen::Vector3d::Constant(square(priors_.rotation_std_rad));
  set_rotation_prior(radars_[index], nominal, variances.asDiagonal());
}

void Solver::seed(std::size_t index, const Eigen::Matrix3d& sensor_to_vehicle, const Eigen::Matrix3d& covariance) {
  set_rotation_prior(radars_[index], sensor_to_vehicle, covariance);
  radars_[index].tilt_variance = covariance.diagonal().head<2>();
}

}  // namespace boresight::alignment::windows
