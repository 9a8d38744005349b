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
    others_[n++] = {static_cast<float>(tenths) * 0.1F, 0.0F};
  }
}

RangeRateConsensus::Support RangeRateConsensus::test(const RadarScan& scan, const EgoMotion& ego) {
  const double yaw_rate = ego.has(ego_field::kYawRate) ? static_cast<double>(ego.yaw_rate_radps) : 0.0;
  const Eigen::Vector3d velocity =
      geometry::sensor_velocity(1.0, static_cast<double>(ego.speed_mps), yaw_rate, position_m_);
  const float interval = scan.range_rate_max_mps - scan.range_rate_min_mps;
  ambiguity_mps_ = scan.has(scan_field::kAmbiguity) && interval > 1.0F && std::isfinite(interval) ? interval : 0.0F;
  Support support;
  const std::size_t tested = select(scan, vehicle_to_sensor_ * velocity.cast<float>());
  if (tested < kLeastTestedPairs) return support;
  support.tested = tested;
  support.reported = reported_;
  const auto enough = static_cast<std::size_t>(kEnough * static_cast<double>(tested));
  last_best_ = best(tested, enough, support.by_ego);
  if (support.by_ego > enough) return support;
  for (std::size_t k = 0; k < kOtherScales; ++k) support.by_other[k] = count(others_[k], tested);
  // Support if each range rate belonged to a detection half the list away: the support by chance.
  support.alike = count_alike(tested);
  std::rotate(rate_.begin(), rate_.begin() + tested / 2, rate_.begin() + tested);
  static_cast<void>(best(tested, tested, support.by_chance));
  return support;
}

std::size_t RangeRateConsensus::select(const RadarScan& scan, const Eigen::Vector3f& velocity_mps) {
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  const bool has_elevation = scan.has(scan_field::kElevation);
  const float speed_mps = velocity_mps.norm();
  const std::size_t step = (count + kMaxTested - 1) / kMaxTested;
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
    if (std::abs(along) < kLeastShareOfSpeed * speed_mps) continue;
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

std::size_t RangeRateConsensus::count(const Candidate& candidate, std::size_t tested) const {
  // Adding and taking away 1.5·2^23 rounds to a whole number, in a way that compilers turn into vector instructions.
  constexpr float kRounder = 12582912.0F;
  const float inverse = ambiguity_mps_ > 0.0F ? 1.0F / ambiguity_mps_ : 0.0F;
  std::array<std::int32_t, kLanes> supporting{};
  for (std::size_t i = 0; i < tested; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t k = i + lane;
      const float residual = rate_[k] + candidate.along * by_along_[k] + candidate.across * by_across_[k];
      // Measured modulo the unambiguous interval: the nearest of the possible values.
      const float intervals = (residual * inverse + kRounder) - kRounder;
      supporting[lane] += std::abs(residual - ambiguity_mps_ * intervals) < tolerance_[k] ? 1 : 0;
    }
  }
  return static_cast<std::size_t>(std::accumulate(supporting.begin(), supporting.end(), 0));
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
