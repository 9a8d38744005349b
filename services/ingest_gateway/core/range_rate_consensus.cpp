#include "services/ingest_gateway/core/range_rate_consensus.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "services/common/geometry/frames.hpp"

namespace boresight::ingest {

namespace {

constexpr double kYawStep_rad = 2.0 * M_PI / 180.0;
constexpr double kScaleStep = 0.025;
/// Tolerance for a stationary reflector besides noise: micro motion, lateral slip, age of the ego motion.
constexpr float kTolerance_mps = 0.3F;
/// A predicted range rate that is nearly zero for all speeds has no information on the speed.
constexpr float kLeastShareOfSpeed = 0.3F;
constexpr std::size_t kLeastTestedPairs = 6;
/// With this share of support the search ends. In a tunnel most range rates are similar, so that two thirds fit even if
/// assigned at random.
constexpr double kEnough = 0.85;

/// An alternative of another direction has at least this share of its velocity across the vehicle's. Traffic moves
/// along the road: of the velocity of other vehicles, less lies across it (17° is a bend ahead, or a change of lanes).
constexpr float kLeastAcross = 0.3F;
/// Alternatives are as fast as those of other scales: objects that move with the vehicle have small relative speeds.
constexpr float kLeastAlternative = 0.5F, kMostAlternative = 1.6F;
/// Pairs of detections that propose an alternative in a scan, and the least sine of the angle between the two: noise
/// grows with its inverse.
constexpr std::size_t kPairs = 32;
/// Speeds of vehicles that may be in view at once, besides stationary objects (choice: two lanes), and the
/// number of detections that propose one.
constexpr std::size_t kSpeedsOfTraffic = 2, kTriedSpeeds = 12;
constexpr float kLeastSine = 0.3F;

}  // namespace

RangeRateConsensus::RangeRateConsensus(const RadarConfig& radar)
    : vehicle_to_sensor_(geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0).transpose().cast<float>()),
      position_m_(radar.mounting_pose.position_m),
      range_rate_std_mps_(static_cast<float>(radar.noise.range_rate_std_mps)),
      azimuth_std_rad_(static_cast<float>(radar.noise.azimuth_std_rad)) {
  std::size_t n = 0;
  for (int ring = 0; ring <= std::max(kYawSteps, kScaleSteps); ++ring) {
    for (int yaw = -kYawSteps; yaw <= kYawSteps; ++yaw) {
      for (int scale = -kScaleSteps; scale <= kScaleSteps; ++scale) {
        if (std::max(std::abs(yaw), std::abs(scale)) != ring) continue;
        const double k = 1.0 + scale * kScaleStep, angle_rad = yaw * kYawStep_rad;
        candidates_[n++] = {static_cast<float>(k * std::cos(angle_rad)), static_cast<float>(k * std::sin(angle_rad))};
      }
    }
  }
  n = 0;
  for (int tenths = -16; tenths <= 16; ++tenths) {
    if (std::abs(tenths) < 5 || (tenths > 8 && tenths < 12)) continue;
    alternatives_[n++] = {static_cast<float>(tenths) * 0.1F, 0.0F};
  }
}

RangeRateConsensus::Support RangeRateConsensus::test(const RadarScan& scan, const EgoMotion& ego) {
  const double yaw_rate = ego.has(ego_field::kYawRate) ? static_cast<double>(ego.yaw_rate_radps) : 0.0;
  const Eigen::Vector3d velocity =
      geometry::sensor_velocity(1.0, static_cast<double>(ego.speed_mps), yaw_rate, position_m_);
  const float interval = scan.range_rate_max_mps - scan.range_rate_min_mps;
  ambiguity_mps_ = scan.has(scan_field::kAmbiguity) && interval > 1.0F && std::isfinite(interval) ? interval : 0.0F;
  Support support;
  const Eigen::Vector3f velocity_mps = vehicle_to_sensor_ * velocity.cast<float>();
  mirror(velocity_mps);
  const std::size_t tested = select(scan, velocity_mps);
  if (tested < kLeastTestedPairs) return support;
  support.tested = tested;
  support.reported = reported_;
  const auto enough = static_cast<std::size_t>(kEnough * static_cast<double>(tested));
  last_best_ = best(tested, enough, support.by_ego);
  const bool is_majority = 2 * support.by_ego > tested;
  if (is_majority) last_clear_ = last_best_;
  support.is_clear = support.by_ego > enough;
  if (support.is_clear) return support;
  for (std::size_t k = 0; k < kAlternatives; ++k) {
    const Candidate& alternative = alternatives_[k];
    const bool differs = k < kOtherScales || std::abs(alternative.across) > kLeastAcross;
    support.by_alternative[k] = differs ? count(alternative, tested) : 0;
  }
  for (const std::size_t k : {kMirrored, kRemembered}) {
    const bool is_better = support.by_alternative[k] > support.by_ego;
    support.as_traffic[k - kMirrored] = is_better ? count_as_traffic(alternatives_[k], tested) : 0;
  }
  if (!is_majority) remember(tested, support.by_alternative[kRemembered]);
  // Support if each range rate belonged to a detection half the list away: the support by chance.
  support.distinct = tested - count_alike(tested);
  std::rotate(rate_.begin(), rate_.begin() + tested / 2, rate_.begin() + tested);
  support.by_chance_of_one = count(candidates_.front(), tested);
  static_cast<void>(best(tested, tested, support.by_chance));
  return support;
}

