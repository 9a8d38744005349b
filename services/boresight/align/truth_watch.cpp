#include "services/boresight/align/truth_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/alignment_estimator/core/write_estimate.hpp"
#include "services/boresight/align/samples.hpp"
#include "services/common/estimation/unknown.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::align {

namespace {

/// The true mountings in the order of time; none if the truth does not contain the radar.
std::vector<TruthComparison::Mounting> true_mountings(const Truth& truth, const RadarConfig& config) {
  std::vector<TruthComparison::Mounting> mountings;
  const auto known = truth.radars.find(config.id);
  if (known == truth.radars.end()) return mountings;
  const auto add = [&](double from_s, const Truth::Radar& radar) {
    const Eigen::Matrix3d actual = true_mounting(radar, config.mounting_pose);
    const Eigen::Vector3d angles = alignment::vehicle_angles(config, actual);
    mountings.push_back(
        {from_s, actual, {truth.speed_scale_seen_by(config.id).value_or(kNaN), angles(0), angles(1), angles(2)}});
  };
  Truth::Radar radar = known->second;
  add(-std::numeric_limits<double>::infinity(), radar);
  for (const Truth::StepChange& step_change : truth.step_changes) {
    if (step_change.radar != config.id) continue;
    radar.sensor_rad = step_change.sensor_rad;
    add(step_change.time_s, radar);
  }
  return mountings;
}

}  // namespace

TruthWatch::TruthWatch(const std::optional<Truth>& truth, const RadarConfig& config) {
  seconds_to_95_percent_.fill(kNaN);
  change_begin_[0] = 1.0;
  if (truth) mountings_ = true_mountings(*truth, config);
}

std::optional<double> true_speed_scale(const Truth& truth, const Result& result) {
  double sum = 0.0, weights = 0.0;
  for (const RadarResult& radar : result.radars) {
    const std::optional<double> seen = truth.speed_scale_seen_by(radar.id);
    if (!seen || (radar.estimate.observable & alignment_axis::kSpeedScale) == 0) continue;
    const double weight = 1.0 / std::max(1e-18, radar.stds[0] * radar.stds[0]);
    sum += weight * *seen;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : truth.speed_scale;
}

void TruthWatch::observe(const RadarConfig& config, const alignment::RadarEstimate& estimate, double time_s) {
  if (!is_known()) return;
  while (now_ + 1 < mountings_.size() && mountings_[now_ + 1].from_s <= time_s) {
    const auto before = mountings_[now_].values;
    const auto after = mountings_[++now_].values;
    for (std::size_t i = 1; i < kParameters; ++i) {
      constexpr double kSame_rad = 1e-5;
      if (std::abs(after.at(i) - before.at(i)) < kSame_rad) continue;
      change_begin_.at(i) = before.at(i);
      change_begin_s_.at(i) = estimate.seconds_of_drive;
      seconds_to_95_percent_.at(i) = kNaN;
    }
  }
  const auto values = to_array(alignment::vehicle_form(config, estimate).values);
  for (std::size_t i = 0; i < kParameters; ++i) {
    const double goal = mountings_[now_].values.at(i);
    const bool is_there = std::abs(values.at(i) - goal) <= 0.05 * std::abs(goal - change_begin_.at(i));
    double& reached_s = seconds_to_95_percent_.at(i);
    if (!is_there) {
      reached_s = kNaN;
    } else if (std::isnan(reached_s)) {
      reached_s = estimate.seconds_of_drive - change_begin_s_.at(i);
    }
  }
}

TruthComparison TruthWatch::compare(const RadarConfig& config, const RadarResult& result) const {
  TruthComparison comparison;
  comparison.mountings = mountings_;
  comparison.seconds_to_95_percent = seconds_to_95_percent_;
  const TruthComparison::Mounting& truth = mountings_[now_];
  const Eigen::Matrix3d& estimated = result.estimate.sensor_to_vehicle;
  const auto values = to_array(alignment::vehicle_form(config, result.estimate).values);
  const std::array<double, kParameters>& stds = result.stds;
  for (std::size_t i = 0; i < kParameters; ++i) {
    comparison.errors.at(i) = values.at(i) - truth.values.at(i);
    const double normalised = comparison.errors.at(i) / stds.at(i);
    comparison.nees.at(i) = stds.at(i) > 0.0 ? normalised * normalised : kNaN;
  }
  const Eigen::Vector3d difference =
      geometry::euler_angles(estimated) - geometry::euler_angles(truth.sensor_to_vehicle);
  for (std::size_t i = 0; i < 3; ++i) {
    comparison.sensor_errors_rad.at(i) = geometry::wrap_angle(difference(static_cast<Eigen::Index>(i)));
  }
  comparison.true_now = now_;
  return comparison;
}

}  // namespace boresight::align
