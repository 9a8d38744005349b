// Do the range rates of a scan fit any motion near that of the vehicle?
// Equations: docs/algorithms/ingest.md (I2)–(I4).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::ingest {

/// Looks for the sensor velocity with the most detections that would stand still (Kellner et al.: "Instantaneous
/// ego-motion estimation using Doppler radar", 2013, whose consensus this is), among those that a mounting crooked by
/// up to 10° and a speed signal wrong by up to 5 % allow. The candidates form a fixed grid, so that the answer is
/// always the same and the cost bounded. No allocation.
class RangeRateConsensus {
 public:
  explicit RangeRateConsensus(const RadarConfig& radar);

  /// Wrong scales that are tried too: ±0.5 … 1.6 times the speed, but for what is near 1.
  static constexpr std::size_t kOtherScales = 21;
  static constexpr std::size_t kOpposite = 6;  ///< index of scale −1

  /// Numbers of detections.
  struct Support {
    std::size_t reported = 0;  ///< that a radar of this kind reports, whether their range rate tells something or not
    std::size_t tested = 0;    ///< whose range rate tells something; 0: the scan cannot be tested
    std::size_t by_ego = 0;    ///< of these, stationary for the best velocity near the vehicle's
    // The others are 0 if enough are stationary.
    std::size_t by_chance = 0;  ///< the same if each range rate belonged to another detection
    std::size_t alike = 0;      ///< whose predicted range rate is that of the detection they were confused with
    std::array<std::size_t, kOtherScales> by_other{};  ///< stationary if the vehicle moved that much faster or slower
  };
  [[nodiscard]] Support test(const RadarScan& scan, const EgoMotion& ego);

 private:
  static constexpr std::size_t kMaxTested = 128, kLanes = 16;
  static_assert(kMaxTested % kLanes == 0);
  struct Candidate {
    float along, across;  // the nominal velocity times these, and turned by a right angle
  };
  [[nodiscard]] std::size_t select(const RadarScan& scan, const Eigen::Vector3f& velocity_mps);
  [[nodiscard]] std::size_t count(const Candidate& candidate, std::size_t tested) const;
  /// Index of the candidate with the most support, or of the first with more than `enough`.
  [[nodiscard]] std::size_t best(std::size_t tested, std::size_t enough, std::size_t& most) const;
  [[nodiscard]] std::size_t count_alike(std::size_t tested) const;

  static constexpr int kYawSteps = 5, kScaleSteps = 2;  // to either side
  static constexpr std::size_t kCandidates = (2 * kYawSteps + 1) * (2 * kScaleSteps + 1);

  Eigen::Matrix3f vehicle_to_sensor_;
  std::array<double, 3> position_m_;
  float range_rate_std_mps_, azimuth_std_rad_;
  std::array<Candidate, kCandidates> candidates_;  // from the nominal one outwards
  std::array<Candidate, kOtherScales> others_;
  std::size_t last_best_ = 0;
  std::size_t reported_ = 0;
  float ambiguity_mps_ = 0.0F;  // width of the unambiguous interval, 0 if unknown
  // Of the tested detections: range rate, its change with `along` and `across`, and what it may be off by.
  alignas(64) std::array<float, kMaxTested> rate_, by_along_, by_across_, tolerance_;
};

}  // namespace boresight::ingest