/// The velocity that a sound radar would have if its azimuths had this sign: reflected about the sensor's x axis. A
/// misalignment is reflected too.
void RangeRateConsensus::mirror(const Eigen::Vector3f& velocity_mps) {
  const float x = velocity_mps.x(), y = velocity_mps.y(), square = x * x + y * y;
  if (!(square > 0.0F)) return;
  const float along = (x * x - y * y) / square, across = -2.0F * x * y / square;
  const Candidate& sound = candidates_[last_clear_];
  alternatives_[kMirrored] = {sound.along * along + sound.across * across, sound.along * across - sound.across * along};
}

/// Two detections determine a velocity (random sample consensus, Fischler and Bolles 1981; here with fixed pairs). The
/// one with the most support is tested in later scans, since it fits this one by construction.
void RangeRateConsensus::remember(std::size_t tested, std::size_t supporting) {
  Candidate& remembered = alternatives_[kRemembered];
  for (std::size_t pair = 0; pair < kPairs; ++pair) {
    const std::size_t i = pair * (tested / kPairs + 1) % tested, j = (i + tested / 2 - pair / 8) % tested;
    const float determinant = by_along_[i] * by_across_[j] - by_along_[j] * by_across_[i];
    const float square = std::hypot(by_along_[i], by_across_[i]) * std::hypot(by_along_[j], by_across_[j]);
    if (!(std::abs(determinant) > kLeastSine * square)) continue;
    const Candidate found{(by_across_[i] * rate_[j] - by_across_[j] * rate_[i]) / determinant,
                          (by_along_[j] * rate_[i] - by_along_[i] * rate_[j]) / determinant};
    const float scale = std::hypot(found.along, found.across);
    if (std::abs(found.across) < kLeastAcross || scale < kLeastAlternative || scale > kMostAlternative) continue;
    const std::size_t by_found = count(found, tested);
    if (by_found <= supporting) continue;
    supporting = by_found;
    remembered = found;
  }
}

std::size_t RangeRateConsensus::select(const RadarScan& scan, const Eigen::Vector3f& velocity_mps) {
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  const bool has_elevation = scan.has(scan_field::kElevation);
  const float speed_mps = velocity_mps.norm();
  const std::size_t step = (count + kMaxTested - 1) / kMaxTested;
  const Candidate& mirrored = alternatives_[kMirrored];
  std::size_t tested = 0;
  reported_ = 0;
  for (std::size_t i = 0; i < count && tested < kMaxTested; i += step) {
    const float azimuth = scan.azimuth_rad[i], rate = scan.range_rate_mps[i];
    const float elevation = has_elevation ? scan.elevation_rad[i] : 0.0F;
    if ((scan.detection_flags[i] & detection_flag::kUntrusted) != 0) continue;
    if (ambiguity_mps_ == 0.0F && (scan.detection_flags[i] & detection_flag::kAmbiguous) != 0) continue;
    if (!(std::abs(azimuth) <= 4.0F && std::abs(elevation) <= 2.0F && std::abs(rate) <= 1000.0F)) continue;
    ++reported_;
    const float level = std::cos(elevation), x = level * std::cos(azimuth), y = level * std::sin(azimuth);
    const float along = x * velocity_mps.x() + y * velocity_mps.y();
    const float across = y * velocity_mps.x() - x * velocity_mps.y();
    const float upwards = std::sin(elevation) * velocity_mps.z();
    const float by_mirrored = mirrored.along * along + mirrored.across * across;
    if (std::max(std::abs(along), std::abs(by_mirrored)) < kLeastShareOfSpeed * speed_mps) continue;
    rate_[tested] = rate + upwards;
    by_along_[tested] = along;
    by_across_[tested] = across;
    tolerance_[tested] = kTolerance_mps + 2.0F * range_rate_std_mps_ +
                         std::abs(across) * (0.5F * static_cast<float>(kYawStep_rad) + 2.0F * azimuth_std_rad_) +
                         std::abs(along) * 0.5F * static_cast<float>(kScaleStep);
    ++tested;
  }
  // Fills the last block of lanes with entries that support no candidate.
  for (std::size_t i = tested; i % kLanes != 0; ++i) {
    rate_[i] = by_along_[i] = by_across_[i] = 0.0F;
    tolerance_[i] = -1.0F;
  }
  return tested;
}

