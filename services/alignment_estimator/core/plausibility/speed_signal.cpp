#include "services/alignment_estimator/core/plausibility/speed_signal.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::alignment::plausibility {

namespace {

/// Speed signals are zero below about 0.5 m/s.
constexpr double kZero_mps = 0.3, kSlowest_mps = 3.0, kStandstill_mps = 1.0;
/// The vehicle moves if most of the field of view moves, and nearly nothing else stands still relative to the sensor.
/// Several radars that agree need less: they see different sides of the traffic.
constexpr double kMovingShare = 0.5, kAgreedShare = 0.35, kMostStanding = 0.15, kSureStanding = 0.3,
                 kStandingShare = 0.35;
/// Cosine of the largest angle between the sensor's velocity and the x axis: mounting error, and a turn.
constexpr double kAhead = 0.94;
/// Logarithms of odds that one window adds (choice: several windows of most radars are needed).
constexpr double kForMoving = 2.0, kForStanding = -6.0, kForNeither = -1.0, kForConstant = -0.5;
constexpr double kMostEvidence = 20.0, kSufficient = 12.0;
/// Of the sufficient evidence.
constexpr double kSomePart = 0.25;
/// A radar without windows for this time does not count.
constexpr double kActive_s = 2.0;
constexpr double kSeenTogether_s = 1.0;
/// Radars agree on the speed within this: noise of the fit, positions in a turn, scales.
constexpr double kAgreement_mps = 1.0, kAgreementPart = 0.1;
/// Hardest braking, between windows; beyond it, the fit has changed to another object.
constexpr double kHardest_mps2 = 8.0, kJump_mps = 0.5;
/// A change of speed that a signal cannot miss, and one that is none.
constexpr double kChange_mps = 1.0, kChangePart = 0.08, kNoChange_mps = 0.5, kNoChangePart = 0.03;
constexpr double kLeastMissing_s = 1.0, kLeastConstant_s = 1.0;
/// A signal that changes and differs from the seen speed by less has the right unit.
constexpr double kMostScaleError = 0.15;

}  // namespace

void SpeedSignal::clear(Fault fault) {
  for (Radar& radar : radars_) radar.evidence[fault] = 0.0;
}

void SpeedSignal::add_signal(const EgoSample& ego, double time_s) {
  if (!ego.valid || ego.stale) {
    missing_since_s_ = std::min(missing_since_s_, time_s);
    return;
  }
  if (missing_since_s_ < 1e18) clear(kMissing);
  missing_since_s_ = 1e18;
  is_missing_ = false;
  const bool is_zero = std::abs(ego.speed_mps) < kZero_mps;
  if (!is_zero) clear(kZero);
  is_zero_ = is_zero;
  // A signal that measures changes in its last digit; only a frozen one is exactly constant while the speed changes.
  if (std::abs(ego.speed_mps - speed_mps_) > 1e-6) {
    constant_since_s_ = time_s;
    is_frozen_ = false;
    clear(kFrozen);
  }
  speed_mps_ = ego.speed_mps;
}

bool SpeedSignal::is_alone(std::size_t radar, double time_s) const {
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    if (i != radar && time_s - radars_[i].seen_s <= kActive_s) return false;
  }
  return true;
}

bool SpeedSignal::agrees(std::size_t radar, double speed_mps, double time_s) const {
  std::size_t others = 0, agreeing = 0;
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    if (i == radar || time_s - radars_[i].seen_s > kActive_s) continue;
    ++others;
    const double tolerance_mps = kAgreement_mps + kAgreementPart * speed_mps;
    if (time_s - radars_[i].moving_s < kSeenTogether_s && std::abs(radars_[i].speed_mps - speed_mps) < tolerance_mps) {
      ++agreeing;
    }
  }
  return others > 0 && 2 * agreeing >= others;
}

