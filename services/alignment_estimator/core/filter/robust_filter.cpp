#include "services/alignment_estimator/core/filter/robust_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

constexpr std::size_t kMinSightings = 4;
constexpr double kSameInstant_s = 5e-4;
constexpr double kMaxGap_s = 1.0;
/// Time constants of a radar's sliding statistics.
constexpr double kSpreadMemory_s = 20.0, kNoiseMemory_s = 60.0, kInlierMemory_s = 10.0, kLoweringMemory_s = 10.0;
/// A scan in which so much less than usual stands still is not used.
constexpr double kStrangeShare = 0.4;
/// χ² of three degrees of freedom that is passed once in 10⁴: a rotation that is another one.
constexpr double kAnother = 21.1;
/// A rotation that is confirmed as a knock is at least this large.
constexpr double kMinKnock_rad = 0.0044;
/// A suspicion that no new start confirms or refutes within this time is dropped.
constexpr double kMaxSuspicion_s = 20.0;
constexpr double kKnockMeasured_s = 20.0;
/// What elevations that are not measured take off range rates is anything from nothing to twice what is assumed, for
/// all radars alike; each radar's own share is as uncertain.
constexpr double kElevationExcessStd = 0.577;
/// Slow mean of a radar's deviation, as a share of what it is now, beyond which it has been growing.
constexpr double kDriftShare = 0.4;
constexpr double kEarlier_s = 5.0;
/// An axis is known with this share of the prior's σ; derivatives are as good within this angle.
constexpr double kLearntShare = 1.0 / 3.0;
constexpr double kKnownShare = 0.05, kLinearStep_rad = 5e-4;
constexpr double kMaxSpeed_mps = 120.0, kMaxYawRate_radps = 4.0;

double square(double v) {
  return v * v;
}
double seconds(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-9;
}

/// Column of the joint state for one of VelocityGradient.
Eigen::Index column_of(std::size_t radar, Eigen::Index touched) {
  return touched < column::kShared ? touched : column::of_radar(radar) + touched - column::kShared;
}

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
      knocks_(vehicle.radars.size(), config),
      small_knocks_(vehicle.radars.size(), config) {
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
  // What is higher or lower than assumed is so to all radars of a vehicle: many know the speed little better than one.
  // As much again is each radar's own: what stands on its side, and what its roll and pitch make of elevations.
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
  // What a parked car's mounting does is no matter of the time that passed.
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

StartPrior RobustFilter::start_prior(std::size_t index) const {
  const Radar& radar = radars_[index];
  StartPrior prior;
  // Others know the speed by now; what a radar that is alone knows of it may be as wrong as the rest of its estimate.
  const bool known = any_running_but(index);
  prior.speed_scale = known ? state_.speed_scale : 1.0;
  prior.speed_scale_variance = known ? state_.covariance(column::kSpeedScale, column::kSpeedScale) + square(1e-3)
                                     : square(config_.prior_speed_scale_std);
  // What the window does not tell stays as it was.
  prior.sensor_to_vehicle = radar.phase == Phase::kSuspected ? radar.before_knock : state_.sensor_to_vehicle[index];
  prior.rotation_variance = square(config_.prior_rotation_std_rad);
  const Eigen::Index noise = column::of_radar(index) + column::kAngleNoise;
  prior.log_angle_noise_std = std::sqrt(state_.covariance(noise, noise));
  prior.yaw_rate_bias_radps = state_.yaw_rate_bias_radps;
  prior.slip_radps2pm = state_.slip_radps2pm;
  const Eigen::Index elevations = column::of_radar(index) + column::kElevations;
  prior.elevation_excess = state_.elevation_excess[index];
  prior.elevation_excess_variance = known ? state_.covariance(elevations, elevations) : 0.0;
  return prior;
}

void RobustFilter::search(std::size_t index, const ScanMotion3d& motion, double elapsed_s) {
  Radar& radar = radars_[index];
  const GraduatedStart::Verdict verdict =
      radar.start.add(sightings_, radar.config.mounting_pose.position_m, motion, elapsed_s, start_prior(index),
                      radar.noise.angle_variance_factor());
  if (verdict == GraduatedStart::Verdict::kFound) {
    const StartResult& found = radar.start.result();
    if (radar.phase == Phase::kSuspected) {
      verify(index, found, radar.last_time_ns);
    } else {
      adopt(index, found);
    }
    return;
  }
  if (radar.phase == Phase::kSuspected && seconds(radar.last_time_ns - radar.suspected_ns) > kMaxSuspicion_s) {
    radar.phase = Phase::kRunning;
    radar.start.clear();
    forget_deviations(index);
  }
}

void RobustFilter::adopt(std::size_t index, const StartResult& found) {
  Radar& radar = radars_[index];
  if (!any_running_but(index)) {
    const double variance = found.covariance(0, 0);
    const double difference = found.speed_scale - state_.speed_scale;
    const double expected = variance + state_.covariance(column::kSpeedScale, column::kSpeedScale);
    // A memory that agrees is better than the start; the prior is not, and a seed leaves k_v at it.
    const bool scale_is_known = radar.remembered && state_.covariance(column::kSpeedScale, column::kSpeedScale) <
                                                        0.25 * square(config_.prior_speed_scale_std);
    if (!scale_is_known || square(difference) > 16.0 * expected) {
      place_speed_scale(index, found);
    }
  }
  bool agrees = false;
  if (radar.remembered) {
    const Eigen::Vector3d off =
        geometry::so3_log(found.sensor_to_vehicle * state_.sensor_to_vehicle[index].transpose());
    Eigen::Matrix3d covariance = found.covariance.bottomRightCorner<3, 3>();
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) {
        covariance(i, j) += state_.covariance(column::of_radar(index) + i, column::of_radar(index) + j);
      }
    }
    const Eigen::LLT<Eigen::Matrix3d> solver(covariance);
    agrees = solver.info() == Eigen::Success && off.dot(solver.solve(off)) < kAnother;
  }
  if (!agrees) {
    if (radar.remembered) reopen(index);
    place(index, found);
  }
  radar.spread = found.spread;
  state_.lowering[index] = found.lowering;
  radar.mean_sine = found.mean_sine;
  state_.linearised[index] = state_.sensor_to_vehicle[index];
  note_linearised(index);
  radar.earlier.fill(now(index));
  radar.phase = Phase::kRunning;
  radar.remembered = false;
  radar.since_start_s = 0.0;
  radar.inlier_ratio = found.inlier_ratio;
  forget_deviations(index);
}

