#include "services/alignment_estimator/core/azimuth_1d.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "services/alignment_estimator/core/range_rate_model.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::alignment {

namespace {

constexpr std::size_t kMinCandidates = 4;
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

bool all_finite(double a, double b, double c, double d) {
  return std::isfinite(a) && std::isfinite(b) && std::isfinite(c) && std::isfinite(d);
}

}  // namespace

Azimuth1d::Azimuth1d(const RadarConfig& radar, const Config& config)
    : radar_(radar), config_(config), nominal_(geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0)) {
  covariance_ = Eigen::Vector2d(config.prior_speed_scale_std * config.prior_speed_scale_std,
                                config.prior_yaw_std_rad * config.prior_yaw_std_rad)
                    .asDiagonal();
}

void Azimuth1d::process(const RadarScan& scan, const EgoSample& ego) {
  const std::int64_t time_ns = scan.header.measurement_time_ns;
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
  update(ego, elapsed_s);
  residuals_.fade(elapsed_s, config_.kpi_window_s);
  count_residuals(ego);
  seconds_of_drive_ += elapsed_s;
  ++scans_used_;
  const bool sure = std::sqrt(covariance()(1, 1)) < config_.converged_yaw_std_rad &&
                    seconds_of_drive_ >= config_.min_seconds_to_converge;
  state_ = sure ? AlignmentState::kConverged : AlignmentState::kConverging;
}

void Azimuth1d::collect(const RadarScan& scan, const EgoSample& ego) {
  number_of_candidates_ = 0;
  const bool has_elevation = scan.has(scan_field::kElevation);
  const bool has_stds = scan.has(scan_field::kStds);
  const UnknownElevation unknown = unknown_elevation(radar_.field_of_view);
  unknown_cosine_variance_ = has_elevation ? 0.0 : unknown.variance / (unknown.mean_cosine * unknown.mean_cosine);
  const Eigen::Vector3d velocity =
      geometry::sensor_velocity(x_(0), ego.speed_mps, ego.yaw_rate_radps, radar_.mounting_pose.position_m);
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (std::size_t i = 0; i < count; ++i) {
    if ((scan.detection_flags[i] & (detection_flag::kInvalid | detection_flag::kAmbiguous)) != 0) continue;
    const double azimuth = scan.azimuth_rad[i];
    const double elevation = has_elevation ? scan.elevation_rad[i] : 0.0F;
    const double range_rate = scan.range_rate_mps[i];
    if (!all_finite(azimuth, elevation, range_rate, 0.0)) continue;
    double azimuth_std = has_stds ? scan.azimuth_std_rad[i] : radar_.noise.azimuth_std_rad;
    double elevation_std = has_stds && has_elevation ? scan.elevation_std_rad[i] : radar_.noise.elevation_std_rad;
    double range_rate_std = has_stds ? scan.range_rate_std_mps[i] : radar_.noise.range_rate_std_mps;
    if (!(azimuth_std > 0.0)) azimuth_std = radar_.noise.azimuth_std_rad;
    if (!(elevation_std > 0.0)) elevation_std = radar_.noise.elevation_std_rad;
    if (!(range_rate_std > 0.0)) range_rate_std = radar_.noise.range_rate_std_mps;
    if (!all_finite(azimuth_std, elevation_std, range_rate_std, 0.0)) continue;
    const double ca = std::cos(azimuth), sa = std::sin(azimuth);
    const double ce = has_elevation ? std::cos(elevation) : unknown.mean_cosine, se = std::sin(elevation);
    Candidate& candidate = candidates_[number_of_candidates_++];
    candidate.direction = nominal_ * Eigen::Vector3d(ce * ca, ce * sa, se);
    candidate.range_rate_mps = range_rate;
    const double by_azimuth = velocity.dot(nominal_ * Eigen::Vector3d(-ce * sa, ce * ca, 0.0)) * azimuth_std;
    double by_elevation = velocity.dot(nominal_ * Eigen::Vector3d(-se * ca, -se * sa, ce)) * elevation_std;
    if (!has_elevation)
      by_elevation = velocity.dot(nominal_ * Eigen::Vector3d(ca, sa, 0.0)) * std::sqrt(unknown.variance);
    candidate.variance = range_rate_std * range_rate_std + by_azimuth * by_azimuth + by_elevation * by_elevation;
  }
}

double Azimuth1d::start_std_mps() const {
  return config_.start_gate_mps * std::max(0.0, 1.0 - seconds_of_drive_ / config_.start_duration_s);
}

