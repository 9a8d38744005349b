#include "services/alignment_estimator/core/azimuth_1d.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "services/alignment_estimator/core/range_rate_model.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::alignment {

namespace {

constexpr std::size_t kMinCandidates = 4;
/// Feigned information is taken off this many times, since its own scatter must not pass for information either.
constexpr double kFeignedMargin = 2.0;
/// Counted detections in and around the gate that suffice for the verdict that nothing stands still.
constexpr double kEnoughToDoubt = 200.0;
constexpr int kIterations = 2;

ScanMotion motion_of(const EgoSample& ego, const RadarConfig& radar) {
  return {ego.speed_mps, ego.yaw_rate_radps, radar.mounting_pose.position_m[0], radar.mounting_pose.position_m[1]};
}

/// Tukey's biweight of a residual in units of its gate.
double tukey_weight(double residual, double gate) {
  const double t = residual / gate;
  if (std::abs(t) >= 1.0) return 0.0;
  const double v = 1.0 - t * t;
  return v * v;
}

/// Mean and variance of the cosine of an elevation that the sensor does not measure, anywhere in its field of view.
/// What stands above or below the beam's axis closes in more slowly than its azimuth says.
struct UnknownElevation {
  double mean_cosine;
  double variance;
};
UnknownElevation unknown_elevation(const FieldOfView& view) {
  const double low = view.elevation_min_rad, high = view.elevation_max_rad;
  const double width = high - low;
  if (!(width > 1e-6)) return {std::cos(low), 0.0};
  const double mean = (std::sin(high) - std::sin(low)) / width;
  const double square = 0.5 + 0.25 * (std::sin(2.0 * high) - std::sin(2.0 * low)) / width;
  return {mean, std::max(0.0, square - mean * mean)};
}

/// Derivative of (k_v, yaw) to p = k_v·(cos yaw, sin yaw).
Eigen::Matrix2d polar_gradient(double speed_scale, double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad), k = std::max(0.1, speed_scale);
  Eigen::Matrix2d gradient;
  gradient << c, s, -s / k, c / k;
  return gradient;
}

/// The matrix without its negative eigenvalues, in units of `scale`.
Eigen::Matrix2d positive_part(const Eigen::Matrix2d& matrix, const Eigen::Vector2d& scale) {
  const Eigen::Matrix2d scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(0.5 * (scaled + scaled.transpose()));
  const Eigen::Matrix2d& axes = solver.eigenvectors();
  const Eigen::Matrix2d positive = axes * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * axes.transpose();
  return scale.cwiseInverse().asDiagonal() * positive * scale.cwiseInverse().asDiagonal();
}

}  // namespace

YawFilter::YawFilter(const RadarConfig& radar, const Config& config)
    : radar_(radar), config_(config), nominal_(geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0)) {
  // At k_v = 1 and yaw = 0 the two parts of p are k_v and yaw.
  covariance_ = Eigen::Vector2d(config.prior_speed_scale_std * config.prior_speed_scale_std,
                                config.prior_yaw_std_rad * config.prior_yaw_std_rad)
                    .asDiagonal();
  prior_information_ = covariance_.inverse();
}

void YawFilter::process(const RadarScan& scan, const EgoSample& ego) {
  take_detections(scan, radar_, detections_);
  process(detections_, ego);
}

void YawFilter::process(const ScanDetections& scan, const EgoSample& ego) {
  const std::int64_t time_ns = scan.time_ns;
  const double since_last_s = last_time_ns_ == 0 ? 0.0 : static_cast<double>(time_ns - last_time_ns_) * 1e-9;
  // A recording that starts again, or a pause, is no drive; the estimate stays.
  const double elapsed_s = since_last_s > 0.0 && since_last_s < 1.0 ? since_last_s : radar_.cycle_time_s;
  last_time_ns_ = time_ns;
  if (!ego.valid || ego.stale || std::abs(ego.speed_mps) < config_.min_speed_mps) {
    state_ = std::max(state_, AlignmentState::kWaiting);
    return;
  }
  collect(scan, ego);
  if (number_of_candidates_ < kMinCandidates) {
    state_ = std::max(state_, AlignmentState::kWaiting);
    return;
  }
  drift(elapsed_s);
  update(ego);
  residuals_.fade(elapsed_s, config_.kpi_window_s);
  count_residuals(ego);
  seconds_of_drive_ += elapsed_s;
  since_start_s_ += elapsed_s;
  ++scans_used_;
  judge_scene();
  if (!stationary_seen_) {
    state_ = AlignmentState::kWaiting;
    return;
  }
  const bool sure = std::sqrt(covariance()(1, 1)) < config_.converged_yaw_std_rad &&
                    seconds_of_drive_ >= config_.min_seconds_to_converge;
  state_ = sure ? AlignmentState::kConverged : AlignmentState::kConverging;
}

