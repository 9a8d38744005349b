#include "services/alignment_estimator/core/windows/solver.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/alignment_estimator/core/windows/equations.hpp"

namespace boresight::alignment::windows {

namespace {

/// Covariance of a smooth curve over the knots: neighbours within `length_rad` are alike; its mean, weighted to the
/// middle of the view, is zero, so that it is not a yaw.
Eigen::Matrix<double, kKnots, kKnots> curve_precision(double std, double length_knots) {
  using Square = Eigen::Matrix<double, kKnots, kKnots>;
  Square alike, project = Square::Identity();
  Eigen::Matrix<double, kKnots, 1> weights;
  for (int i = 0; i < kKnots; ++i) {
    weights(i) = i == 0 || i == kKnots - 1 ? 0.5 : 1.0;
    for (int j = 0; j < kKnots; ++j)
      alike(i, j) = std::exp(-0.5 * square((i - j) / length_knots)) + (i == j ? 1e-4 : 0.0);
  }
  weights /= weights.sum();
  project.rowwise() -= weights.transpose();
  Square covariance = project * alike * project.transpose();
  covariance *= square(std) / covariance.diagonal().mean();
  covariance.diagonal().array() += 1e-6 * square(std) + 1e-16;
  return covariance.inverse();
}

}  // namespace

Solver::Solver(std::size_t radars, const Priors& priors)
    : priors_(priors),
      radars_(radars),
      work_(radars),
      border_system_(kMaxShared, kMaxShared),
      border_inverse_(kMaxShared, kMaxShared),
      border_score_(kMaxShared),
      border_step_(kMaxShared) {
  const auto scale_of = [](double std) { return std::max(std, 1e-6); };
  scale_(local::kSpeedScale) = scale_of(priors.speed_scale_std);
  scale_(local::kRateScale) = scale_of(priors.rate_scale_std);
  scale_.segment<3>(local::kRotation).setConstant(scale_of(priors.rotation_std_rad));
  scale_(local::kYawRateBias) = scale_of(priors.yaw_rate_bias_std_radps);
  scale_(local::kYawRateGain) = scale_of(priors.yaw_rate_gain_std);
  scale_(local::kSlip) = scale_of(priors.slip_std_radps2pm);
  scale_(local::kStamp) = scale_of(priors.common_stamp_std_s + priors.stamp_std_s);
  scale_.segment<2>(local::kPosition).setConstant(scale_of(priors.position_std_m));
  scale_(local::kPitchPerAcceleration) = scale_of(priors.pitch_per_acceleration_std_radps2pm);
  scale_.segment<kKnots>(local::kCurve).setConstant(scale_of(priors.curve_std_rad));
  scale_(local::kAbove) = scale_of(priors.height_excess_std);
  scale_(local::kMirror) = scale_of(priors.mirror_share_std);
  correlation_s_.fill(priors.common_correlation_s);
  median_common_std_ = priors.common_std;
  shared_covariance_.setZero();
  shared_covariance_.diagonal() << square(priors.speed_scale_std), square(priors.yaw_rate_bias_std_radps),
      square(priors.yaw_rate_gain_std), square(priors.slip_std_radps2pm),
      square(priors.pitch_per_acceleration_std_radps2pm), square(priors.common_stamp_std_s);
  shared_prior_ = shared_covariance_.diagonal().cwiseMax(1.0 / kFixedPrecision).cwiseInverse().asDiagonal();
  for (int k = 0; k < kFluctuations; ++k) {
    const auto i = static_cast<std::size_t>(k);
    common_.variance[i] = radars > 1 ? square(priors.common_std[i]) : 0.0;
  }
}

void Solver::set_prior(std::size_t radar, const Eigen::Matrix3d& nominal, bool has_elevation, double knot_step_rad) {
  RadarSolution& r = radars_[radar];
  r.state = OwnState();
  r.state.sensor_to_vehicle = nominal;
  r.prior_state = r.state;
  r.has_elevation = has_elevation;
  r.tilt_variance.setConstant(square(priors_.rotation_std_rad));
  r.pitch_variance_before = square(priors_.rotation_std_rad);
  r.prior.setZero();
  r.prior(own::kRateScale, own::kRateScale) = precision_of(priors_.rate_scale_std);
  for (int axis = 0; axis < 3; ++axis) {
    const double precision = axis == 2 || has_elevation ? precision_of(priors_.rotation_std_rad) : kFixedPrecision;
    r.prior(own::kRotation + axis, own::kRotation + axis) = precision;
  }
  r.prior(own::kAbove, own::kAbove) = has_elevation ? precision_of(priors_.height_excess_std) : kFixedPrecision;
  r.prior(own::kMirror, own::kMirror) = has_elevation ? precision_of(priors_.mirror_share_std) : kFixedPrecision;
  r.prior(own::kStamp, own::kStamp) = precision_of(priors_.stamp_std_s);
  r.prior(own::kPosition, own::kPosition) = r.prior(own::kPosition + 1, own::kPosition + 1) =
      precision_of(priors_.position_std_m);
  r.prior.block<kKnots, kKnots>(own::kCurve, own::kCurve) =
      priors_.curve_std_rad > 0.0 ? curve_precision(priors_.curve_std_rad, priors_.curve_length_rad / knot_step_rad)
                                  : kFixedPrecision * Eigen::Matrix<double, kKnots, kKnots>::Identity();
  r.drift_variance = {has_elevation ? square(priors_.drift_std_radps) : 0.0, square(priors_.drift_std_radps)};
  r.covariance = r.prior.diagonal().cwiseMax(1e-12).cwiseInverse().asDiagonal();
  r.covariance.diagonal().segment<kKnots>(own::kCurve).setConstant(square(priors_.curve_std_rad));
  r.covariance.diagonal().tail<2>() << r.drift_variance[0], r.drift_variance[1];
  r.conditional = r.covariance;
  r.with_shared.setZero();
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    r.fluctuation.variance[k] = k == 1 && !has_elevation ? 0.0 : square(priors_.own_std[k]);
    r.median_std[k] = priors_.own_std[k];
  }
}

