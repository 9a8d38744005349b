// Changes: sudden misalignment of one radar, load, scale of the speed signal, drift.
#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/alignment_estimator/core/windows/windowed_filter.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

using namespace windows;

bool WindowedFilter::knows_yaw(std::size_t index) const {
  const double yaw_variance = solver_.radar(index).covariance(own::kRotation + 2, own::kRotation + 2);
  return radars_[index].running && yaw_variance < square(change_config_.settled_yaw_rad);
}

bool WindowedFilter::settled(std::size_t index) const {
  return knows_yaw(index) && changes_.windows(index) >= change_config_.settled_blocks &&
         driven_s_ >= change_config_.wait_s;
}

void WindowedFilter::judge_block() {
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    scales_[r] = {};
    if (!radars_[r].running) continue;
    const RadarSolution& s = solver_.radar(r);
    const Eigen::Vector3d rotation = s.covariance.diagonal().segment<3>(own::kRotation) +
                                     Eigen::Vector3d(0.0, s.fluctuation.variance[1], s.fluctuation.variance[0]);
    scales_[r] = scale_deviation_of(radars_[r].sums.block(), rotation, square(priors_.speed_scale_std), s.has_elevation,
                                    change_config_);
    work_[r] = scales_[r].value;
    work_stds_[r] = scales_[r].std;
  }
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if (!radars_[r].running) work_stds_[r] = 0.0;
  }
  const double scale = common_mean(work_, work_stds_, change_config_.speed.between_radars).value_or(0.0);
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const RadarSolution& s = solver_.radar(r);
    deviations_[r] = {};
    if (!radars_[r].running) continue;
    deviations_[r] = deviation_of(
        radars_[r].sums.block(), s.covariance(own::kRateScale, own::kRateScale) + s.fluctuation.variance[2],
        s.covariance(own::kRotation, own::kRotation), square(priors_.rotation_std_rad), s.has_elevation,
        std::abs(scale) > change_config_.suspect_scale ? scale : 0.0, change_config_);
    if (s.has_elevation) deviations_[r].estimate_std(0) = std::sqrt(estimate(r).covariance(2, 2));
  }
  changes_.judge(deviations_, verdicts_);
  bool all_known = driven_s_ >= change_config_.load_wait_s;
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    all_known = all_known && (knows_yaw(r) || !radars_[r].running);
    if (!settled(r)) {
      verdicts_[r].suspect = verdicts_[r].changed = false;
    }
    if (verdicts_[r].changed) take_change(r);
    if (verdicts_[r].suspect || !radars_[r].running) continue;
    radars_[r].learnt_before = radars_[r].sums.learnt();
  }
  if (all_known) judge_vehicle();
}

void WindowedFilter::judge_vehicle() {
  std::int64_t time_ns = 0;
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    Radar& radar = radars_[r];
    work_stds_[r] = 0.0;
    if (!radar.running) continue;
    const Point& point = radar.sums.block().point;
    const double scale = point.speed_scale * (1.0 + point.rate_scale);
    if (!(radar.reference_scale > 0.0)) {
      radar.reference = point.sensor_to_vehicle;
      radar.reference_scale = scale;
    }
    time_ns = std::max(time_ns, radar.last_time_ns);
    if (!deviations_[r].valid || !(deviations_[r].std(0) > 1e-5)) continue;
    work_[r] = geometry::so3_log(point.sensor_to_vehicle * radar.reference.transpose()).y() + deviations_[r].value(0);
    work_stds_[r] = deviations_[r].std(0);
  }
  if (const auto pitch = common_mean(work_, work_stds_, change_config_.load.between_radars)) {
    if (const auto step = load_watch_.add(*pitch)) take_load(*step, time_ns);
  }
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const Radar& radar = radars_[r];
    work_stds_[r] = radar.running ? scales_[r].std : 0.0;
    const double scale = radar.sums.block().point.speed_scale * (1.0 + radar.sums.block().point.rate_scale);
    if (radar.running) work_[r] = scale / radar.reference_scale - 1.0 + scales_[r].value;
  }
  if (const auto scale = common_mean(work_, work_stds_, change_config_.speed.between_radars)) {
    if (const auto step = speed_watch_.add(*scale)) take_speed(*step, time_ns);
  }
}