/// k_v is as wrong as what the search took for known.
void RobustFilter::place_speed_scale(std::size_t index, const StartResult& found) {
  state_.speed_scale = state_.linearised_speed_scale = found.speed_scale;
  state_.set_variance(column::kSpeedScale, 0.0);
  double variance = found.covariance(0, 0);
  const auto& by = found.speed_scale_by_known;
  const auto with = [&](Eigen::Index x) {
    double sum = 0.0;
    for (Eigen::Index c = 0; c < column::kTouched; ++c) sum += by(c) * state_.covariance(column_of(index, c), x);
    return sum;
  };
  for (Eigen::Index c = 0; c < column::kTouched; ++c) variance += by(c) * with(column_of(index, c));
  for (Eigen::Index x = 0; x < state_.size(); ++x) {
    if (x != column::kSpeedScale) state_.set_covariance(column::kSpeedScale, x, with(x));
  }
  state_.set_covariance(column::kSpeedScale, column::kSpeedScale, variance);
}

/// The rotation is as wrong as what the search took for known: speed scale, slip, yaw-rate bias, roll and the angles'
/// noise stay correlated with it, and what the car's body did in that window is in it for good. Axes that were not
/// searched stay what they were.
void RobustFilter::place(std::size_t index, const StartResult& found) {
  const Eigen::Index first = column::of_radar(index);
  const auto& by = found.by_known;
  const Eigen::Vector4d known(state_.speed_scale, state_.yaw_rate_bias_radps, state_.slip_radps2pm,
                              state_.pitch_per_acceleration_radps2pm);
  const Eigen::Vector3d turn = by.leftCols<column::kNuisances>() * (known - found.taken);
  state_.sensor_to_vehicle[index] = state_.linearised[index] = geometry::so3_exp(turn) * found.sensor_to_vehicle;
  const auto searched = [&](Eigen::Index x) {
    return x >= first && x < first + 3 && found.searched[static_cast<std::size_t>(x - first)];
  };
  for (Eigen::Index i = first; i < first + 3; ++i) {
    if (searched(i)) state_.set_variance(i, 0.0);
  }
  Eigen::Matrix3d covariance = found.rotation_covariance;
  for (Eigen::Index n = 0; n < column::kNumberOfNuisances; ++n) {
    const auto process = static_cast<std::size_t>(n);
    const double mean_share =
        std::min(1.0, 2.0 * nuisance_model_.correlation_s(process) / std::max(found.seconds, 1e-3));
    const Eigen::Vector3d turned = by.col(column::kNuisances + n);
    covariance += mean_share * nuisance_model_.variance(process) * turned * turned.transpose();
  }
  const auto with = [&](Eigen::Index x) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Eigen::Index c = 0; c < column::kTouched; ++c) {
      const bool at_an_instant = c >= column::kNuisances && c < column::kShared;
      if (!at_an_instant) sum += state_.covariance(column_of(index, c), x) * by.col(c);
    }
    return sum;
  };
  for (Eigen::Index c = 0; c < column::kTouched; ++c) {
    const bool at_an_instant = c >= column::kNuisances && c < column::kShared;
    if (!at_an_instant) covariance += with(column_of(index, c)) * by.col(c).transpose();
  }
  for (Eigen::Index x = 0; x < state_.size(); ++x) {
    if (searched(x)) continue;
    const Eigen::Vector3d shared = with(x);
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (searched(first + i)) state_.set_covariance(first + i, x, shared(i));
    }
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      if (!searched(first + i) || !searched(first + j)) continue;
      state_.set_covariance(first + i, first + j, 0.5 * (covariance(i, j) + covariance(j, i)));
    }
  }
}

