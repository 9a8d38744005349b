#include "services/alignment_estimator/core/windows/windowed_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/alignment_estimator/core/windows/output.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

using namespace windows;

constexpr std::size_t kMinSightings = 4;
constexpr double kMaxGap_s = 1.0;
constexpr double kInlierMemory_s = 10.0, kNoiseMemory_s = 60.0, kSpreadMemory_s = 600.0;
constexpr double kMaxSpeed_mps = 120.0, kMaxYawRate_radps = 4.0;
/// Largest standard deviations of scale and rotation that widen the gate of a running radar.
constexpr double kGateScale = 0.005, kGateRotation_rad = 0.01;

}  // namespace

WindowedFilter::Radar::Radar(const RadarConfig& radar, const FilterConfig& filter, const Priors& priors)
    : config(radar),
      nominal(geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0)),
      unknown(radar, priors.rotation_std_rad),
      start(filter),
      linearised(nominal) {
  const double half = std::max(std::abs(radar.field_of_view.azimuth_min_rad), radar.field_of_view.azimuth_max_rad);
  knots.first_rad = -half;
  knots.step_rad = 2.0 * half / (kKnots - 1);
}

WindowedFilter::WindowedFilter(const VehicleConfig& vehicle, const FilterConfig& config, const WindowsConfig& settings)
    : config_(config),
      priors_(settings.priors),
      solver_(std::min(vehicle.radars.size(), kMaxRadars), settings.priors),
      segments_(std::min(vehicle.radars.size(), kMaxRadars)),
      change_config_(settings.change),
      restore_config_(settings.restore),
      changes_(std::min(vehicle.radars.size(), kMaxRadars), change_config_),
      load_watch_(change_config_.load),
      speed_watch_(change_config_.speed) {
  const std::size_t count = solver_.size();
  deviations_.resize(count);
  scales_.resize(count);
  work_.resize(count);
  work_stds_.resize(count);
  verdicts_.resize(count);
  radars_.reserve(count);
  for (std::size_t r = 0; r < count; ++r) {
    radars_.emplace_back(vehicle.radars[r], config, priors_);
    solver_.set_prior(r, radars_[r].nominal, true, radars_[r].knots.step_rad);
  }
}

void WindowedFilter::step() {
  if (!solver_.step(segments_)) return;
  for (std::size_t r = 0; r < radars_.size(); ++r) judge_drift(r);
}

bool WindowedFilter::usable(const EgoSample& ego) const {
  return ego.valid && !ego.stale && std::abs(ego.speed_mps) >= config_.min_speed_mps &&
         std::abs(ego.speed_mps) < kMaxSpeed_mps && std::abs(ego.yaw_rate_radps) < kMaxYawRate_radps;
}

Motion WindowedFilter::motion_of(const Point& point, const ScanMotion3d& motion) const {
  const double a = std::abs(motion.acceleration_mps2) > 0.5 ? motion.acceleration_mps2 : 0.0;
  const double w = std::abs(motion.yaw_acceleration_radps2) > 0.04 ? motion.yaw_acceleration_radps2 : 0.0;
  return {motion.speed_mps + point.stamp_s * a,
          motion.yaw_rate_radps + point.stamp_s * w,
          motion.acceleration_mps2,
          a,
          w,
          config_.yaw_rate_std_radps};
}

void WindowedFilter::process(std::size_t index, const ScanDetections& scan, const EgoSample& ego) {
  if (index >= radars_.size()) return;
  Radar& radar = radars_[index];
  const double since_s = radar.last_time_ns == 0 ? 0.0 : seconds(scan.time_ns - radar.last_time_ns);
  const double elapsed_s = since_s > 0.0 && since_s < kMaxGap_s ? since_s : radar.config.cycle_time_s;
  radar.last_time_ns = scan.time_ns;
  if (solver_.busy()) step();
  if (!usable(ego)) {
    const bool slow = ego.valid && !ego.stale && std::abs(ego.speed_mps) < config_.min_speed_mps;
    wait(radar, slow ? AlignmentReason::kTooSlow : AlignmentReason::kNoEgoMotion);
    return;
  }
  take_sightings(scan, radar.config, radar.unknown, config_.azimuth_std_edge, radar.noise.angle_variance_factor(),
                 sightings_);
  if (sightings_.count < kMinSightings) {
    wait(radar, AlignmentReason::kTooFewDetections);
    return;
  }
  const ScanMotion3d motion = trend_.at(scan.time_ns, ego);
  if (has_block_) {
    const double block_s = seconds(scan.time_ns - block_start_ns_);
    if (block_s >= kBlock_s || block_s < -0.5) close_block();
  }
  if (!has_block_) {
    block_start_ns_ = scan.time_ns;
    has_block_ = true;
  }
  if (!radar.running) {
    search(index, motion, elapsed_s);
    if (!radar.running) {
      wait(radar, AlignmentReason::kNoConsistentStart);
      return;
    }
  } else {
    update(index, motion, ego, elapsed_s);
  }
  radar.seconds_of_drive += elapsed_s;
  radar.reason = reason_of(index);
  radar.state = radar.reason == AlignmentReason::kNone ? AlignmentState::kConverged : AlignmentState::kConverging;
}

