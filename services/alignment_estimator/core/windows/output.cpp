#include "services/alignment_estimator/core/windows/output.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/estimation/unknown_elevation.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment::windows {

namespace {

/// A standard deviation below this share of the prior's is learnt from the drive.
constexpr double kLearntShare = 1.0 / 3.0, kNuisanceShare = 1.0 / 2.0;

bool is_learnt(double variance, double prior_std, double share) {
  return prior_std > 0.0 && variance < square(prior_std * share);
}

AlignmentValue value_of(double value, double variance, double prior_std) {
  return {static_cast<float>(value), prior_std > 0.0 ? static_cast<float>(std::sqrt(variance)) : 0.0F};
}

/// Covariance of the scale that a radar sees, k_v·(1 + e), and its rotation with its own parameters.
Eigen::Matrix<double, 4, own::kCount> with_own(const Solver& solver, const RadarSolution& radar) {
  const double by_speed = 1.0 + radar.state.rate_scale, by_rate = solver.shared().speed_scale;
  Eigen::Matrix<double, 4, own::kCount> rows;
  rows.row(0) = by_speed * radar.with_shared.col(shared::kSpeedScale).transpose() +
                by_rate * radar.covariance.row(own::kRateScale);
  rows.bottomRows<3>() = radar.covariance.middleRows<3>(own::kRotation);
  return rows;
}

void write_nuisance(const Solver& solver, const RadarSolution& radar, int load, const Knots& knots,
                    AlignmentNuisance& out) {
  const Priors& priors = solver.priors();
  const SharedState& shared = solver.shared();
  const SharedMatrix& common = solver.shared_covariance();
  const auto own_variance = [&](int c) { return radar.covariance(c, c); };
  out = {};
  const auto take = [&](AlignmentValue& to, double value, double variance, double prior_std, std::uint32_t bit) {
    to = value_of(value, variance, prior_std);
    if (is_learnt(variance, prior_std, kNuisanceShare)) out.observable |= bit;
  };
  take(out.range_rate_scale, radar.state.rate_scale, own_variance(own::kRateScale), priors.rate_scale_std,
       alignment_nuisance::kRangeRateScale);
  const double stamp_variance = own_variance(own::kStamp) + common(shared::kStamp, shared::kStamp) +
                                2.0 * radar.with_shared(own::kStamp, shared::kStamp);
  take(out.time_offset_s, radar.state.stamp_s + shared.stamp_s, stamp_variance,
       std::hypot(priors.stamp_std_s, priors.common_stamp_std_s), alignment_nuisance::kTimeOffset);
  take(out.position_x_m, radar.state.position_error_m.x(), own_variance(own::kPosition), priors.position_std_m,
       alignment_nuisance::kPositionX);
  take(out.position_y_m, radar.state.position_error_m.y(), own_variance(own::kPosition + 1), priors.position_std_m,
       alignment_nuisance::kPositionY);
  take(out.yaw_rate_gain, shared.yaw_rate_gain, common(shared::kYawRateGain, shared::kYawRateGain),
       priors.yaw_rate_gain_std, alignment_nuisance::kYawRateGain);
  take(out.pitch_per_acceleration_radps2pm, shared.pitch_per_acceleration_radps2pm,
       common(shared::kPitchPerAcceleration, shared::kPitchPerAcceleration), priors.pitch_per_acceleration_std_radps2pm,
       alignment_nuisance::kPitchPerAcceleration);
  double load_variance = 0.0;
  for (int step = 0; step < load; ++step) load_variance += solver.load_variance(step);
  take(out.load_pitch_rad, -solver.load_rad(load), load_variance, priors.load_std_rad, alignment_nuisance::kLoadPitch);
  if (is_learnt(common(shared::kYawRateBias, shared::kYawRateBias), priors.yaw_rate_bias_std_radps, kNuisanceShare)) {
    out.observable |= alignment_nuisance::kYawRateBias;
  }
  if (is_learnt(common(shared::kSlip, shared::kSlip), priors.slip_std_radps2pm, kNuisanceShare)) {
    out.observable |= alignment_nuisance::kSlip;
  }
  out.yaw_scatter_rad = static_cast<float>(std::sqrt(radar.fluctuation.variance[0]));
  out.pitch_scatter_rad = static_cast<float>(std::sqrt(radar.fluctuation.variance[1]));
  if (!(priors.curve_std_rad > 0.0)) return;
  double curve_variance = 0.0;
  for (int k = 0; k < kKnots; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double variance = own_variance(own::kCurve + k);
    curve_variance += variance / kKnots;
    out.azimuth_curve_rad[i] = static_cast<float>(radar.state.curve_rad(k));
    out.azimuth_curve_std_rad[i] = static_cast<float>(std::sqrt(variance));
  }
  if (is_learnt(curve_variance, priors.curve_std_rad, kNuisanceShare)) {
    out.observable |= alignment_nuisance::kAzimuthCurve;
  }
  out.azimuth_curve_first_rad = static_cast<float>(knots.first_rad);
  out.azimuth_curve_step_rad = static_cast<float>(knots.step_rad);
}

}  // namespace

double lasting_pitch_variance(const Priors& priors, const RadarSolution& radar) {
  if (!radar.has_elevation) return 0.0;
  const double known_before = radar.covariance(own::kRotation + 1, own::kRotation + 1) / radar.pitch_variance_before;
  return square(priors.lasting_pitch) * radar.fluctuation.variance[1] * std::clamp(1.0 - known_before, 0.0, 1.0);
}

