#include "services/alignment_estimator/core/windows/radar_sums.hpp"

#include <algorithm>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/alignment_estimator/core/windows/curve_sums.hpp"

namespace boresight::alignment::windows {

namespace {

/// Four parameters follow from four range rates.
constexpr std::size_t kMinSightings = 4;
/// After a longer pause a scan stands for its own cycle only.
constexpr double kMaxGap_s = 1.0;

Knots knots_of(const RadarConfig& radar) {
  const double half = std::max(std::abs(radar.field_of_view.azimuth_min_rad), radar.field_of_view.azimuth_max_rad);
  return {-half, 2.0 * half / (kKnots - 1)};
}

/// The motion at the time that belongs to the scan. Rates within the noise of the signals would add noise.
Motion motion_at(const Point& point, const ScanMotion3d& motion, const SumsConfig& config, double yaw_rate_std_radps) {
  const auto beyond = [](double value, double least) { return std::abs(value) > least ? value : 0.0; };
  const double a = beyond(motion.acceleration_mps2, config.clear_acceleration_mps2);
  const double w = beyond(motion.yaw_acceleration_radps2, config.clear_yaw_acceleration_radps2);
  return {.speed_mps = motion.speed_mps + point.stamp_s * a,
          .yaw_rate_radps = motion.yaw_rate_radps + point.stamp_s * w,
          .acceleration_mps2 = motion.acceleration_mps2,
          .clear_acceleration_mps2 = a,
          .clear_yaw_acceleration_radps2 = w,
          .yaw_rate_std_radps = yaw_rate_std_radps};
}

}  // namespace

RadarSums::RadarSums(const RadarConfig& radar, const FilterConfig& filter, const Priors& priors,
                     const SumsConfig& config)
    : radar_(radar),
      filter_(filter),
      config_(config),
      body_pitch_variance_(square(priors.body_pitch_std_rad)),
      side_slip_variance_(square(priors.side_slip_std_rad)),
      unknown_(radar, priors.rotation_std_rad),
      knots_(knots_of(radar)) {
  gate_covariance_.setZero();
}

double RadarSums::elapsed_s(std::int64_t time_ns) {
  const double since_s = last_time_ns_ == 0 ? 0.0 : 1e-9 * static_cast<double>(time_ns - last_time_ns_);
  last_time_ns_ = time_ns;
  return since_s > 0.0 && since_s < kMaxGap_s ? since_s : radar_.cycle_time_s;
}

bool RadarSums::take(const ScanDetections& scan, Sightings& sightings) const {
  take_sightings(scan, radar_, unknown_, filter_.azimuth_std_edge, learnt_.noise.angle_variance_factor(), sightings);
  return sightings.count >= kMinSightings;
}

void RadarSums::begin_block(const Point& point, const Point& derivatives_at, const LocalMatrix& covariance,
                            bool is_start) {
  block_.clear(point);
  derivatives_at_ = derivatives_at;
  LocalVector cap = LocalVector::Ones();
  const auto limit = [&](int column, double std) {
    cap(column) = std::min(1.0, std / std::sqrt(covariance(column, column) + 1e-20));
  };
  limit(local::kSpeedScale, is_start ? config_.start_gate_scale : config_.gate_scale);
  limit(local::kRateScale, config_.gate_scale);
  limit(local::kRotation + 1, 2.0 * config_.gate_yaw_rad);
  limit(local::kRotation + 2, config_.gate_yaw_rad);
  gate_covariance_ = (cap.asDiagonal() * covariance * cap.asDiagonal()).topLeftCorner<local::kCurve, local::kCurve>();
  curve_variance_ = covariance.diagonal().segment<kKnots>(local::kCurve).mean();
}

ScanModel RadarSums::model_of(const ScanMotion3d& motion) const {
  const auto at = [&](const Point& point) {
    return model_scan(point, radar_.mounting_pose.position_m,
                      motion_at(point, motion, config_, filter_.yaw_rate_std_radps));
  };
  ScanModel model = at(block_.point);
  model.by_parameter = at(derivatives_at_).by_parameter;
  return model;
}

MotionVariances RadarSums::variances_of(const EgoSample& ego, bool has_elevation) const {
  const auto std_of = [](double stated, double fallback) { return stated > 0.0 ? stated : fallback; };
  return {square(std_of(ego.speed_std_mps, filter_.speed_std_mps)),
          square(std_of(ego.yaw_rate_std_radps, filter_.yaw_rate_std_radps)),
          has_elevation ? body_pitch_variance_ : 0.0, side_slip_variance_};
}

CurveJudgement RadarSums::judgement_of(const ScanModel& model, const MotionVariances& variances,
                                       double speed_mps) const {
  CurveJudgement judgement;
  judgement.gate = filter_.outlier_gate_sigma;
  judgement.rate_factor = learnt_.noise.rate_variance_factor();
  judgement.angle_factor = learnt_.noise.angle_variance_factor();
  judgement.velocity_variance = model.by_parameter.transpose() * gate_covariance_ * model.by_parameter;
  for (int m = 0; m < kMotionErrors; ++m) {
    judgement.velocity_variance +=
        variances[static_cast<std::size_t>(m)] * model.by_motion.row(m).transpose() * model.by_motion.row(m);
  }
  judgement.curve_variance = curve_variance_;
  judgement.up = block_.point.sensor_to_vehicle.row(2).transpose();
  judgement.height_m = radar_.mounting_pose.position_m[2];
  judgement.height_excess = block_.point.height_excess;
  judgement.mirror_share = block_.point.mirror_share;
  judgement.wide_std_mps = config_.wide_share * std::abs(speed_mps);
  return judgement;
}

RadarSums::Counts RadarSums::add(const Sightings& sightings, const ScanMotion3d& motion, const EgoSample& ego,
                                 double elapsed_s) {
  ScanModel model = model_of(motion);
  const MotionVariances variances = variances_of(ego, sightings.has_elevation);
  CurveSums sums =
      sum_scan(sightings, model.g, block_.point.curve_rad, knots_, judgement_of(model, variances, ego.speed_mps));
  const int directions = keep_supported(elapsed_s, sightings.has_elevation, sums, model);
  if (!sightings.has_elevation) note_unmeasured(sums, elapsed_s);
  learnt_.efficiency.add(sums.common, elapsed_s);
  add_scan(block_, model, sums, variances, {learnt_.efficiency.of_information(), learnt_.efficiency.of_score()});
  block_.seconds += elapsed_s;
  note_turn(model, ego.speed_mps);
  // Along one direction the noise of the angles cannot be distinguished from that of the range rates.
  if (directions >= 2) learnt_.noise.add(sums.common, std::exp(-elapsed_s / config_.noise_memory_s));
  return {sums.detections, sums.common.stationary, sums.common.inliers};
}

int RadarSums::keep_supported(double elapsed_s, bool has_elevation, CurveSums& sums, ScanModel& model) {
  const double keep = std::exp(-elapsed_s / config_.spread_memory_s);
  // The learnt noise of the angles is not believed to be smaller than stated: where there is no spread, it is not
  // known.
  const double doubt = std::max(1.0, 1.0 / learnt_.noise.angle_variance_factor());
  spread_.add(sums.information + sums.common.from_noise, doubt * sums.common.from_noise, sums.common.inliers, keep);
  const Support support = spread_.support(has_elevation, filter_.prior_angle_noise_log_std);
  // Scores scatter with all of the information, that of the noise included, but only the rest of it moves them. Both
  // are multiplied by the share of the rest, so that they agree: E[T·m] = T·M·Tᵀ·δg.
  const Eigen::Matrix3d& t = support.share;
  sums.information = t * (sums.information + sums.common.from_noise) * t.transpose();
  sums.score = t * sums.score;
  sums.curve_by_velocity *= t.transpose();
  for (CurveSums::Heights& heights : sums.heights) heights.by_velocity = t * heights.by_velocity;
  if (support.directions == 3) return support.directions;
  sums.wide_information = support.supported * sums.wide_information * support.supported.transpose();
  sums.wide_score = support.supported * sums.wide_score;
  // Reflectors in one plane do not determine its tilt: it would come from the estimate, not from the radar.
  model.by_parameter.middleRows<2>(local::kRotation).setZero();
  return support.directions;
}

void RadarSums::note_unmeasured(const CurveSums& sums, double elapsed_s) {
  if (!(sums.common.along > 0.0)) return;
  const double recent = lowering_ > 0.0 ? 1.0 - std::exp(-elapsed_s / config_.noise_memory_s) : 1.0;
  lowering_ += (sums.common.lowered / sums.common.along - lowering_) * recent;
  mean_sine_ += (sums.common.raised / sums.common.along - mean_sine_) * recent;
}

void RadarSums::note_turn(const ScanModel& model, double speed_mps) {
  // Sideways velocity by errors of all but scales and rotation.
  auto others = gate_covariance_;
  others.middleRows<4>(local::kRateScale).setZero();
  others.middleCols<4>(local::kRateScale).setZero();
  others.row(local::kSpeedScale).setZero();
  others.col(local::kSpeedScale).setZero();
  const Eigen::Matrix<double, local::kCurve, 1> sideways =
      model.by_parameter * block_.point.sensor_to_vehicle.row(1).transpose();
  block_.turn_variance = std::max(block_.turn_variance, sideways.dot(others * sideways) / square(speed_mps));
}

}  // namespace boresight::alignment::windows