/// Nothing of its rotation is known any more.
void RobustFilter::reopen(std::size_t index) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    state_.set_variance(column::of_radar(index) + i, square(config_.prior_rotation_std_rad));
  }
}

void RobustFilter::verify(std::size_t index, const StartResult& found, std::int64_t time_ns) {
  Radar& radar = radars_[index];
  const Eigen::Index first = column::of_radar(index);
  const Eigen::Vector3d off = geometry::so3_log(found.sensor_to_vehicle * radar.before_knock.transpose());
  // Twice the statistical σ: what inflates a start is for the estimate that follows it, whereas two rotations are
  // compared here, and a start that is wrong by more only begins anew.
  Eigen::Matrix3d covariance = 4.0 / config_.start_inflation * found.covariance.bottomRightCorner<3, 3>();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) covariance(i, j) += state_.covariance(first + i, first + j);
  }
  const Eigen::LLT<Eigen::Matrix3d> solver(covariance);
  const double distance = solver.info() == Eigen::Success ? off.dot(solver.solve(off)) : 0.0;
  const bool another = distance > kAnother && off.tail<2>().norm() > kMinKnock_rad;
  if (another) {
    reopen(index);
    place(index, found);
    note_linearised(index);
    radar.since_start_s = radar.since_earlier_s = 0.0;
    radar.earlier.fill(now(index));
    if (!radar.drifted) {
      radar.knock.time_ns = time_ns;
      ++radar.knock.count;
      measure_knock(index);
    }
    radar.inlier_ratio = found.inlier_ratio;
  }
  radar.phase = Phase::kRunning;
  forget_deviations(index);
}

RobustFilter::Radar::Earlier RobustFilter::now(std::size_t index) const {
  const Eigen::Index first = column::of_radar(index);
  return {state_.sensor_to_vehicle[index],
          {state_.covariance(first, first), state_.covariance(first + 1, first + 1),
           state_.covariance(first + 2, first + 2)}};
}

void RobustFilter::measure_knock(std::size_t index) {
  Radar& radar = radars_[index];
  const Eigen::Vector3d turn = geometry::so3_log(state_.sensor_to_vehicle[index] * radar.before_knock.transpose());
  for (std::size_t i = 0; i < 3; ++i) {
    radar.knock.rotation_vehicle_rad[i] = static_cast<float>(turn(static_cast<Eigen::Index>(i)));
  }
}

