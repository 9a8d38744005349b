#include "services/alignment_estimator/core/filter/robust_filter.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

constexpr std::size_t kMinSightings = 4;
constexpr double kSameInstant_s = 5e-4;
constexpr double kMaxGap_s = 1.0;
/// Time constants of a radar's sliding statistics.
constexpr double kSpreadMemory_s = 20.0, kNoiseMemory_s = 60.0, kInlierMemory_s = 10.0, kLoweringMemory_s = 10.0;
/// A scan whose share of stationary detections is below this part of the usual one is not used.
constexpr double kStrangeShare = 0.4;
constexpr double kStepChangeMeasured_s = 20.0;
constexpr double kMaxSpeed_mps = 120.0, kMaxYawRate_radps = 4.0;

}  // namespace

RobustFilter::Radar::Radar(const RadarConfig& radar, const FilterConfig& filter)
    : config(radar),
      nominal(geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0)),
      unknown(radar, filter.prior_rotation_std_rad),
      start(filter) {}

RobustFilter::RobustFilter(const VehicleConfig& vehicle, const FilterConfig& config)
    : config_(config),
      state_(vehicle.radars.size()),
      nuisance_model_(config),
      step_changes_(vehicle.radars.size(), config),
      small_step_changes_(vehicle.radars.size(), config) {
  const std::size_t count = std::min(vehicle.radars.size(), kMaxRadars);
  radars_.reserve(count);
  state_.set_variance(column::kSpeedScale, square(config.prior_speed_scale_std));
  state_.set_variance(column::kYawRateBias, square(config.prior_yaw_rate_bias_std_radps));
  state_.set_variance(column::kSlip, square(config.prior_slip_coefficient_std_radps2pm));
  state_.set_variance(column::kPitchPerAcceleration, square(config.prior_pitch_per_acceleration_std_radps2pm));
  for (std::size_t r = 0; r < count; ++r) {
    radars_.emplace_back(vehicle.radars[r], config);
    state_.sensor_to_vehicle[r] = state_.linearised[r] = radars_[r].nominal;
    reopen(r);
    state_.set_variance(column::of_radar(r) + column::kAngleNoise, square(config.prior_angle_noise_log_std));
  }
  // A deviation of the real elevations from the assumed ones is common to all radars of a vehicle: many radars know the
  // speed little better than one. An equal part is individual: objects on the radar's side, and its own roll and pitch.
  for (std::size_t r = 0; r < count; ++r) {
    for (std::size_t s = 0; s < count; ++s) {
      state_.set_covariance(column::of_radar(r) + column::kElevations, column::of_radar(s) + column::kElevations,
                            (r == s ? 2.0 : 1.0) * square(kElevationExcessStd));
    }
  }
}

bool RobustFilter::usable(const EgoSample& ego) const {
  return ego.valid && !ego.stale && std::abs(ego.speed_mps) >= config_.min_speed_mps &&
         std::abs(ego.speed_mps) < kMaxSpeed_mps && std::abs(ego.yaw_rate_radps) < kMaxYawRate_radps;
}

bool RobustFilter::any_running_but(std::size_t radar) const {
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if (r != radar && radars_[r].phase == Phase::kRunning) return true;
  }
  return false;
}

void RobustFilter::advance(std::int64_t time_ns) {
  const double elapsed_s = has_instant_ ? seconds(time_ns - instant_ns_) : 0.0;
  if (!has_instant_ || std::abs(elapsed_s) > kMaxGap_s) {
    nuisance_model_.reset(state_);
  } else if (std::abs(elapsed_s) > kSameInstant_s) {
    nuisance_model_.step(state_, elapsed_s);
  } else {
    return;
  }
  // The mounting of a parked car does not drift with time: a gap counts as kMaxGap_s at most.
  const double drift_s = std::clamp(elapsed_s, 0.0, kMaxGap_s);
  state_.add_variance(column::kSpeedScale, square(config_.speed_scale_drift_per_sqrt_s) * drift_s);
  state_.add_variance(column::kYawRateBias, square(config_.yaw_rate_bias_drift_radps_per_sqrt_s) * drift_s);
  const double turn = square(config_.rotation_drift_rad_per_sqrt_s) * drift_s;
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    for (Eigen::Index i = 0; i < 3; ++i) state_.add_variance(column::of_radar(r) + i, turn);
  }
  instant_ns_ = time_ns;
  has_instant_ = true;
}

void RobustFilter::process(std::size_t index, const ScanDetections& scan, const EgoSample& ego) {
  if (index >= radars_.size()) return;
  Radar& radar = radars_[index];
  const double since_s = radar.last_time_ns == 0 ? 0.0 : seconds(scan.time_ns - radar.last_time_ns);
  const double elapsed_s = since_s > 0.0 && since_s < kMaxGap_s ? since_s : radar.config.cycle_time_s;
  radar.last_time_ns = scan.time_ns;
  if (!usable(ego)) {
    radar.state = std::max(radar.state, AlignmentState::kWaiting);
    return;
  }
  take_sightings(scan, radar.config, radar.unknown, config_.azimuth_std_edge, radar.noise.angle_variance_factor(),
                 sightings_);
  if (sightings_.count < kMinSightings) {
    radar.state = std::max(radar.state, AlignmentState::kWaiting);
    return;
  }
  nuisance_model_.state_stds(ego.speed_std_mps, ego.yaw_rate_std_radps);
  advance(scan.time_ns);
  const ScanMotion3d motion = trend_.at(scan.time_ns, ego);
  switch (radar.phase) {
    case Phase::kStarting:
      search(index, motion, elapsed_s);
      if (radar.phase == Phase::kStarting) {
        radar.state = std::max(radar.state, AlignmentState::kWaiting);
        return;
      }
      break;
    case Phase::kRunning:
      update(index, motion, elapsed_s, scan.time_ns);
      break;
    case Phase::kSuspected:
      search(index, motion, elapsed_s);
      break;
  }
  radar.seconds_of_drive += elapsed_s;
  radar.since_start_s += elapsed_s;
  radar.since_change_s += elapsed_s;
  const bool sure = std::sqrt(state_.covariance(column::of_radar(index) + 2, column::of_radar(index) + 2)) <
                        config_.converged_yaw_std_rad &&
                    radar.seconds_of_drive >= config_.min_seconds_to_converge;
  radar.state = sure ? AlignmentState::kConverged : AlignmentState::kConverging;
}