void write_solution(const Solver& solver, std::size_t index, double time_s, int load, const Knots& knots,
                    const Eigen::Matrix3d& linearised, const Unmeasured& unmeasured, RadarEstimate& out) {
  const Priors& priors = solver.priors();
  const RadarSolution& radar = solver.radar(index);
  const double by_speed = 1.0 + radar.state.rate_scale, by_rate = solver.shared().speed_scale;
  out.speed_scale = by_rate * by_speed;
  const Point now = solver.point(index, time_s, load);
  const Eigen::Matrix3d unloaded = geometry::so3_exp({0.0, -solver.load_rad(load), 0.0});
  // Heights are taken away where the solution is linear. Composed with a rotation that contains an uncertain roll, they
  // would change yaw.
  const Eigen::Matrix3d origin = unloaded * linearised;
  Eigen::Vector3d rotation = geometry::so3_log(unloaded * now.sensor_to_vehicle * origin.transpose());
  const Eigen::Matrix<double, 4, own::kCount> rows = with_own(solver, radar);
  out.covariance.bottomRows<3>().leftCols<1>() =
      by_speed * radar.with_shared.block<3, 1>(own::kRotation, shared::kSpeedScale) +
      by_rate * radar.covariance.block<3, 1>(own::kRotation, own::kRateScale);
  out.covariance.row(0).tail<3>() = out.covariance.col(0).tail<3>().transpose();
  out.covariance.bottomRightCorner<3, 3>() = radar.covariance.block<3, 3>(own::kRotation, own::kRotation);
  out.covariance(0, 0) = square(by_speed) * solver.shared_covariance()(shared::kSpeedScale, shared::kSpeedScale) +
                         square(by_rate) * radar.covariance(own::kRateScale, own::kRateScale) +
                         2.0 * by_speed * by_rate * radar.with_shared(own::kRateScale, shared::kSpeedScale);
  // Heights over the road: that they exceed the detections' is not known. The estimate is the one without an excess;
  // what the excess would change is a tolerance, and so is the share of mirror images.
  const double above_variance = radar.covariance(own::kAbove, own::kAbove);
  if (above_variance > 1e-12) {
    const Eigen::Vector4d by_above = rows.col(own::kAbove) / above_variance;
    const Eigen::Vector4d change = by_above * radar.state.height_excess;
    out.speed_scale -= change(0);
    rotation -= change.tail<3>();
    out.covariance += change * change.transpose() - above_variance * by_above * by_above.transpose();
    // Along another direction of driving the same reflectors would tilt the radar about another axis.
    const Eigen::Vector4d across(0.0, -change(2), change(1), 0.0);
    out.covariance += across * across.transpose();
  }
  out.sensor_to_vehicle = geometry::so3_exp(rotation) * origin;
  out.covariance(2, 2) += lasting_pitch_variance(priors, radar);
  const double mirror_variance = radar.covariance(own::kMirror, own::kMirror);
  if (mirror_variance > 1e-9) {
    const Eigen::Vector4d by_mirror = rows.col(own::kMirror) / mirror_variance;
    out.covariance += square(priors.mirror_share_tolerance) * by_mirror * by_mirror.transpose();
  }
  if (!radar.has_elevation) {
    // Pitch and roll were taken as nominal. They are not known, and together they turn yaw: by half of their product,
    // and by the mean elevation times the tilt of the line of sight.
    const double roll = radar.tilt_variance(0), pitch = radar.tilt_variance(1);
    out.covariance.middleRows<2>(1).setZero();
    out.covariance.middleCols<2>(1).setZero();
    out.covariance(1, 1) = roll;
    out.covariance(2, 2) = pitch;
    const Eigen::Vector2d ahead = out.sensor_to_vehicle.topLeftCorner<2, 1>().normalized();
    const double tilt = square(ahead.x()) * roll + square(ahead.y()) * pitch;
    const double mean_square = square(unmeasured.mean_sine) * (1.0 + square(kElevationExcessStd));
    out.covariance(3, 3) += mean_square * tilt + 0.25 * roll * pitch;
    out.covariance(0, 0) += 2.0 * square(out.speed_scale * unmeasured.lowering * kElevationExcessStd);
  }
  out.observable = 0;
  const std::array<std::uint32_t, 4> bits{alignment_axis::kSpeedScale, alignment_axis::kVehicleRoll,
                                          alignment_axis::kVehiclePitch, alignment_axis::kVehicleYaw};
  for (int i = 0; i < 4; ++i) {
    const double prior_std = i == 0 ? priors.speed_scale_std : priors.rotation_std_rad;
    if (is_learnt(out.covariance(i, i), prior_std, kLearntShare)) out.observable |= bits[static_cast<std::size_t>(i)];
  }
  const SharedMatrix& common = solver.shared_covariance();
  out.yaw_rate_bias_radps = solver.shared().yaw_rate_bias_radps;
  const auto std_of = [&](int c, double prior_std) { return prior_std > 0.0 ? std::sqrt(common(c, c)) : 0.0; };
  out.yaw_rate_bias_std_radps = std_of(shared::kYawRateBias, priors.yaw_rate_bias_std_radps);
  out.slip_coefficient_radps2pm = solver.shared().slip_radps2pm;
  out.slip_coefficient_std_radps2pm = std_of(shared::kSlip, priors.slip_std_radps2pm);
  write_nuisance(solver, radar, load, knots, out.nuisance);
  const Eigen::Vector2d drift = radar.state.drift_radps;
  out.drift.pitch_radps = static_cast<float>(-drift(0));
  out.drift.yaw_radps = static_cast<float>(drift(1));
  const auto drift_std = [&](int c) {
    return priors.drift_std_radps > 0.0 ? static_cast<float>(std::sqrt(radar.covariance(c, c))) : 0.0F;
  };
  out.drift.pitch_std_radps = radar.has_elevation ? drift_std(own::kPitchDrift) : 0.0F;
  out.drift.yaw_std_radps = drift_std(own::kYawDrift);
}

}  // namespace boresight::alignment::windows