void RobustFilter::update(std::size_t index, const ScanMotion3d& motion, double elapsed_s, std::int64_t time_ns) {
  Radar& radar = radars_[index];
  SensorVelocity velocity = sensor_velocity(state_, state_.nuisances, index, radar.config.mounting_pose.position_m,
                                            motion, nuisance_model_.pitch_share());
  const Eigen::Index noise = column::of_radar(index) + column::kAngleNoise;
  const Support support =
      radar.spread.support(sightings_.has_elevation, std::sqrt(state_.covariance(noise, noise)));
  velocity.seen(support, state_.log_angle_noise[index]);
  state_.project(index, velocity.gradient);
  Judgement judgement;
  judgement.gate = config_.outlier_gate_sigma;
  judgement.range_rate_scale = radar.noise.rate_variance_factor();
  judgement.angle_scale = radar.noise.angle_variance_factor();
  judgement.velocity_variance = state_.velocity_covariance();
  const ScanSums sums = sum_scan(run_of(sightings_), velocity.g, judgement);
  const auto detections = static_cast<double>(sightings_.count);
  const double share = sums.standing / detections;
  const bool strange = radar.inlier_ratio > 0.0 && share < kStrangeShare * radar.inlier_ratio;
  if (!strange) radar.inlier_ratio += (share - radar.inlier_ratio) * (1.0 - std::exp(-elapsed_s / kInlierMemory_s));

  radar.spread.add(sums.information, sums.feigned, sums.inliers, std::exp(-elapsed_s / kSpreadMemory_s));
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
  Eigen::Matrix3d rotation_covariance;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      rotation_covariance(i, j) = state_.covariance(column::of_radar(index) + i, column::of_radar(index) + j);
    }
  }
  const std::uint32_t suspicious =
      knocks_.add(index, time_ns, by_turn.bottomRightCorner<2, 2>(), turn_score.tail<2>(), sums.standing, detections);
  const std::uint32_t changed =
      strange ? 0 : small_knocks_.add(index, time_ns, by_turn, turn_score, rotation_covariance);
  if (suspicious != 0) watch(suspicious, time_ns);
  if (changed != 0) follow(changed, time_ns);
  if (strange || radar.phase != Phase::kRunning || small_knocks_.doubted(index)) return;
  if (!state_.update(information, score)) return;
  linearise(index);
  learn_noise(index, sums, elapsed_s);
  radar.since_earlier_s += elapsed_s;
  if (radar.since_earlier_s > kEarlier_s) {
    radar.earlier = {radar.earlier[1], radar.earlier[2], now(index)};
    radar.since_earlier_s = 0.0;
  }
  // How large a knock was becomes clearer for a while.
  if (radar.knock.count > 0 && radar.since_start_s < kKnockMeasured_s) measure_knock(index);
  ++radar.scans_used;
  radar.detections_used += static_cast<std::uint64_t>(sums.inliers);
}

/// The angles' noise as the residuals show it is a measurement of that column as well.
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

/// Derivatives follow the estimate about axes that are known, and there only by steps that matter; about others
/// whenever the data have halved what is unknown, which noise along an unobservable direction never does.
void RobustFilter::linearise(std::size_t index) {
  Eigen::Matrix3d& at = state_.linearised[index];
  const Eigen::Vector3d off = geometry::so3_log(state_.sensor_to_vehicle[index] * at.transpose());
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Index row = column::of_radar(index) + i;
    const double variance = state_.covariance(row, row);
    double& before = radars_[index].linearised_variance(i);
    const bool known = variance < square(kKnownShare * config_.prior_rotation_std_rad);
    if ((known && std::abs(off(i)) > kLinearStep_rad) || variance < 0.25 * before) {
      turn(i) = off(i);
      before = variance;
    }
  }
  const double scale_off = state_.speed_scale - state_.linearised_speed_scale;
  if (state_.covariance(column::kSpeedScale, column::kSpeedScale) <
          square(kKnownShare * config_.prior_speed_scale_std) &&
      std::abs(scale_off) > kLinearStep_rad) {
    state_.linearised_speed_scale = state_.speed_scale;
  }
  if (!turn.isZero()) at = geometry::so3_exp(turn) * at;
}

void RobustFilter::note_linearised(std::size_t index) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Index row = column::of_radar(index) + i;
    radars_[index].linearised_variance(i) = state_.covariance(row, row);
  }
}