void WindowedFilter::judge_drift(std::size_t index) {
  constexpr int kSolutions = 3;  // in a row
  Radar& radar = radars_[index];
  const RadarSolution& s = solver_.radar(index);
  bool drifts = false;
  for (int axis = 0; axis < 2; ++axis) {
    const int c = own::kPitchDrift + axis;
    const double rate = std::abs(s.state.drift_radps(axis)), std = std::sqrt(s.covariance(c, c));
    const double least = change_config_.drift_rad / priors_.drift_span_s;
    drifts = drifts || (rate > least && rate > change_config_.drift_stds * std);
  }
  radar.drifting_solutions = drifts && radar.running ? radar.drifting_solutions + 1 : 0;
  if (radar.drifting_solutions == 0) radar.drift_since_ns = 0;
  if (radar.drifting_solutions == kSolutions) radar.drift_since_ns = radar.last_time_ns;
}

void WindowedFilter::take_change(std::size_t index) {
  Radar& radar = radars_[index];
  const Eigen::Vector3d turn(0.0, verdicts_[index].turn_rad(0), verdicts_[index].turn_rad(1));
  solver_.turn(index, turn);
  segments_.drop_latest(index, change_config_.unsure_s);
  segments_.forget(index, local::kRotation, 3);
  changes_.restart(index);
  radar.sums.set_learnt(radar.learnt_before);
  radar.reference = geometry::so3_exp(turn) * radar.reference;
  radar.linearised = geometry::so3_exp(turn) * radar.linearised;
  verdicts_[index].suspect = true;
  ++radar.step_change.count;
  radar.step_change.time_ns = radar.last_time_ns;
  for (int i = 0; i < 3; ++i)
    radar.step_change.rotation_vehicle_rad[static_cast<std::size_t>(i)] = static_cast<float>(turn(i));
  solved_s_ = -kSolve_s;  // solve at once
}

void WindowedFilter::take_load(const CommonStep& step, std::int64_t time_ns) {
  if (load_since_s_ >= 0.0) return;
  if (load_ == shared::kLoads) {
    segments_.forget_first_load();
    solver_.absorb_first_load();
    --load_;
  }
  ++load_;
  segments_.add_load(driven_s_ - static_cast<double>(step.blocks_ago - 1) * kBlock_s);
  solver_.stop();
  ++load_change_.count;
  load_change_.time_ns = time_ns;
  load_change_.size = static_cast<float>(-step.size);
  solved_s_ = -kSolve_s;
}

void WindowedFilter::take_speed(const CommonStep& step, std::int64_t time_ns) {
  segments_.forget_before(driven_s_ - static_cast<double>(step.blocks_ago - 1) * kBlock_s, local::kSpeedScale, 1);
  solver_.stop();
  ++speed_change_.count;
  speed_change_.time_ns = time_ns;
  speed_change_.size = static_cast<float>(step.size);
  solved_s_ = -kSolve_s;
}

void WindowedFilter::decide_load() {
  if (load_since_s_ < 0.0 || driven_s_ - load_since_s_ < change_config_.watch_s) return;
  const int step = load_ - 1;
  const double size = solver_.shared().load_rad[static_cast<std::size_t>(step)];
  const double limit = std::max(change_config_.load.least,
                                change_config_.load_after_restart_stds * std::sqrt(solver_.load_variance(step)));
  if (std::abs(size) > limit) {
    ++load_change_.count;
    load_change_.size = static_cast<float>(-size);
    for (const Radar& radar : radars_) load_change_.time_ns = std::max(load_change_.time_ns, radar.last_time_ns);
  } else {
    segments_.remove_load(load_);
    solver_.remove_load(step);
    --load_;
  }
  load_since_s_ = -1.0;
}

}  // namespace boresight::alignment