double Solver::drift_time(double middle_s) const {
  return std::max(middle_s - time_s_, -priors_.drift_span_s);
}

double Solver::load_rad(int steps) const {
  double sum = shared_.first_load_rad;
  for (int step = 0; step < steps; ++step) sum += shared_.load_rad[static_cast<std::size_t>(step)];
  return sum;
}

void Solver::turn(std::size_t index, const Eigen::Vector3d& turn_vehicle_rad) {
  stop();
  RadarSolution& radar = radars_[index];
  OwnState& s = radar.state;
  s.sensor_to_vehicle = geometry::so3_exp(turn_vehicle_rad) * s.sensor_to_vehicle;
  s.drift_radps.setZero();
  radar.prior_state.sensor_to_vehicle = s.sensor_to_vehicle;
  radar.pitch_variance_before = square(priors_.turned_std_rad);
  radar.drift_variance = {radar.has_elevation ? square(priors_.drift_std_radps) : 0.0, square(priors_.drift_std_radps)};
  for (int axis = 0; axis < 3; ++axis) {
    const int c = own::kRotation + axis;
    const double std_rad = axis == 0 ? priors_.rotation_std_rad : priors_.turned_std_rad;
    const double precision = radar.has_elevation || axis == 2 ? precision_of(std_rad) : kFixedPrecision;
    radar.prior.row(c).setZero();
    radar.prior.col(c).setZero();
    radar.prior(c, c) = precision;
    radar.covariance.row(c).setZero();
    radar.covariance.col(c).setZero();
    radar.with_shared.row(c).setZero();
    radar.covariance(c, c) = 1.0 / precision;
    radar.conditional.row(c) = radar.covariance.row(c);
    radar.conditional.col(c) = radar.covariance.col(c);
  }
}

void Solver::remove_load(int step) {
  stop();
  for (int i = step; i + 1 < shared::kLoads; ++i) {
    shared_.load_rad[static_cast<std::size_t>(i)] = shared_.load_rad[static_cast<std::size_t>(i + 1)];
  }
  shared_.load_rad.back() = 0.0;
}

void Solver::absorb_first_load() {
  shared_.first_load_rad += shared_.load_rad.front();
  remove_load(0);
}

Point Solver::point(std::size_t radar, double time_s, int load) const {
  const OwnState& own = radars_[radar].state;
  Point p;
  const double since_s = drift_time(time_s);
  const double pitch_rad = own.drift_radps(0) * since_s + load_rad(load);
  p.speed_scale = shared_.speed_scale;
  p.rate_scale = own.rate_scale;
  p.sensor_to_vehicle = geometry::so3_exp({0.0, pitch_rad, own.drift_radps(1) * since_s}) * own.sensor_to_vehicle;
  p.yaw_rate_bias_radps = shared_.yaw_rate_bias_radps;
  p.yaw_rate_gain = shared_.yaw_rate_gain;
  p.slip_radps2pm = shared_.slip_radps2pm;
  p.stamp_s = shared_.stamp_s + own.stamp_s;
  p.position_error_m = own.position_error_m;
  p.pitch_per_acceleration_radps2pm = shared_.pitch_per_acceleration_radps2pm;
  p.curve_rad = own.curve_rad;
  p.height_excess = own.height_excess;
  p.mirror_share = own.mirror_share;
  return p;
}