void Azimuth1d::update(const EgoSample& ego, double elapsed_s) {
  covariance_(0, 0) += config_.speed_scale_drift_per_sqrt_s * config_.speed_scale_drift_per_sqrt_s * elapsed_s;
  covariance_(1, 1) += config_.yaw_drift_rad_per_sqrt_s * config_.yaw_drift_rad_per_sqrt_s * elapsed_s;
  const ScanMotion motion = motion_of(ego, radar_);
  const Eigen::Matrix2d prior_information = covariance_.inverse();
  const Eigen::Vector2d prior = x_;
  // An error of the ego signals that lasts for several scans counts once, not once a scan.
  const double repeats = 1.0 + 2.0 * config_.ego_error_correlation_s / radar_.cycle_time_s;
  const Eigen::Vector2d nuisance_variance(std::max(1e-8, ego.speed_std_mps * ego.speed_std_mps * repeats),
                                          std::max(1e-12, ego.yaw_rate_std_radps * ego.yaw_rate_std_radps * repeats));
  const double start_variance = start_std_mps() * start_std_mps();
  Eigen::Matrix2d information = prior_information;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t i = 0; i < number_of_candidates_; ++i) {
      const Candidate& candidate = candidates_[i];
      const RangeRatePrediction p = predict_range_rate(candidate.direction, motion, x_(0), x_(1));
      const double residual = candidate.range_rate_mps - p.range_rate_mps;
      const Eigen::Vector2d g = p.gradient.head<2>();
      const Eigen::Vector2d n = p.gradient.tail<2>();
      const double own_variance = candidate.variance + start_variance;
      const double gate_variance = own_variance + g.dot(covariance_ * g) + n.cwiseAbs2().dot(nuisance_variance);
      const double weight =
          tukey_weight(residual, config_.outlier_gate_sigma * std::sqrt(gate_variance)) / own_variance;
      if (weight <= 0.0) continue;
      normal.noalias() += weight * p.gradient * p.gradient.transpose();
      right.noalias() += weight * residual * p.gradient;
    }
    Eigen::Matrix2d nuisance = normal.bottomRightCorner<2, 2>();
    nuisance.diagonal() += nuisance_variance.cwiseInverse();
    const Eigen::Matrix2d cross = normal.topRightCorner<2, 2>() * nuisance.inverse();
    const Eigen::Matrix2d scan_information = normal.topLeftCorner<2, 2>() - cross * normal.bottomLeftCorner<2, 2>();
    const Eigen::Vector2d scan_right = right.head<2>() - cross * right.tail<2>();
    information = prior_information + 0.5 * (scan_information + scan_information.transpose());
    x_ += information.inverse() * (scan_right + prior_information * (prior - x_));
  }
  covariance_ = information.inverse();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
}

void Azimuth1d::count_residuals(const EgoSample& ego) {
  const ScanMotion motion = motion_of(ego, radar_);
  for (std::size_t i = 0; i < number_of_candidates_; ++i) {
    const Candidate& candidate = candidates_[i];
    const double residual =
        candidate.range_rate_mps - predict_range_rate(candidate.direction, motion, x_(0), x_(1)).range_rate_mps;
    const double gate = config_.outlier_gate_sigma * (std::sqrt(candidate.variance) + start_std_mps());
    if (std::abs(residual) >= gate) {
      residuals_.add_outlier();
      continue;
    }
    residuals_.add_inlier(
        residual, candidate.range_rate_mps - predict_range_rate(candidate.direction, motion, 1.0, 0.0).range_rate_mps);
    ++detections_used_;
  }
}

Eigen::Matrix2d Azimuth1d::covariance() const {
  Eigen::Matrix2d published = covariance_;
  published(0, 0) += config_.systematic_speed_scale_std * config_.systematic_speed_scale_std;
  // What stands beside a road stands at like heights: the error of the assumed mean is common to all detections, it
  // does not average out over a drive, and it is a factor of the range rates just as k_v is.
  published(0, 0) += x_(0) * x_(0) * unknown_cosine_variance_;
  published(1, 1) += config_.systematic_yaw_std_rad * config_.systematic_yaw_std_rad;
  return published;
}

void Azimuth1d::write(AlignmentEstimate& out) const {
  out.state = state_;
  out.reserved = {};
  const Eigen::Matrix2d published = covariance();
  // An axis counts as observable once the data say clearly more than the prior did.
  const auto improved = [](double variance, double prior_std) { return variance < 0.25 * prior_std * prior_std; };
  out.observable = 0;
  if (improved(published(0, 0), config_.prior_speed_scale_std)) out.observable |= alignment_axis::kSpeedScale;
  if (improved(published(1, 1), config_.prior_yaw_std_rad)) out.observable |= alignment_axis::kYaw;
  out.speed_scale = static_cast<float>(x_(0));
  out.alignment_yaw_rad = static_cast<float>(x_(1));
  out.alignment_pitch_rad = 0.0F;
  out.alignment_roll_rad = 0.0F;
  out.covariance = {};
  out.covariance[0] = static_cast<float>(published(0, 0));
  out.covariance[1] = out.covariance[4] = static_cast<float>(published(0, 1));
  out.covariance[5] = static_cast<float>(published(1, 1));
  out.covariance[10] = out.covariance[15] = static_cast<float>(config_.prior_yaw_std_rad * config_.prior_yaw_std_rad);
  residuals_.write(out.kpis);
  out.kpis.seconds_of_drive = static_cast<float>(seconds_of_drive_);
  out.kpis.scans_used = scans_used_;
  out.kpis.detections_used = detections_used_;
}

}  // namespace boresight::alignment