void WindowedFilter::wait(Radar& radar, AlignmentReason reason) {
  radar.state = std::max(radar.state, AlignmentState::kWaiting);
  if (radar.state == AlignmentState::kWaiting) radar.reason = reason;
}

AlignmentReason WindowedFilter::reason_of(std::size_t index) const {
  const Radar& radar = radars_[index];
  if (radar.inlier_ratio < config_.min_inlier_share) return AlignmentReason::kFewInliers;
  const double noise = std::max(radar.noise.rate_variance_factor(), radar.noise.angle_variance_factor());
  if (noise > square(config_.max_noise_scale)) return AlignmentReason::kLargeResidual;
  const double yaw_std = std::sqrt(solver_.radar(index).covariance(own::kRotation + 2, own::kRotation + 2));
  if (!(yaw_std < priors_.rotation_std_rad / 3.0)) return AlignmentReason::kNotObservable;
  if (!(yaw_std < config_.converged_yaw_std_rad)) return AlignmentReason::kLargeStd;
  if (radar.seconds_of_drive < config_.min_seconds_to_converge) return AlignmentReason::kShortDrive;
  return AlignmentReason::kNone;
}

void WindowedFilter::search(std::size_t index, const ScanMotion3d& motion, double elapsed_s) {
  Radar& radar = radars_[index];
  StartPrior prior;
  const SharedState& shared = solver_.shared();
  prior.speed_scale = shared.speed_scale;
  prior.speed_scale_variance = std::max(square(priors_.speed_scale_std), 1e-10);
  prior.sensor_to_vehicle = solver_.radar(index).state.sensor_to_vehicle;
  prior.rotation_variance = square(priors_.rotation_std_rad);
  prior.log_angle_noise_std = config_.prior_angle_noise_log_std;
  const auto verdict = radar.start.add(sightings_, radar.config.mounting_pose.position_m, motion, elapsed_s, prior,
                                       radar.noise.angle_variance_factor());
  if (verdict != GraduatedStart::Verdict::kFound) return;
  const StartResult& found = radar.start.result();
  bool first = true;
  for (const Radar& other : radars_) first = first && !other.running;
  if (sightings_.has_elevation != solver_.radar(index).has_elevation) {
    set_has_elevation(index, sightings_.has_elevation);
  } else if (radar.remembered && contradicts_memory(index, found)) {
    solver_.forget_rotation(index, radar.nominal);
  }
  solver_.radar(index).state.sensor_to_vehicle = found.sensor_to_vehicle;
  if (first) solver_.shared().speed_scale = found.speed_scale;
  radar.running = true;
  radar.linearised = solver_.point(index, driven_s_, load_).sensor_to_vehicle;
  radar.linearised_speed_scale = solver_.shared().speed_scale;
  radar.inlier_ratio = found.inlier_ratio;
  radar.spread = found.spread;
  begin_block(index);
}

Point WindowedFilter::linearise(std::size_t index) {
  // Of the prior's standard deviation. What is known of the scale limits yaw, and the reverse, where the data determine
  // neither; roll is known later than all else.
  constexpr double kKnownShare = 0.2, kKnownShareOfRoll = 1.0 / 3.0;
  Radar& radar = radars_[index];
  Point point = solver_.point(index, driven_s_, load_);
  Eigen::Vector3d turn = geometry::so3_log(point.sensor_to_vehicle * radar.linearised.transpose());
  for (int axis = 0; axis < 3; ++axis) {
    const double variance = solver_.radar(index).covariance(own::kRotation + axis, own::kRotation + axis);
    const double share = axis == 0 ? kKnownShareOfRoll : kKnownShare;
    if (!(variance < square(share * priors_.rotation_std_rad))) turn(axis) = 0.0;
  }
  radar.linearised = geometry::so3_exp(turn) * radar.linearised;
  const double scale_variance = solver_.shared_covariance()(shared::kSpeedScale, shared::kSpeedScale);
  if (scale_variance < square(kKnownShare * priors_.speed_scale_std)) radar.linearised_speed_scale = point.speed_scale;
  point.sensor_to_vehicle = radar.linearised;
  point.speed_scale = radar.linearised_speed_scale;
  return point;
}