void RobustFilter::forget_deviations(std::size_t index) {
  knocks_.clear(index);
  small_knocks_.clear(index);
}

/// What grew over a minute is a drift: followed, but not reported as a knock.
bool RobustFilter::drifts(std::size_t index) const {
  const Eigen::Vector2d& own = knocks_.deviation(index);
  return !knocks_.collapsed(index) && own.dot(knocks_.drift(index)) > kDriftShare * own.squaredNorm();
}

void RobustFilter::watch(std::uint32_t suspicious, std::int64_t time_ns) {
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if ((suspicious >> r & 1u) == 0 || radars_[r].phase != Phase::kRunning) continue;
    radars_[r].drifted = drifts(r);
    radars_[r].phase = Phase::kSuspected;
    radars_[r].suspected_ns = time_ns;
    radars_[r].before_knock = radars_[r].earlier[0].sensor_to_vehicle;
    radars_[r].start.clear();
  }
}

/// What is learnt of yaw is yaw as it shows: with a roll r and a pitch p (about the vehicle's axes) that are not known
/// it differs by r·p/2 from that of the rotation, and by ε·(r·cos ψ + p·sin ψ) if what is seen at ψ from the vehicle's
/// x axis stands at a mean elevation ε which nobody measures. Both stay the same however long the car drives.
double RobustFilter::second_order_yaw_variance(std::size_t index) const {
  const Eigen::Index first = column::of_radar(index);
  const double roll = state_.covariance(first, first), pitch = state_.covariance(first + 1, first + 1);
  const Eigen::Vector2d ahead = state_.sensor_to_vehicle[index].topLeftCorner<2, 1>();
  const double tilt =
      (ahead.x() * ahead.x() * roll + 2.0 * ahead.x() * ahead.y() * state_.covariance(first, first + 1) +
       ahead.y() * ahead.y() * pitch) /
      std::max(ahead.squaredNorm(), 1e-6);
  // That mean is as uncertain as the lowering.
  const double mean_square = square(radars_[index].mean_sine) * (1.0 + square(kElevationExcessStd));
  return mean_square * std::max(tilt, 0.0) + 0.25 * roll * pitch;
}

/// A small change needs no new start: from where the estimate was before, turned by what the last window showed, the
/// data lead it on once its covariance admits the change. About an axis that was not seen to change there may be one as
/// large that is not seen yet; but roll is seen last, and what else moved with it would have been seen long before.
void RobustFilter::follow(std::uint32_t changed, std::int64_t time_ns) {
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if ((changed >> r & 1u) == 0 || radars_[r].phase != Phase::kRunning) continue;
    Radar& radar = radars_[r];
    const bool tilted = small_knocks_.changed(r, 1) || small_knocks_.changed(r, 2);
    double size_squared = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (small_knocks_.changed(r, a)) size_squared += square(small_knocks_.change(r)(static_cast<Eigen::Index>(a)));
    }
    // After a change a few seconds ago, what was before is no better.
    const bool again = radar.since_change_s < static_cast<double>(radar.earlier.size()) * kEarlier_s;
    const Radar::Earlier before = again ? now(r) : radar.earlier[0];
    if (tilted) {
      Eigen::Vector3d turn = geometry::so3_log(before.sensor_to_vehicle * state_.sensor_to_vehicle[r].transpose());
      for (std::size_t a = 1; a < 3; ++a) {
        const auto i = static_cast<Eigen::Index>(a);
        if (small_knocks_.changed(r, a)) turn(i) = small_knocks_.change(r)(i);
      }
      state_.sensor_to_vehicle[r] = state_.linearised[r] = geometry::so3_exp(turn) * state_.sensor_to_vehicle[r];
      radar.since_change_s = 0.0;
    }
    for (Eigen::Index i = 0; i < (tilted ? 3 : 1); ++i) {
      const Eigen::Index row = column::of_radar(r) + i;
      const double variance = state_.covariance(row, row);
      const double wanted =
          std::min(std::max(variance, before.variance(i)) + size_squared, square(config_.prior_rotation_std_rad));
      state_.add_variance(row, std::max(0.0, wanted - variance));
    }
    note_linearised(r);
    // Sudden or not does not show in roll, for which a window lasts too long.
    if (tilted && size_squared > square(config_.knock_least_rad) && !drifts(r)) {
      radar.before_knock = before.sensor_to_vehicle;
      radar.since_start_s = 0.0;
      radar.knock.time_ns = time_ns;
      ++radar.knock.count;
      measure_knock(r);
    }
    radar.earlier.fill(now(r));
    radar.since_earlier_s = 0.0;
    forget_deviations(r);
  }
}

