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

constexpr double kMaxSpeed_mps = 120.0, kMaxYawRate_radps = 4.0;

}  // namespace

WindowedFilter::Radar::Radar(const RadarConfig& radar, const FilterConfig& filter, const WindowsConfig& settings)
    : config(radar),
      nominal(geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0)),
      start(filter),
      sums(radar, filter, settings.priors, settings.sums),
      linearised(nominal) {}

WindowedFilter::WindowedFilter(const VehicleConfig& vehicle, const FilterConfig& config, const WindowsConfig& settings)
    : config_(config),
      priors_(settings.priors),
      sums_config_(settings.sums),
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
    radars_.emplace_back(vehicle.radars[r], config, settings);
    solver_.set_prior(r, radars_[r].nominal, true, radars_[r].sums.knots().step_rad);
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

void WindowedFilter::process(std::size_t index, const ScanDetections& scan, const EgoSample& ego) {
  if (index >= radars_.size()) return;
  Radar& radar = radars_[index];
  const double elapsed_s = radar.sums.elapsed_s(scan.time_ns);
  radar.last_time_ns = scan.time_ns;
  if (solver_.busy()) step();
  if (!usable(ego)) {
    const bool slow = ego.valid && !ego.stale && std::abs(ego.speed_mps) < config_.min_speed_mps;
    wait(radar, slow ? AlignmentReason::kTooSlow : AlignmentReason::kNoEgoMotion);
    return;
  }
  if (!radar.sums.take(scan, sightings_)) {
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
  const NoiseScale& learnt = radar.sums.learnt().noise;
  const double noise = std::max(learnt.rate_variance_factor(), learnt.angle_variance_factor());
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
  prior.point = solver_.point(index, driven_s_, load_);
  prior.speed_scale_variance = std::max(square(priors_.speed_scale_std), 1e-10);
  prior.rotation_variance = square(priors_.rotation_std_rad);
  prior.log_angle_noise_std = config_.prior_angle_noise_log_std;
  ScanMotion3d then = motion;
  then.speed_mps += prior.point.stamp_s * motion.acceleration_mps2;
  then.yaw_rate_radps += prior.point.stamp_s * motion.yaw_acceleration_radps2;
  const auto verdict = radar.start.add(sightings_, radar.config.mounting_pose.position_m, then, elapsed_s, prior,
                                       radar.sums.learnt().noise.angle_variance_factor());
  if (verdict != GraduatedStart::Verdict::kFound) return;
  const StartResult& found = radar.start.result();
  bool first = true;
  for (const Radar& other : radars_) first = first && !other.running;
  if (sightings_.has_elevation != solver_.radar(index).has_elevation) {
    set_has_elevation(index, sightings_.has_elevation);
  } else if (radar.remembered && contradicts_memory(index, found, then)) {
    solver_.forget_rotation(index, radar.nominal);
    radar.contradicted = true;
  }
  // Half a second of driving tells less than a memory.
  const bool begins_anew = !radar.remembered || radar.contradicted;
  if (begins_anew) solver_.radar(index).state.sensor_to_vehicle = found.sensor_to_vehicle;
  if (first && begins_anew) solver_.shared().speed_scale = found.speed_scale;
  radar.running = true;
  radar.linearised = solver_.point(index, driven_s_, load_).sensor_to_vehicle;
  radar.linearised_speed_scale = solver_.shared().speed_scale;
  radar.inlier_ratio = found.inlier_ratio;
  radar.sums.set_spread(found.spread);
  begin_block(index);
}

Point WindowedFilter::move_derivatives(std::size_t index) {
  Radar& radar = radars_[index];
  Point point = solver_.point(index, driven_s_, load_);
  const auto is_known = [&](double variance, double prior_std) {
    return variance < square(sums_config_.known_share * prior_std);
  };
  Eigen::Vector3d turn = geometry::so3_log(point.sensor_to_vehicle * radar.linearised.transpose());
  const auto variances = solver_.radar(index).covariance.diagonal().segment<3>(own::kRotation);
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_known(variances(axis), priors_.rotation_std_rad)) turn(axis) = 0.0;
  }
  radar.linearised = geometry::so3_exp(turn) * radar.linearised;
  const double scale_variance = solver_.shared_covariance()(shared::kSpeedScale, shared::kSpeedScale);
  if (is_known(scale_variance, priors_.speed_scale_std)) radar.linearised_speed_scale = point.speed_scale;
  point.sensor_to_vehicle = radar.linearised;
  point.speed_scale = radar.linearised_speed_scale;
  return point;
}

void WindowedFilter::begin_block(std::size_t index) {
  radars_[index].sums.begin_block(solver_.point(index, driven_s_, load_), move_derivatives(index),
                                  solver_.block_covariance(index), driven_s_ < kStart_s);
}

void WindowedFilter::update(std::size_t index, const ScanMotion3d& motion, const EgoSample& ego, double elapsed_s) {
  Radar& radar = radars_[index];
  const RadarSums::Counts counts = radar.sums.add(sightings_, motion, ego, elapsed_s);
  const double share = counts.stationary / counts.detections;
  radar.inlier_ratio += (share - radar.inlier_ratio) * (1.0 - std::exp(-elapsed_s / config_.inlier_memory_s));
  ++radar.scans_used;
  radar.detections_used += static_cast<std::uint64_t>(counts.inliers);
}

void WindowedFilter::close_block() {
  has_block_ = false;
  bool any = false;
  for (const Radar& radar : radars_) any = any || (radar.running && radar.sums.block().scans > 0);
  if (!any) return;
  while (solver_.busy()) step();
  judge_block();
  const bool due = segments_.size() == 0 ||
                   segments_.segment(segments_.size() - 1).seconds >= kSegment_s - 0.5 * kBlock_s ||
                   segments_.segment(segments_.size() - 1).load != load_;
  const MergeNoise noise = solver_.merge_noise();
  if (due) segments_.begin(load_, noise);
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if (radars_[r].running && radars_[r].sums.block().scans > 0 && !verdicts_[r].suspect) {
      segments_.add(r, radars_[r].sums.block(), kSegment_s, noise);
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
  write_solution(solver_, index, driven_s_, load_, radar.sums.knots(), radar.linearised, radar.sums.unmeasured(), out);
  out.drift.since_ns = radar.drift_since_ns;
  if (!radar.running && !radar.remembered) out.observable = out.nuisance.observable = 0;
  out.step_change = radar.step_change;
  out.load_change = load_change_;
  out.speed_change = speed_change_;
  out.angle_noise_scale = radar.sums.angle_noise_scale();
  if (radar.running || radar.remembered) {
    out.nuisance.range_rate_noise_scale = static_cast<float>(radar.sums.range_rate_noise_scale());
  }
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
    const double mean_cosine =
        scan.has_elevation ? 1.0 : 1.0 - radar.sums.unknown_elevation().at(scan.range_m[i]).lowering;
    out[i] = -mean_cosine * geometry::direction(scan.azimuth_rad[i], scan.elevation_rad[i]).dot(model.g);
  }
}

}  // namespace boresight::alignment