void YawFilter::collect(const ScanDetections& scan, const EgoSample& ego) {
  number_of_candidates_ = scan.count;
  const UnknownElevation unknown = unknown_elevation(radar_.field_of_view);
  unknown_cosine_variance_ = scan.has_elevation ? 0.0 : unknown.variance / (unknown.mean_cosine * unknown.mean_cosine);
  const Eigen::Vector3d velocity =
      geometry::sensor_velocity(p_.norm(), ego.speed_mps, ego.yaw_rate_radps, radar_.mounting_pose.position_m);
  for (std::size_t i = 0; i < scan.count; ++i) {
    const double azimuth_std = scan.azimuth_std_rad[i], range_rate_std = scan.range_rate_std_mps[i];
    const double ca = std::cos(scan.azimuth_rad[i]), sa = std::sin(scan.azimuth_rad[i]);
    const double ce = scan.has_elevation ? std::cos(scan.elevation_rad[i]) : unknown.mean_cosine;
    const double se = std::sin(scan.elevation_rad[i]);
    Candidate& candidate = candidates_[i];
    candidate.direction = nominal_ * Eigen::Vector3d(ce * ca, ce * sa, se);
    candidate.range_rate_mps = scan.range_rate_mps[i];
    double by_elevation = velocity.dot(nominal_ * Eigen::Vector3d(-se * ca, -se * sa, ce)) * scan.elevation_std_rad[i];
    if (!scan.has_elevation)
      by_elevation = velocity.dot(nominal_ * Eigen::Vector3d(ca, sa, 0.0)) * std::sqrt(unknown.variance);
    candidate.across = nominal_ * Eigen::Vector3d(-ce * sa, ce * ca, 0.0);
    candidate.azimuth_variance = azimuth_std * azimuth_std;
    candidate.other_variance = range_rate_std * range_rate_std + by_elevation * by_elevation;
  }
}

double YawFilter::start_std_mps() const {
  return config_.start_gate_mps * std::max(0.0, 1.0 - since_start_s_ / config_.start_duration_s);
}

void YawFilter::drift(double elapsed_s) {
  const Eigen::Matrix2d before = covariance_;
  covariance_(0, 0) += config_.speed_scale_drift_per_sqrt_s * config_.speed_scale_drift_per_sqrt_s * elapsed_s;
  covariance_(1, 1) += config_.yaw_drift_rad_per_sqrt_s * config_.yaw_drift_rad_per_sqrt_s * elapsed_s;
  // Feigned information ages as the true one does.
  const Eigen::Matrix2d keep = covariance_.inverse() * before;
  feigned_ = (keep * feigned_ * keep.transpose()).eval();
}