RadarEstimate RobustFilter::estimate(std::size_t index) const {
  RadarEstimate out;
  if (index >= radars_.size()) return out;
  const Radar& radar = radars_[index];
  const Eigen::Index first = column::of_radar(index);
  out.state = radar.state;
  out.speed_scale = state_.speed_scale;
  out.sensor_to_vehicle = state_.sensor_to_vehicle[index];
  const std::array<Eigen::Index, 4> rows{column::kSpeedScale, first, first + 1, first + 2};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      out.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = state_.covariance(rows[i], rows[j]);
    }
  }
  out.covariance(3, 3) += second_order_yaw_variance(index);
  // An axis counts as observable once the data say clearly more than the prior did.
  const auto learnt = [&](Eigen::Index row, double prior_std) {
    return state_.covariance(row, row) < square(kLearntShare * prior_std);
  };
  const bool known = radar.phase != Phase::kStarting || radar.remembered;
  if (known && learnt(rows[0], config_.prior_speed_scale_std)) out.observable |= alignment_axis::kSpeedScale;
  if (known && learnt(rows[1], config_.prior_rotation_std_rad)) out.observable |= alignment_axis::kVehicleRoll;
  if (known && learnt(rows[2], config_.prior_rotation_std_rad)) out.observable |= alignment_axis::kVehiclePitch;
  if (known && learnt(rows[3], config_.prior_rotation_std_rad)) out.observable |= alignment_axis::kVehicleYaw;
  if (learnt(column::kYawRateBias, config_.prior_yaw_rate_bias_std_radps)) {
    out.observable |= alignment_axis::kYawRateBias;
  }
  if (learnt(column::kSlip, config_.prior_slip_coefficient_std_radps2pm)) out.observable |= alignment_axis::kSlip;
  out.yaw_rate_bias_radps = state_.yaw_rate_bias_radps;
  out.yaw_rate_bias_std_radps = std::sqrt(state_.covariance(column::kYawRateBias, column::kYawRateBias));
  out.slip_coefficient_radps2pm = state_.slip_radps2pm;
  out.slip_coefficient_std_radps2pm = std::sqrt(state_.covariance(column::kSlip, column::kSlip));
  out.angle_noise_scale = std::sqrt(radar.noise.angle_variance_factor());
  out.inlier_ratio = std::max(0.0, radar.inlier_ratio);
  out.scans_used = radar.scans_used;
  out.detections_used = radar.detections_used;
  out.seconds_of_drive = radar.seconds_of_drive;
  out.knock = radar.knock;
  return out;
}

void RobustFilter::predict(std::size_t index, const ScanDetections& scan, const EgoSample& ego,
                           std::span<double> out) const {
  const std::size_t count = std::min(scan.count, out.size());
  if (index >= radars_.size()) {
    std::fill_n(out.begin(), count, 0.0);
    return;
  }
  const Radar& radar = radars_[index];
  const ScanMotion3d motion{ego.speed_mps, ego.yaw_rate_radps, 0.0};
  const Eigen::Vector3d g =
      sensor_velocity(state_, Eigen::Vector4d::Zero(), index, radar.config.mounting_pose.position_m, motion).g;
  for (std::size_t i = 0; i < count; ++i) {
    const double mean_cosine = scan.has_elevation ? 1.0 : 1.0 - radar.unknown.at(scan.range_m[i]).lowering;
    out[i] = -mean_cosine * geometry::direction(scan.azimuth_rad[i], scan.elevation_rad[i]).dot(g);
  }
}