float RangeRateConsensus::deviation_mps(const Candidate& candidate, std::size_t k) const {
  // Adding and taking away 1.5·2^23 rounds to a whole number, in a way that compilers turn into vector instructions.
  constexpr float kRounder = 12582912.0F;
  const float inverse = ambiguity_mps_ > 0.0F ? 1.0F / ambiguity_mps_ : 0.0F;
  const float residual = rate_[k] + candidate.along * by_along_[k] + candidate.across * by_across_[k];
  // Measured modulo the unambiguous interval: the nearest of the possible values.
  const float intervals = (residual * inverse + kRounder) - kRounder;
  return std::abs(residual - ambiguity_mps_ * intervals);
}

std::size_t RangeRateConsensus::count(const Candidate& candidate, std::size_t tested) const {
  std::array<std::int32_t, kLanes> supporting{};
  for (std::size_t i = 0; i < tested; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      supporting[lane] += deviation_mps(candidate, i + lane) < tolerance_[i + lane] ? 1 : 0;
    }
  }
  return static_cast<std::size_t>(std::accumulate(supporting.begin(), supporting.end(), 0));
}

std::bitset<RangeRateConsensus::kMaxTested> RangeRateConsensus::supporters(const Candidate& candidate,
                                                                           std::size_t tested) const {
  std::bitset<kMaxTested> supporting;
  for (std::size_t k = 0; k < tested; ++k) supporting[k] = deviation_mps(candidate, k) < tolerance_[k];
  return supporting;
}

/// Few objects determine no velocity across the road: for each, the alternative predicts the range rate that its speed
/// along the road gives. Takes the speed that explains most, then the one that explains most of the others, and so on.
std::size_t RangeRateConsensus::count_as_traffic(const Candidate& candidate, std::size_t tested) const {
  std::bitset<kMaxTested> left = supporters(candidate, tested);
  const std::size_t supporting = left.count(), step = supporting / kTriedSpeeds + 1;
  for (std::size_t speed = 0; speed < kSpeedsOfTraffic && left.any(); ++speed) {
    std::bitset<kMaxTested> most;
    for (std::size_t k = 0, nth = 0; k < tested; ++k) {
      if (!left[k] || nth++ % step != 0) continue;
      if (!(std::abs(by_along_[k]) > 0.0F)) continue;
      const std::bitset<kMaxTested> explained = left & supporters({-rate_[k] / by_along_[k], 0.0F}, tested);
      if (explained.count() > most.count()) most = explained;
    }
    left &= ~most;
  }
  return supporting - left.count();
}

std::size_t RangeRateConsensus::best(std::size_t tested, std::size_t enough, std::size_t& most) const {
  // The candidate of the last scan first: a misaligned sensor stays misaligned.
  std::size_t winner = last_best_;
  most = count(candidates_[winner], tested);
  for (std::size_t k = 0; k < kCandidates && most <= enough; ++k) {
    const std::size_t supporting = count(candidates_[k], tested);
    if (supporting > most) {
      most = supporting;
      winner = k;
    }
  }
  return winner;
}

std::size_t RangeRateConsensus::count_alike(std::size_t tested) const {
  std::size_t alike = 0;
  for (std::size_t i = 0; i < tested; ++i) {
    const std::size_t other = i + tested / 2 < tested ? i + tested / 2 : i + tested / 2 - tested;
    alike += std::abs(by_along_[i] - by_along_[other]) < tolerance_[i] ? 1u : 0u;
  }
  return alike;
}

}  // namespace boresight::ingest