void RobustFilter::update(std::size_t index, const ScanMotion3d& motion, double elapsed_s, std::int64_t time_ns) {
  Radar& radar = radars_[index];
  SensorVelocity velocity = sensor_velocity(state_, state_.nuisances, index, radar.config.mounting_pose.position_m,
                                            motion, nuisance_model_.pitch_share());
  const Eigen::Index noise = column::of_radar(index) + column::kAngleNoise;
  const Support support = radar.spread.support(sightings_.has_elevation, std::sqrt(state_.covariance(noise, noise)));
  velocity.seen(support, state_.log_angle_noise[index]);
  state_.project(index, velocity.gradient);
  Judgement judgement;
  judgement.gate = config_.outlier_gate_sigma;
  judgement.range_rate_scale = radar.noise.rate_variance_factor();
  judgement.angle_scale = radar.noise.angle_variance_factor();
  judgement.velocity_variance = state_.velocity_covariance();
  const ScanSums sums = sum_scan(run_of(sightings_), velocity.g, judgement);
  const auto detections = static_cast<double>(sightings_.count);
  const double share = sums.stationary / detections;
  const bool strange = radar.inlier_ratio > 0.0 && share < kStrangeShare * radar.inlier_ratio;
  if (!strange) radar.inlier_ratio += (share - radar.inlier_ratio) * (1.0 - std::exp(-elapsed_s / kInlierMemory_s));

  radar.spread.add(sums.information, sums.from_noise, sums.inliers, std::exp(-elapsed_s / kSpreadMemory_s));
  radar.efficiency.add(sums, elapsed_s);
  if (sums.along > 0.0) {
    const double recent = 1.0 - std::exp(-elapsed_s / kLoweringMemory_s);
    state_.lowering[index] += (sums.lowered / sums.along - state_.lowering[index]) * recent;
    radar.mean_sine += (sums.raised / sums.along - radar.mean_sine) * recent;
  }
  const Eigen::Matrix3d information =
      radar.efficiency.of_information() * support.share * sums.information * support.share.transpose();
  const Eigen::Vector3d score = radar.efficiency.of_score() * support.share * sums.score;

  const Eigen::Matrix3d turn = velocity.gradient.middleRows<3>(column::kShared);
  const Eigen::Matrix3d by_turn = turn * information * turn.transpose();
  const Eigen::Vector3d turn_score = turn * score;
  const std::uint32_t suspicious = step_changes_.add(index, time_ns, by_turn.bottomRightCorner<2, 2>(),
                                                     turn_score.tail<2>(), sums.stationary, detections);
  const std::uint32_t changed =
      strange ? 0 : small_step_changes_.add(index, time_ns, by_turn, turn_score, state_.rotation_covariance(index));
  if (suspicious != 0) watch(suspicious, time_ns);
  if (changed != 0) follow(changed, time_ns);
  // The information of this scan refers to the rotation before the change.
  if ((changed >> index & 1u) != 0) return;
  if (strange || radar.phase != Phase::kRunning || small_step_changes_.doubted(index)) return;
  if (!state_.update(information, score)) return;
  linearise(index);
  learn_noise(index, sums, elapsed_s);
  radar.since_earlier_s += elapsed_s;
  if (radar.since_earlier_s > kEarlier_s) {
    radar.earlier = {radar.earlier[1], radar.earlier[2], now(index)};
    radar.since_earlier_s = 0.0;
  }
  // The size of a step change becomes more accurate for a while.
  if (radar.step_change.count > 0 && radar.since_start_s < kStepChangeMeasured_s) measure_step_change(index);
  ++radar.scans_used;
  radar.detections_used += static_cast<std::uint64_t>(sums.inliers);
}

/// The noise of the angles as estimated from the residuals is a measurement of its column of the state.
void RobustFilter::learn_noise(std::size_t index, const ScanSums& sums, double elapsed_s) {
  NoiseScale& noise = radars_[index].noise;
  const double before = noise.log_angle_variance_factor();
  noise.add(sums, std::exp(-elapsed_s / kNoiseMemory_s));
  const double shift = noise.log_angle_variance_factor() - before;
  const Eigen::Index column = column::of_radar(index) + column::kAngleNoise;
  const double variance = noise.log_angle_variance(square(config_.prior_angle_noise_log_std));
  const double known = state_.covariance(column, column);
  state_.condition(column, shift, std::min(variance, known));
  state_.log_angle_noise[index] -= shift;
  if (known < variance) state_.add_variance(column, variance - known);
}

}  // namespace boresight::alignment