void YawFilter::update(const EgoSample& ego) {
  const ScanMotion motion = motion_of(ego, radar_);
  const Eigen::Matrix2d prior_information = covariance_.inverse();
  const Eigen::Vector2d prior = p_;
  // An error of the ego signals that lasts for several scans counts once, not once a scan.
  const double repeats = 1.0 + 2.0 * config_.ego_error_correlation_s / radar_.cycle_time_s;
  const Eigen::Vector2d nuisance_variance(std::max(1e-8, ego.speed_std_mps * ego.speed_std_mps * repeats),
                                          std::max(1e-12, ego.yaw_rate_std_radps * ego.yaw_rate_std_radps * repeats));
  const double start_variance = start_std_mps() * start_std_mps();
  Eigen::Matrix2d information = prior_information;
  Eigen::Matrix2d feigned = Eigen::Matrix2d::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const double speed_scale = p_.norm(), yaw_rad = std::atan2(p_(1), p_(0));
    Eigen::Matrix4d to_p = Eigen::Matrix4d::Identity();
    to_p.topLeftCorner<2, 2>() = polar_gradient(speed_scale, yaw_rad).transpose();
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    feigned.setZero();
    for (std::size_t i = 0; i < number_of_candidates_; ++i) {
      const Candidate& candidate = candidates_[i];
      const RangeRatePrediction predicted = predict_range_rate(candidate.direction, motion, speed_scale, yaw_rad);
      // The prediction is linear in the direction, so that of the derivative is the derivative of the prediction.
      const RangeRatePrediction slope = predict_range_rate(candidate.across, motion, speed_scale, yaw_rad);
      const double residual = candidate.range_rate_mps - predicted.range_rate_mps;
      const double by_azimuth = slope.range_rate_mps * slope.range_rate_mps * candidate.azimuth_variance;
      const double noise_variance = candidate.other_variance + by_azimuth;
      const double own_variance = noise_variance + start_variance;
      Eigen::Vector4d gradient = to_p * predicted.gradient;
      const Eigen::Vector4d bend = to_p * slope.gradient;
      const Eigen::Vector2d g = gradient.head<2>();
      const double gate_variance =
          own_variance + g.dot(covariance_ * g) + gradient.tail<2>().cwiseAbs2().dot(nuisance_variance);
      const double weight =
          tukey_weight(residual, config_.outlier_gate_sigma * std::sqrt(gate_variance)) / own_variance;
      if (weight <= 0.0) continue;
      // The residual tells of the azimuth's error as well: the gradient belongs to the corrected line of sight. What is
      // beyond the noise is not the azimuth's.
      const double limit = 3.0 * std::sqrt(noise_variance);
      const double noise = std::clamp(residual, -limit, limit);
      gradient += bend * (noise * slope.range_rate_mps * candidate.azimuth_variance / noise_variance);
      const double left_variance = candidate.azimuth_variance * (1.0 - by_azimuth / noise_variance);
      feigned.noalias() += weight * left_variance * bend.head<2>() * bend.head<2>().transpose();
      normal.noalias() += weight * gradient * gradient.transpose();
      right.noalias() += weight * residual * gradient;
    }
    Eigen::Matrix2d nuisance = normal.bottomRightCorner<2, 2>();
    nuisance.diagonal() += nuisance_variance.cwiseInverse();
    const Eigen::Matrix2d cross = normal.topRightCorner<2, 2>() * nuisance.inverse();
    const Eigen::Matrix2d scan_information = normal.topLeftCorner<2, 2>() - cross * normal.bottomLeftCorner<2, 2>();
    const Eigen::Vector2d scan_right = right.head<2>() - cross * right.tail<2>();
    information = prior_information + 0.5 * (scan_information + scan_information.transpose());
    p_ += information.inverse() * (scan_right + prior_information * (prior - p_));
  }
  covariance_ = information.inverse();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  feigned_ += feigned;
}

void YawFilter::count_residuals(const EgoSample& ego) {
  const ScanMotion motion = motion_of(ego, radar_);
  const double speed_scale = p_.norm(), yaw_rad = std::atan2(p_(1), p_(0));
  for (std::size_t i = 0; i < number_of_candidates_; ++i) {
    const Candidate& candidate = candidates_[i];
    const double residual =
        candidate.range_rate_mps - predict_range_rate(candidate.direction, motion, speed_scale, yaw_rad).range_rate_mps;
    const double slope = predict_range_rate(candidate.across, motion, speed_scale, yaw_rad).range_rate_mps;
    const double own_std = std::sqrt(candidate.other_variance + slope * slope * candidate.azimuth_variance);
    const double gate = config_.outlier_gate_sigma * (own_std + start_std_mps());
    if (std::abs(residual) >= gate) {
      residuals_.add_outlier(std::abs(residual) < 3.0 * gate);
      continue;
    }
    residuals_.add_inlier(
        residual, candidate.range_rate_mps - predict_range_rate(candidate.direction, motion, 1.0, 0.0).range_rate_mps);
    ++detections_used_;
  }
}

void YawFilter::judge_scene() {
  if (stationary_seen_) return;
  stationary_seen_ = residuals_.stands_out();
  // A solution that was drawn from a background alone would be too sure of itself to be left again.
  if (!stationary_seen_ && since_start_s_ > config_.start_duration_s && residuals_.counted() > kEnoughToDoubt)
    restart();
}

