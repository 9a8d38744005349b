// Tests if the range rates of a scan agree with a motion near that of the vehicle.
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

/// Searches the sensor velocity with the most stationary detections (consensus of Kellner et al. 2013), for mounting
/// errors of up to 10° and speed errors of up to 5 %. The candidates form a fixed grid, so that the result is
/// deterministic and the cost bounded. No allocation.
class RangeRateConsensus {
 public:
  explicit RangeRateConsensus(const RadarConfig& radar);

  /// Other scales to test: ±0.5 … 1.6 times the speed, except near 1.
  static constexpr std::size_t kOtherScales = 21;
  static constexpr std::size_t kOpposite = 6;  ///< index of scale −1

  /// Numbers of detections.
  struct Support {
    std::size_t reported = 0;  ///< all detections, with or without information in their range rate
    std::size_t tested = 0;    ///< with information on the speed in their range rate; 0: no test possible
    std::size_t by_ego = 0;    ///< of the tested, stationary for the best velocity near the vehicle's
    // The others are 0 if enough detections are stationary.
    std::size_t by_chance = 0;                         ///< the same if each range rate belonged to another detection
    std::size_t alike = 0;                             ///< with the same predicted range rate as the other detection
    std::array<std::size_t, kOtherScales> by_other{};  ///< stationary if the vehicle moved that much faster or slower
  };
  [[nodiscard]] Support test(const RadarScan& scan, const EgoMotion& ego);

 private:
  static constexpr std::size_t kMaxTested = 128, kLanes = 16;
  static_assert(kMaxTested % kLanes == 0);
  struct Candidate {
    float along, across;  // velocity = along · nominal + across · nominal turned by 90°
  };
  [[nodiscard]] std::size_t select(const RadarScan& scan, const Eigen::Vector3f& velocity_mps);
  [[nodiscard]] std::size_t count(const Candidate& candidate, std::size_t tested) const;
  /// Index of the candidate with the most support, or of the first one with more than `enough`.
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
  // Of the tested detections: range rate, its derivatives by `along` and `across`, and its tolerance.
  alignas(64) std::array<float, kMaxTested> rate_, by_along_, by_across_, tolerance_;
};

}  // namespace boresight::ingest