void SpeedSignal::add_velocity(std::size_t index, const VelocityFit& fit, const Eigen::Vector2d& velocity_mps,
                               double time_s) {
  Radar& radar = radars_[index];
  const double speed_mps = velocity_mps.norm();
  const bool is_standing =
      fit.valid && ((speed_mps < kStandstill_mps && fit.share >= kStandingShare) || fit.standing_share > kSureStanding);
  const bool is_alone_now = is_alone(index, time_s);
  const double least_share = is_alone_now ? kMovingShare : kAgreedShare;
  const bool is_moving = fit.valid && !is_standing && speed_mps > kSlowest_mps && fit.share >= least_share &&
                         fit.standing_share < kMostStanding && velocity_mps.x() > kAhead * speed_mps;
  const double since_s = time_s - radar.moving_s;
  const bool continues = since_s > 0.0 && since_s < kActive_s &&
                         std::abs(speed_mps - radar.speed_mps) < kHardest_mps2 * since_s + kJump_mps;
  const double step = is_standing                                                                    ? kForStanding
                      : is_moving && continues && (is_alone_now || agrees(index, speed_mps, time_s)) ? kForMoving
                                                                                                     : kForNeither;
  const auto count = [&](Fault fault) {
    double& evidence = radar.evidence[fault];
    const double least = is_standing ? -kMostEvidence : std::min(evidence, 0.0);
    evidence = std::clamp(evidence + step, least, kMostEvidence);
  };
  const bool is_missing = time_s - missing_since_s_ > kLeastMissing_s;
  if (is_missing) {
    count(kMissing);
  } else if (is_zero_) {
    count(kZero);
  } else if (is_moving && (is_alone_now || agrees(index, speed_mps, time_s))) {
    judge_frozen(radar, speed_mps, continues, time_s);
  }
  radar.seen_s = time_s;
  if (is_moving) {
    radar.moving_s = time_s;
    radar.speed_mps = speed_mps;
  }
  is_missing_ = is_missing_ || sum(kMissing, time_s) > 1.0;
  is_frozen_ = is_frozen_ || sum(kFrozen, time_s) > 1.0;
}

void SpeedSignal::judge_frozen(Radar& radar, double speed_mps, bool continues, double time_s) {
  const double signal_mps = std::abs(speed_mps_);
  if (time_s - constant_since_s_ < kLeastConstant_s) {
    const double scale = signal_mps > kSlowest_mps ? speed_mps / signal_mps : 0.0;
    if (std::abs(scale - 1.0) < kMostScaleError) radar.scale = scale;
    return;
  }
  double& evidence = radar.evidence[kFrozen];
  double reference_mps = radar.scale * signal_mps;
  if (radar.scale == 0.0) {
    // The signal has never changed: the first speed that was seen counts.
    if (!continues || radar.reference_s < constant_since_s_) {
      radar.reference_s = time_s;
      radar.reference_mps = speed_mps;
      evidence = 0.0;
    }
    reference_mps = radar.reference_mps;
  }
  const double change_mps = std::abs(speed_mps - reference_mps);
  if (change_mps > std::max(kChange_mps, kChangePart * reference_mps)) {
    if (continues) evidence = std::min(evidence + kForMoving, kMostEvidence);
  } else if (change_mps < std::max(kNoChange_mps, kNoChangePart * reference_mps)) {
    evidence = std::max(evidence + kForConstant, 0.0);
  }
}

double SpeedSignal::sum(Fault fault, double time_s) const {
  double sum = 0.0, sufficient = 0.0;
  for (const Radar& radar : radars_) {
    if (time_s - radar.seen_s > kActive_s) continue;
    sum += radar.evidence[fault];
    sufficient += kSufficient;
  }
  return sufficient > 0.0 ? sum / sufficient : 0.0;
}

AlignmentFinding SpeedSignal::finding(double time_s) const {
  if (is_missing_ || sum(kMissing, time_s) > 1.0) return AlignmentFinding::kEgoMotionMissing;
  if (sum(kZero, time_s) > 1.0) return AlignmentFinding::kSpeedZero;
  return is_frozen_ || sum(kFrozen, time_s) > 1.0 ? AlignmentFinding::kSpeedFrozen : AlignmentFinding::kNone;
}

bool SpeedSignal::may_be_frozen(double time_s) const {
  return sum(kFrozen, time_s) > kSomePart;
}

}  // namespace boresight::alignment::plausibility