void RobustFilter::save(Memory& memory) const {
  memory = {};
  memory.number_of_radars = radars_.size();
  memory.speed_scale = state_.speed_scale;
  memory.yaw_rate_bias_radps = state_.yaw_rate_bias_radps;
  memory.slip_coefficient_radps2pm = state_.slip_radps2pm;
  const std::size_t size = memory.number_of_parameters();
  const auto row_of = [](std::size_t parameter) {
    if (parameter < Memory::kShared) return static_cast<Eigen::Index>(parameter);
    const std::size_t rest = parameter - Memory::kShared;
    return column::of_radar(rest / 3) + static_cast<Eigen::Index>(rest % 3);
  };
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      memory.covariance[i * size + j] = state_.covariance(row_of(i), row_of(j));
    }
  }
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const Radar& radar = radars_[r];
    const Eigen::Vector3d turn = geometry::so3_log(state_.sensor_to_vehicle[r] * radar.nominal.transpose());
    memory.radars[r] = {radar.config.id,
                        {turn.x(), turn.y(), turn.z()},
                        std::sqrt(radar.noise.angle_variance_factor()),
                        radar.seconds_of_drive};
  }
}

void RobustFilter::restore(const Memory& memory) {
  if (memory.number_of_radars != radars_.size()) return;
  const std::size_t size = memory.number_of_parameters();
  const auto variance = [&](std::size_t i) { return memory.covariance[i * size + i]; };
  const auto usable_variance = [](double v, double prior_std) { return v > 0.0 && v < square(prior_std); };
  state_.speed_scale = state_.linearised_speed_scale = memory.speed_scale;
  state_.yaw_rate_bias_radps = memory.yaw_rate_bias_radps;
  state_.slip_radps2pm = memory.slip_coefficient_radps2pm;
  // Correlations are not taken over: a block of twice the variance and more bounds them.
  const auto remembered = [&](double v, double floor_std, double prior_std) {
    if (!usable_variance(v, prior_std)) return square(prior_std);
    return std::min(config_.memory_inflation * v + square(floor_std), square(prior_std));
  };
  state_.set_variance(column::kSpeedScale,
                      remembered(variance(0), config_.memory_speed_scale_std, config_.prior_speed_scale_std));
  state_.set_variance(column::kYawRateBias, remembered(variance(1), 0.25 * config_.prior_yaw_rate_bias_std_radps,
                                                       config_.prior_yaw_rate_bias_std_radps));
  state_.set_variance(column::kSlip, remembered(variance(2), 0.25 * config_.prior_slip_coefficient_std_radps2pm,
                                                config_.prior_slip_coefficient_std_radps2pm));
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    Radar& radar = radars_[r];
    const Memory::Radar& known = memory.radars[r];
    const Eigen::Vector3d turn(known.rotation_vehicle_rad[0], known.rotation_vehicle_rad[1],
                               known.rotation_vehicle_rad[2]);
    if (known.id != radar.config.id || !turn.allFinite() || turn.norm() > 1.0) continue;
    state_.sensor_to_vehicle[r] = geometry::so3_exp(turn) * radar.nominal;
    for (std::size_t i = 0; i < 3; ++i) {
      state_.set_variance(column::of_radar(r) + static_cast<Eigen::Index>(i),
                          remembered(variance(Memory::kShared + 3 * r + i), config_.memory_rotation_std_rad,
                                     config_.prior_rotation_std_rad));
    }
    radar.noise.set_angle_scale(known.angle_noise_scale);
    radar.seconds_of_drive = known.seconds_of_drive;
    radar.remembered = true;
    radar.phase = Phase::kStarting;
    radar.start.clear();
  }
}

bool RobustFilter::seed(std::size_t index, const Eigen::Vector3d& rotation_vehicle_rad,
                        const Eigen::Matrix3d& covariance) {
  const bool usable = index < radars_.size() && rotation_vehicle_rad.allFinite() &&
                      rotation_vehicle_rad.norm() <= 1.0 && covariance.allFinite() &&
                      (covariance.diagonal().array() > 0.0).all();
  if (!usable) return false;
  Radar& radar = radars_[index];
  state_.sensor_to_vehicle[index] = geometry::so3_exp(rotation_vehicle_rad) * radar.nominal;
  const Eigen::Index first = column::of_radar(index);
  for (Eigen::Index i = 0; i < 3; ++i) state_.set_variance(first + i, covariance(i, i));
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) state_.set_covariance(first + i, first + j, covariance(i, j));
  }
  radar.seconds_of_drive = 0.0;
  radar.remembered = true;
  radar.phase = Phase::kStarting;
  radar.start.clear();
  return true;
}

}  // namespace boresight::alignment
