#include "services/alignment_estimator/core/batch/radar_sums.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/alignment_estimator/core/windows/curve_sums.hpp"
#include "services/alignment_estimator/core/windows/scan_model.hpp"

namespace boresight::alignment::batch {

namespace {

using namespace windows;

constexpr std::size_t kMinSightings = 4;
constexpr double kMaxGap_s = 1.0;
/// Largest standard deviations of scale and rotation that widen the gate.
constexpr double kGateScale = 0.005, kGateRotation_rad = 0.01;

/// The motion at the time that belongs to the scan. Rates within the noise of the signals would add noise.
Motion motion_at(const Point& point, const ScanMotion3d& motion, double yaw_rate_std_radps) {
  constexpr double kLeastAcceleration_mps2 = 0.5, kLeastYawAcceleration_radps2 = 0.04;
  const auto beyond = [](double value, double least) { return std::abs(value) > least ? value : 0.0; };
  const double a = beyond(motion.acceleration_mps2, kLeastAcceleration_mps2);
  const double w = beyond(motion.yaw_acceleration_radps2, kLeastYawAcceleration_radps2);
  return {.speed_mps = motion.speed_mps + point.stamp_s * a,
          .yaw_rate_radps = motion.yaw_rate_radps + point.stamp_s * w,
          .acceleration_mps2 = motion.acceleration_mps2,
          .clear_acceleration_mps2 = a,
          .clear_yaw_acceleration_radps2 = w,
          .yaw_rate_std_radps = yaw_rate_std_radps};
}

}  // namespace

Knots knots_of(const RadarConfig& radar) {
  const double half = std::max(std::abs(radar.field_of_view.azimuth_min_rad), radar.field_of_view.azimuth_max_rad);
  return {-half, 2.0 * half / (kKnots - 1)};
}

RadarSums::RadarSums(const RadarConfig& radar, const FilterConfig& config, const Priors& priors, double noise_memory_s)
    : config_(radar),
      filter_(config),
      noise_memory_s_(noise_memory_s),
      unknown_(radar, priors.rotation_std_rad),
      knots_(knots_of(radar)) {
  gate_covariance_.setZero();
}

void RadarSums::begin_pass() {
  block_.clear(Point());
  last_time_ns_ = 0;
  detections_ = stationary_ = seconds_ = 0.0;
  scans_ = inliers_ = 0;
}

void RadarSums::begin_block(const Point& point, const Solver& solver, std::size_t radar) {
  block_.clear(point);
  body_pitch_std_rad_ = solver.priors().body_pitch_std_rad;
  side_slip_std_rad_ = solver.priors().side_slip_std_rad;
  LocalMatrix p = solver.local_covariance(radar);
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    p(kFluctuating[k], kFluctuating[k]) += solver.radar(radar).fluctuation.variance[k] + solver.common().variance[k];
  }
  LocalVector cap = LocalVector::Ones();
  const auto limit = [&](int column, double std) {
    cap(column) = std::min(1.0, std / std::sqrt(p(column, column) + 1e-20));
  };
  limit(local::kSpeedScale, kGateScale);
  limit(local::kRateScale, kGateScale);
  limit(local::kRotation + 1, 2.0 * kGateRotation_rad);
  limit(local::kRotation + 2, kGateRotation_rad);
  gate_covariance_ = (cap.asDiagonal() * p * cap.asDiagonal()).topLeftCorner<local::kCurve, local::kCurve>();
  curve_variance_ = p.diagonal().segment<kKnots>(local::kCurve).mean();
}

bool RadarSums::add(const ScanDetections& scan, const ScanMotion3d& motion, const EgoSample& ego,
                    Sightings& sightings) {
  const double since_s = last_time_ns_ == 0 ? 0.0 : 1e-9 * static_cast<double>(scan.time_ns - last_time_ns_);
  const double elapsed_s = since_s > 0.0 && since_s < kMaxGap_s ? since_s : config_.cycle_time_s;
  last_time_ns_ = scan.time_ns;
  take_sightings(scan, config_, unknown_, filter_.azimuth_std_edge, noise_.angle_variance_factor(), sightings);
  if (sightings.count < kMinSightings) return false;
  const ScanModel model = model_scan(block_.point, config_.mounting_pose.position_m,
                                     motion_at(block_.point, motion, filter_.yaw_rate_std_radps));
  const auto std_of = [](double stated, double fallback) { return stated > 0.0 ? stated : fallback; };
  const MotionVariances variances{square(std_of(ego.speed_std_mps, filter_.speed_std_mps)),
                                  square(std_of(ego.yaw_rate_std_radps, filter_.yaw_rate_std_radps)),
                                  sightings.has_elevation ? square(body_pitch_std_rad_) : 0.0,
                                  square(side_slip_std_rad_)};
  CurveJudgement judgement;
  judgement.gate = filter_.outlier_gate_sigma;
  judgement.rate_factor = noise_.rate_variance_factor();
  judgement.angle_factor = noise_.angle_variance_factor();
  judgement.velocity_variance = model.by_parameter.transpose() * gate_covariance_ * model.by_parameter;
  for (int m = 0; m < kMotionErrors; ++m) {
    judgement.velocity_variance +=
        variances[static_cast<std::size_t>(m)] * model.by_motion.row(m).transpose() * model.by_motion.row(m);
  }
  judgement.curve_variance = curve_variance_;
  judgement.up = block_.point.sensor_to_vehicle.row(2).transpose();
  judgement.height_m = config_.mounting_pose.position_m[2];
  judgement.height_excess = block_.point.height_excess;
  judgement.mirror_share = block_.point.mirror_share;
  const CurveSums sums = windows::sum_scan(sightings, model.g, block_.point.curve_rad, knots_, judgement);
  efficiency_.add(sums.common, elapsed_s);
  windows::add_scan(block_, model, sums, variances, {efficiency_.of_information(), efficiency_.of_score()});
  block_.seconds += elapsed_s;
  noise_.add(sums.common, std::exp(-elapsed_s / noise_memory_s_));
  detections_ += sums.detections;
  stationary_ += sums.common.stationary;
  seconds_ += elapsed_s;
  ++scans_;
  inliers_ += static_cast<std::uint64_t>(sums.common.inliers);
  return true;
}

}  // namespace boresight::alignment::batch