void WindowedFilter::begin_block(std::size_t index) {
  Radar& radar = radars_[index];
  radar.block.clear(linearise(index));
  LocalMatrix p = solver_.local_covariance(index);
  const RadarSolution& solution = solver_.radar(index);
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    p(kFluctuating[k], kFluctuating[k]) += solution.fluctuation.variance[k] + solver_.common().variance[k];
  }
  const bool young = driven_s_ < kStart_s;
  Eigen::Matrix<double, local::kCount, 1> cap = Eigen::Matrix<double, local::kCount, 1>::Ones();
  const auto limit = [&](int column, double std) {
    cap(column) = std::min(1.0, std / std::sqrt(p(column, column) + 1e-20));
  };
  limit(local::kSpeedScale, young ? 0.02 : kGateScale);
  limit(local::kRateScale, kGateScale);
  limit(local::kRotation + 1, 2.0 * kGateRotation_rad);
  limit(local::kRotation + 2, kGateRotation_rad);
  radar.gate_covariance = (cap.asDiagonal() * p * cap.asDiagonal()).topLeftCorner<local::kCurve, local::kCurve>();
  radar.curve_variance = p.diagonal().segment<kKnots>(local::kCurve).mean();
}

void WindowedFilter::update(std::size_t index, const ScanMotion3d& motion, const EgoSample& ego, double elapsed_s) {
  Radar& radar = radars_[index];
  ScanModel model =
      model_scan(radar.block.point, radar.config.mounting_pose.position_m, motion_of(radar.block.point, motion));
  const auto std_of = [](double stated, double fallback) { return stated > 0.0 ? stated : fallback; };
  const MotionVariances variances{square(std_of(ego.speed_std_mps, config_.speed_std_mps)),
                                  square(std_of(ego.yaw_rate_std_radps, config_.yaw_rate_std_radps)),
                                  sightings_.has_elevation ? square(priors_.body_pitch_std_rad) : 0.0,
                                  square(priors_.side_slip_std_rad)};
  CurveJudgement judgement;
  judgement.gate = config_.outlier_gate_sigma;
  judgement.rate_factor = radar.noise.rate_variance_factor();
  judgement.angle_factor = radar.noise.angle_variance_factor();
  judgement.velocity_variance = model.by_parameter.transpose() * radar.gate_covariance * model.by_parameter;
  for (int m = 0; m < kMotionErrors; ++m) {
    judgement.velocity_variance +=
        variances[static_cast<std::size_t>(m)] * model.by_motion.row(m).transpose() * model.by_motion.row(m);
  }
  judgement.curve_variance = radar.curve_variance;
  judgement.up = radar.block.point.sensor_to_vehicle.row(2).transpose();
  judgement.height_m = radar.config.mounting_pose.position_m[2];
  judgement.height_excess = radar.block.point.height_excess;
  judgement.mirror_share = radar.block.point.mirror_share;
  judgement.wide_std_mps = 0.012 * std::abs(ego.speed_mps);
  CurveSums sums = windows::sum_scan(sightings_, model.g, radar.block.point.curve_rad, radar.knots, judgement);
  const int directions = keep_supported(radar, elapsed_s, sums, model);
  radar.efficiency.add(sums.common, elapsed_s);
  windows::add_scan(radar.block, model, sums, variances,
                    {radar.efficiency.of_information(), radar.efficiency.of_score()});
  radar.block.seconds += elapsed_s;
  {
    // Sideways velocity by errors of all but scales and rotation.
    LocalGate others = radar.gate_covariance;
    others.middleRows<4>(local::kRateScale).setZero();
    others.middleCols<4>(local::kRateScale).setZero();
    others.row(local::kSpeedScale).setZero();
    others.col(local::kSpeedScale).setZero();
    const Eigen::Matrix<double, local::kCurve, 1> sideways =
        model.by_parameter * radar.block.point.sensor_to_vehicle.row(1).transpose();
    radar.block.turn_variance =
        std::max(radar.block.turn_variance, sideways.dot(others * sideways) / square(ego.speed_mps));
  }
  // Along one direction the noise of the angles cannot be distinguished from that of the range rates.
  if (directions >= 2) radar.noise.add(sums.common, std::exp(-elapsed_s / kNoiseMemory_s));
  const double share = sums.common.stationary / sums.detections;
  radar.inlier_ratio += (share - radar.inlier_ratio) * (1.0 - std::exp(-elapsed_s / kInlierMemory_s));
  ++radar.scans_used;
  radar.detections_used += static_cast<std::uint64_t>(sums.common.inliers);
}