MergeNoise Solver::merge_noise() const {
  MergeNoise noise;
  noise.common = common_;
  noise.roll_per_pitch = priors_.roll_per_pitch;
  noise.correlation_s = correlation_s_;
  for (std::size_t r = 0; r < radars_.size(); ++r) noise.own[r] = radars_[r].fluctuation;
  return noise;
}

void Solver::begin(double time_s) {
  // The rotations move with their drift to the new time.
  const double since_s = time_s - time_s_;
  for (RadarSolution& r : radars_) {
    const Eigen::Vector2d turn = r.state.drift_radps * since_s;
    r.state.sensor_to_vehicle = geometry::so3_exp({0.0, turn(0), turn(1)}) * r.state.sensor_to_vehicle;
  }
  time_s_ = time_s;
  stage_ = Stage::kPrior;
}

bool Solver::step(Segments& segments) {
  switch (stage_) {
    case Stage::kIdle:
      return true;
    case Stage::kPrior:
      if (segments.size() == 0) {
        stage_ = Stage::kIdle;
        return true;
      }
      begin_border(segments);
      next_ = 0;
      stage_ = Stage::kRadars;
      return false;
    case Stage::kRadars:
      gather(segments, next_);
      eliminate(next_);
      if (++next_ == radars_.size()) stage_ = Stage::kBorder;
      return false;
    case Stage::kBorder:
      solve_border();
      next_ = 0;
      stage_ = Stage::kLearn;
      return false;
    case Stage::kLearn:
      learn(segments, next_);
      if (++next_ == radars_.size()) stage_ = Stage::kCommit;
      return false;
    case Stage::kCommit:
      learn_common(segments);
      commit();
      stage_ = Stage::kIdle;
      return true;
  }
  return true;
}

void Solver::commit() {
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const Eliminated& w = work_[r];
    RadarSolution& radar = radars_[r];
    OwnState& s = radar.state;
    s.rate_scale += w.step(own::kRateScale);
    s.sensor_to_vehicle = geometry::so3_exp(w.step.segment<3>(own::kRotation)) * s.sensor_to_vehicle;
    s.stamp_s += w.step(own::kStamp);
    s.position_error_m += w.step.segment<2>(own::kPosition);
    s.curve_rad += w.step.segment<kKnots>(own::kCurve);
    s.height_excess += w.step(own::kAbove);
    s.mirror_share += w.step(own::kMirror);
    s.drift_radps += w.step.tail<2>();
    radar.covariance = w.covariance;
    radar.conditional = w.inverse;
    radar.with_shared = w.with_shared;
  }
  shared_.speed_scale += border_step_(shared::kSpeedScale);
  shared_.yaw_rate_bias_radps += border_step_(shared::kYawRateBias);
  shared_.yaw_rate_gain += border_step_(shared::kYawRateGain);
  shared_.slip_radps2pm += border_step_(shared::kSlip);
  shared_.pitch_per_acceleration_radps2pm += border_step_(shared::kPitchPerAcceleration);
  shared_.stamp_s += border_step_(shared::kStamp);
  const auto inverse = border_inverse_.topLeftCorner(border_, border_);
  for (int step = 0; step < shared::kLoads; ++step) {
    shared_.load_rad[static_cast<std::size_t>(step)] += border_step_(shared::kLoad + step);
    load_variance_[static_cast<std::size_t>(step)] = inverse(shared::kLoad + step, shared::kLoad + step);
  }
  shared_covariance_ = inverse.topLeftCorner<shared::kConstants, shared::kConstants>();
}

LocalMatrix Solver::local_covariance(std::size_t index) const {
  const RadarSolution& radar = radars_[index];
  return covariance_of_constants(radar.covariance, radar.with_shared, shared_covariance_);
}

LocalMatrix Solver::block_covariance(std::size_t index) const {
  LocalMatrix p = local_covariance(index);
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    p(kFluctuating[k], kFluctuating[k]) += radars_[index].fluctuation.variance[k] + common_.variance[k];
  }
  return p;
}

}  // namespace boresight::alignment::windows
