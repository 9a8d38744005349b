// Which explanation of all radars' data is reported.
#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/plausibility/plausibility.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::alignment::plausibility {

namespace {

/// Two radars have the same detections in most scans, as they must if one of them sends those of the other, which is
/// right: logarithm of the likelihood.
constexpr double kSameDetectionsLog = 12.5;
/// An explanation that only turns would distinguish from another one does not speak against that one.
constexpr double kAlikeLog = 4.0;
/// Of 360°, each other's mounting has 20°: logarithm of that likelihood.
constexpr double kTwoYawsLog = 3.0;
constexpr double kNever = -1e9;

}  // namespace

void Plausibility::add_limits(Radar& radar) const {
  const double limit = config_.yaw_limit_rad;
  radar.best_total = kNever;
  for (std::size_t h = 0; h < radar.hypotheses.size(); ++h) {
    // A yaw that is wrong by 180° is a range rate with the wrong sign.
    const bool any_yaw = h == kNominalYaw;
    const double low = any_yaw ? limit : 0.0, high = any_yaw ? M_PI - limit : limit;
    radar.totals[h] = radar.logs[h] + radar.hypotheses[h].log_within(low, high);
    if (!is_of_radar(h)) continue;
    radar.best_total = std::max(radar.best_total, radar.totals[h] - (h == kRight ? 0.0 : config_.prior_log_odds));
  }
}

bool Plausibility::is_mutual(std::size_t index, std::size_t other) const {
  const Radar& radar = radars_[other];
  return radar.windows > 0 && radar.totals[kOther + index] - config_.prior_log_odds > radar.best_total - kAlikeLog;
}

void Plausibility::decide(std::size_t index, double time_s) {
  Radar& radar = radars_[index];
  const AlignmentFinding of_speed = speed_signal_.finding(time_s);
  if (copies_.found(index) || of_speed != AlignmentFinding::kNone) {
    // They have their own limits.
    const AlignmentFinding finding = copies_.found(index) ? AlignmentFinding::kCopiedDetections : of_speed;
    radar.finding = radar.candidate = {finding, 0.0, 0};
    return;
  }
  Finding found;
  if (static_cast<double>(radar.windows) * config_.window_s >= config_.least_s) {
    const Best best = explain(index);
    found = name(index, best, config_.margin_log);
    if (found.finding == AlignmentFinding::kNone) {
      const Finding still = name(index, best, config_.margin_log / 2.0);
      if (still.finding == radar.finding.finding && still.radar == radar.finding.radar) found = still;
    }
  }
  if (found.finding == AlignmentFinding::kSpeedUnit && speed_signal_.may_be_frozen(time_s)) found = {};
  report(radar, found, time_s);
}

Plausibility::Best Plausibility::explain(std::size_t index) const {
  const Radar& radar = radars_[index];
  double others = 0.0;
  std::array<double, kOther> of_all{};
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    if (radars_[i].windows == 0) continue;
    if (i != index) others += radars_[i].best_total;
    for (std::size_t h = 0; h < kOther; ++h) of_all[h] += radars_[i].totals[h];
  }
  bool is_swapped = false;
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    is_swapped = is_swapped || (i != index && is_mutual(i, index) && is_mutual(index, i));
  }
  Best best;
  best.log = best.second_log = best.third_log = kNever;
  for (std::size_t h = 0; h < radar.hypotheses.size(); ++h) {
    if (h == kOther + index) continue;
    double log = h == kRight ? 0.0 : -config_.prior_log_odds;
    log += is_of_radar(h) ? others + radar.totals[h] : of_all[h];
    if (h == kNominalYaw) {
      // By chance, two wrong yaws are each other's.
      if (is_swapped) log -= kTwoYawsLog;
    } else if (h == kAzimuth || h == kRangeRate) {
      // Of all radars, for the same reason.
      log = std::max(log, of_all[h] - config_.prior_log_odds);
    } else if (h >= kOther) {
      // One cause explains the data of two radars.
      const Radar& other = radars_[h - kOther];
      const bool is_right = other.windows > 0 && other.totals[kRight] > other.best_total - kAlikeLog;
      if (is_mutual(index, h - kOther)) {
        log += config_.prior_log_odds;
      } else if (copies_.same(index, h - kOther)) {
        log += kSameDetectionsLog;
      } else if (is_right) {
        log -= kSameDetectionsLog;
      }
    }
    if (log > best.log) {
      best.third_log = best.second_log;
      best.second_log = best.log;
      best.second = best.hypothesis;
      best.log = log;
      best.hypothesis = h;
    } else if (log > best.second_log) {
      best.third_log = best.second_log;
      best.second_log = log;
      best.second = h;
    } else {
      best.third_log = std::max(best.third_log, log);
    }
  }
  return best;
}

Finding Plausibility::name(std::size_t index, const Best& best, double margin) const {
  const Radar& radar = radars_[index];
  const bool is_sign = (best.hypothesis == kAzimuth && best.second == kYawRate) ||
                       (best.hypothesis == kYawRate && best.second == kAzimuth);
  if (is_sign && best.log - best.second_log < margin && best.log - best.third_log >= margin) {
    return {AlignmentFinding::kAzimuthOrYawRate, 0.0, 0};
  }
  if (best.log - best.second_log < margin) return {};
  switch (best.hypothesis) {
    case kRight:
      return {};
    case kNominalYaw:
      return {AlignmentFinding::kNominalYawWrong, radar.hypotheses[kNominalYaw].yaw_rad(), 0};
    case kAzimuth:
      return {AlignmentFinding::kAzimuthMirrored, 0.0, 0};
    case kRangeRate:
      return {AlignmentFinding::kRangeRateMirrored, 0.0, 0};
    case kYawRate:
      return {AlignmentFinding::kYawRateMirrored, 0.0, 0};
    case kKmh:
      return {AlignmentFinding::kSpeedUnit, kKmhPerMps, 0};
    case kMph:
      return {AlignmentFinding::kSpeedUnit, kMphPerMps, 0};
    case kDegrees:
      return {AlignmentFinding::kYawRateUnit, kDegreesPerRadian, 0};
    default: {
      const std::size_t other = best.hypothesis - kOther;
      const auto finding = is_mutual(index, other) ? AlignmentFinding::kRadarsSwapped : AlignmentFinding::kOtherRadar;
      return {finding, 0.0, radars_[other].id};
    }
  }
}

void Plausibility::report(Radar& radar, const Finding& found, double time_s) const {
  if (found.finding != radar.candidate.finding || found.radar != radar.candidate.radar)
    radar.candidate_since_s = time_s;
  radar.candidate = found;
  const bool is_old = time_s - radar.candidate_since_s >= config_.least_s || time_s < radar.candidate_since_s;
  if (found.finding == radar.finding.finding && found.radar == radar.finding.radar) {
    radar.finding = found;  // its value
  } else if (is_old) {
    radar.finding = found;
  }
}

}  // namespace boresight::alignment::plausibility