int WindowedFilter::keep_supported(Radar& radar, double elapsed_s, CurveSums& sums, ScanModel& model) {
  const double keep = std::exp(-elapsed_s / kSpreadMemory_s);
  // The learnt noise of the angles is not believed to be smaller than stated: where there is no spread, it is not
  // known.
  const double doubt = std::max(1.0, 1.0 / radar.noise.angle_variance_factor());
  radar.spread.add(sums.information + sums.common.from_noise, doubt * sums.common.from_noise, sums.common.inliers,
                   keep);
  const Support support = radar.spread.support(sightings_.has_elevation, config_.prior_angle_noise_log_std);
  if (!sightings_.has_elevation && sums.common.along > 0.0) {
    const double recent = radar.lowering > 0.0 ? 1.0 - std::exp(-elapsed_s / kNoiseMemory_s) : 1.0;
    radar.lowering += (sums.common.lowered / sums.common.along - radar.lowering) * recent;
    radar.mean_sine += (sums.common.raised / sums.common.along - radar.mean_sine) * recent;
  }
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

void WindowedFilter::close_block() {
  has_block_ = false;
  bool any = false;
  for (const Radar& radar : radars_) any = any || (radar.running && radar.block.scans > 0);
  if (!any) return;
  while (solver_.busy()) step();
  judge_block();
  const bool due = segments_.size() == 0 ||
                   segments_.segment(segments_.size() - 1).seconds >= kSegment_s - 0.5 * kBlock_s ||
                   segments_.segment(segments_.size() - 1).load != load_;
  const MergeNoise noise = solver_.merge_noise();
  if (due) segments_.begin(load_, noise);
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if (radars_[r].running && radars_[r].block.scans > 0 && !verdicts_[r].suspect) {
      segments_.add(r, radars_[r].block, kSegment_s, noise);
    }
  }
  Segment& latest = segments_.segment(segments_.size() - 1);
  latest.seconds += kBlock_s;
  driven_s_ += kBlock_s;
  latest.middle_s = driven_s_ - 0.5 * latest.seconds;
  decide_load();
  if (driven_s_ - solved_s_ >= kSolve_s || driven_s_ <= kStart_s) {
    solver_.begin(driven_s_);
    solved_s_ = driven_s_;
    // At the start every second counts.
    while (driven_s_ <= kStart_s && solver_.busy()) step();
  }
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if (radars_[r].running) begin_block(r);
  }
}

RadarEstimate WindowedFilter::estimate(std::size_t index) const {
  RadarEstimate out;
  if (index >= radars_.size()) return out;
  const Radar& radar = radars_[index];
  out.state = radar.state;
  out.reason = radar.reason;
  write_solution(solver_, index, driven_s_, load_, radar.knots, radar.linearised, radar.unmeasured(), out);
  out.drift.since_ns = radar.drift_since_ns;
  if (!radar.running && !radar.remembered) out.observable = out.nuisance.observable = 0;
  out.step_change = radar.step_change;
  out.load_change = load_change_;
  out.speed_change = speed_change_;
  out.angle_noise_scale = std::sqrt(radar.noise.angle_variance_factor());
  out.inlier_ratio = std::max(0.0, radar.inlier_ratio);
  out.scans_used = radar.scans_used;
  out.detections_used = radar.detections_used;
  out.seconds_of_drive = radar.seconds_of_drive;
  return out;
}

void WindowedFilter::predict(std::size_t index, const ScanDetections& scan, const EgoSample& ego,
                             std::span<double> out) const {
  const std::size_t count = std::min(scan.count, out.size());
  std::fill_n(out.begin(), count, 0.0);
  if (index >= radars_.size()) return;
  const Radar& radar = radars_[index];
  const Point point = solver_.point(index, driven_s_, load_);
  const ScanModel model =
      model_scan(point, radar.config.mounting_pose.position_m, {ego.speed_mps, ego.yaw_rate_radps, 0.0, 0.0, 0.0, 0.0});
  for (std::size_t i = 0; i < count; ++i) {
    const double mean_cosine = scan.has_elevation ? 1.0 : 1.0 - radar.unknown.at(scan.range_m[i]).lowering;
    out[i] = -mean_cosine * geometry::direction(scan.azimuth_rad[i], scan.elevation_rad[i]).dot(model.g);
  }
}

}  // namespace boresight::alignment