void YawFilter::restart() {
  p_ = {1.0, 0.0};
  covariance_ = prior_information_.inverse();
  feigned_.setZero();
  since_start_s_ = 0.0;
  residuals_ = {};
}

YawFilter::Supported YawFilter::supported() const {
  const Eigen::Vector2d prior(1.0, 0.0);
  const Eigen::Matrix2d prior_covariance = prior_information_.inverse();
  if (!stationary_seen_) return {prior, prior_covariance};
  const Eigen::Vector2d scale = prior_covariance.diagonal().cwiseSqrt();
  const Eigen::Matrix2d learnt =
      positive_part(covariance_.inverse() - prior_information_ - kFeignedMargin * feigned_, scale);
  const Eigen::Matrix2d covariance = (prior_information_ + learnt).inverse();
  return {prior + covariance * learnt * (p_ - prior), covariance};
}

double YawFilter::yaw_rad() const {
  const Eigen::Vector2d p = supported().p;
  return std::atan2(p(1), p(0));
}

Eigen::Matrix2d YawFilter::covariance() const {
  const Supported known = supported();
  if (!stationary_seen_) return known.covariance;
  const double speed_scale = known.p.norm();
  const Eigen::Matrix2d polar = polar_gradient(speed_scale, std::atan2(known.p(1), known.p(0)));
  Eigen::Matrix2d published = polar * known.covariance * polar.transpose();
  published(0, 0) += config_.systematic_speed_scale_std * config_.systematic_speed_scale_std;
  published(1, 1) += config_.systematic_yaw_std_rad * config_.systematic_yaw_std_rad;
  // What stands beside a road stands at like heights: the error of the assumed mean is common to all detections, it
  // does not average out over a drive, and it is a factor of the range rates just as k_v is.
  published(0, 0) += speed_scale * speed_scale * unknown_cosine_variance_;
  return published;
}

void YawFilter::write(AlignmentEstimate& out) const {
  out.state = state_;
  out.reserved = {};
  const Eigen::Matrix2d published = covariance();
  // An axis counts as observable once the data say clearly more than the prior did.
  const auto improved = [](double variance, double prior_std) { return variance < 0.25 * prior_std * prior_std; };
  out.observable = 0;
  if (improved(published(0, 0), config_.prior_speed_scale_std)) out.observable |= alignment_axis::kSpeedScale;
  if (improved(published(1, 1), config_.prior_yaw_std_rad)) out.observable |= alignment_axis::kYaw;
  out.speed_scale = static_cast<float>(speed_scale());
  out.alignment_yaw_rad = static_cast<float>(yaw_rad());
  out.alignment_pitch_rad = 0.0F;
  out.alignment_roll_rad = 0.0F;
  out.covariance = {};
  out.covariance[0] = static_cast<float>(published(0, 0));
  out.covariance[1] = out.covariance[4] = static_cast<float>(published(0, 1));
  out.covariance[5] = static_cast<float>(published(1, 1));
  out.covariance[10] = out.covariance[15] = static_cast<float>(config_.prior_yaw_std_rad * config_.prior_yaw_std_rad);
  if (out.is_observable(alignment_axis::kYaw)) out.observable |= alignment_axis::kVehicleYaw;
  out.vehicle_yaw_rad = out.alignment_yaw_rad;
  out.vehicle_pitch_rad = out.vehicle_roll_rad = 0.0F;
  out.vehicle_covariance = out.covariance;
  out.yaw_rate_bias_radps = out.yaw_rate_bias_std_radps = 0.0F;
  out.slip_coefficient_radps2pm = out.slip_coefficient_std_radps2pm = 0.0F;
  out.angle_noise_scale = 1.0F;
  out.knock = {};
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  out.kpis.seconds_to_95_percent.fill(kUnknown);
  out.kpis.scans_to_95_percent = {};
  out.kpis.drift_per_minute.fill(kUnknown);
  out.kpis.nees = kUnknown;
  out.kpis.reserved = 0;
  residuals_.write(out.kpis);
  out.kpis.seconds_of_drive = static_cast<float>(seconds_of_drive_);
  out.kpis.scans_used = scans_used_;
  out.kpis.detections_used = detections_used_;
}

}  // namespace boresight::alignment
