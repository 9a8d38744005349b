#include "services/simulator/judge/alignment_judge.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::judge {

void AlignmentJudge::add(const AlignmentSample& estimate, const MountingTruth& truth) {
  const auto [place, is_new] = radars_.try_emplace(estimate.radar);
  RadarErrors& radar = place->second;
  if (is_new) radar.first_s = estimate.t_s;
  radar.last_s = std::max(radar.last_s, estimate.t_s);

  std::array<double, kJudged> error{kNaN, kNaN, kNaN, kNaN, kNaN};
  error[0] = estimate.speed_scale - truth.speed_scale;
  if (truth.has_rotation) {
    const Eigen::Vector3d turn = geometry::so3_log(estimate.rotation * truth.rotation.transpose());
    for (std::size_t i = 0; i < 3; ++i) error[i + 1] = turn(static_cast<Eigen::Index>(i));
    error[kAlignmentParameters] = estimate.load_pitch_rad - truth.load_pitch_rad;
  }
  radar.error = error;
  for (std::size_t i = 0; i < kJudged; ++i) {
    const bool is_load = i == kAlignmentParameters;
    const double variance = is_load ? estimate.load_pitch_variance : estimate.variances(static_cast<Eigen::Index>(i));
    radar.nees[i] = variance > 0.0 ? error[i] * error[i] / variance : kNaN;
    if (!std::isfinite(error[i]) || estimate.t_s - radar.first_s < kConvergence_s) continue;
    ++radar.samples[i];
    radar.squares[i] += error[i] * error[i];
    if (!std::isfinite(radar.nees[i])) continue;
    ++radar.nees_samples[i];
    radar.nees_sum[i] += radar.nees[i];
  }

  if (!truth.has_rotation) {
    radar.reported = std::max(radar.reported, estimate.step_changes);
    return;
  }
  radar.knows_changes = true;
  for (; radar.happened < truth.step_changes; ++radar.happened) radar.open_changes_s.push_back(estimate.t_s);
  for (; radar.reported < estimate.step_changes; ++radar.reported) {
    std::deque<double>& open_s = radar.open_changes_s;
    while (!open_s.empty() && estimate.t_s - open_s.front() > kLongestDetection_s) open_s.pop_front();
    if (open_s.empty()) {
      ++radar.false_changes;
    } else {
      open_s.pop_front();
      ++radar.found_changes;
    }
  }
}

void AlignmentJudge::write(FigureList& figures) const {
  constexpr std::array<const char*, kJudged> kParameterNames = {"speed_scale", "rotation_x", "rotation_y", "rotation_z",
                                                                "load_pitch"};
  double hours = 0.0, false_changes = 0.0, missed_changes = 0.0;
  bool knows_changes = false;
  for (const auto& [id, radar] : radars_) {
    const std::string name = "alignment.radar_" + std::to_string(id) + ".";
    for (std::size_t i = 0; i < kJudged; ++i) {
      if (i == kAlignmentParameters && std::isnan(radar.error[i])) continue;  // a run without an estimate of the load
      const double unit = i == 0 ? 1.0 : kDegreesPerRadian;
      const std::string parameter = name + kParameterNames[i];
      const std::string suffix = i == 0 ? "" : "_deg";
      const std::string_view sign = i == 0 ? "" : "°";
      figures.add(parameter + ".error" + suffix, unit * radar.error[i], sign);
      figures.add(parameter + ".rms" + suffix,
                  unit * std::sqrt(share_of(radar.squares[i], static_cast<double>(radar.samples[i]))), sign);
      figures.add(parameter + ".nees", radar.nees[i]);
      figures.add(parameter + ".nees_mean", share_of(radar.nees_sum[i], static_cast<double>(radar.nees_samples[i])));
    }
    figures.add(name + "step_changes", static_cast<double>(radar.reported));
    figures.add(name + "false_step_changes", radar.knows_changes ? radar.false_changes : kNaN);
    figures.add(name + "missed_step_changes", radar.knows_changes ? radar.happened - radar.found_changes : kNaN);
    knows_changes = knows_changes || radar.knows_changes;
    false_changes += radar.false_changes;
    missed_changes += radar.happened - radar.found_changes;
    hours = std::max(hours, (radar.last_s - radar.first_s) / 3600.0);
  }
  figures.add("alignment.false_step_changes", knows_changes ? false_changes : kNaN);
  figures.add("alignment.missed_step_changes", knows_changes ? missed_changes : kNaN);
  figures.add("alignment.false_step_changes_per_hour", knows_changes ? share_of(false_changes, hours) : kNaN, "1/h");
}

void HealthJudge::add(double t_s, std::uint32_t radar, bool reported_misaligned, bool is_misaligned) {
  const auto [place, is_new] = radars_.try_emplace(radar);
  RadarVerdicts& verdicts = place->second;
  if (!is_new) {
    const double held_s = std::max(0.0, t_s - verdicts.last_s);
    verdicts.judged_s += held_s;
    if (verdicts.reported && !verdicts.is_so) verdicts.false_alarm_s += held_s;
    if (!verdicts.reported && verdicts.is_so) verdicts.missed_s += held_s;
  }
  verdicts.last_s = is_new ? t_s : std::max(verdicts.last_s, t_s);
  verdicts.reported = reported_misaligned;
  verdicts.is_so = is_misaligned;
}

void HealthJudge::write(FigureList& figures) const {
  double judged_s = 0.0, false_alarm_s = 0.0, missed_s = 0.0;
  for (const auto& [id, radar] : radars_) {
    const std::string name = "health.radar_" + std::to_string(id) + ".";
    figures.add(name + "judged_s", radar.judged_s, "s");
    figures.add(name + "misaligned_though_within_tolerance_s", radar.false_alarm_s, "s");
    figures.add(name + "not_misaligned_though_beyond_tolerance_s", radar.missed_s, "s");
    judged_s += radar.judged_s;
    false_alarm_s += radar.false_alarm_s;
    missed_s += radar.missed_s;
  }
  const auto sum = [this](double value) { return radars_.empty() ? kNaN : value; };
  figures.add("health.judged_s", sum(judged_s), "s");
  figures.add("health.misaligned_though_within_tolerance_s", sum(false_alarm_s), "s");
  figures.add("health.not_misaligned_though_beyond_tolerance_s", sum(missed_s), "s");
}

}  // namespace boresight::judge
