// Tests if the range rates of a scan agree with a motion near that of the vehicle.
// Equations: docs/algorithms/ingest.md (I2)–(I4).
#pragma once

#include <array>
#include <bitset>
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

  /// Alternatives to the vehicle's motion: other speeds (±0.5 … 1.6 times it, except near 1); the sensor velocity as a
  /// radar upside down sees it, with the sign of azimuth reversed; any other one that fitted an earlier scan.
  static constexpr std::size_t kOtherScales = 21, kMirrored = kOtherScales, kRemembered = kOtherScales + 1;
  static constexpr std::size_t kAlternatives = kOtherScales + 2;
  static constexpr std::size_t kOpposite = 6;  ///< index of scale −1

  /// Numbers of detections.
  struct Support {
    std::size_t reported = 0;          ///< all detections, with or without information in their range rate
    std::size_t tested = 0;            ///< with information on the speed in their range rate; 0: no test possible
    std::size_t by_ego = 0;            ///< of the tested, stationary for the best velocity near the vehicle's
    bool is_clear = false;             ///< so many that the others were not counted, and are 0
    std::size_t by_chance = 0;         ///< as by_ego, if each range rate belonged to another detection
    std::size_t by_chance_of_one = 0;  ///< the same for a single velocity instead of the best one
    std::size_t distinct = 0;          ///< whose predicted range rate differs from that of the other detection
    /// Stationary if the sensor moved otherwise; 0 for an alternative that does not differ or does not exist.
    std::array<std::size_t, kAlternatives> by_alternative{};
    /// Of kMirrored and kRemembered: of those that support it, also explained by objects of few speeds along the road.
    std::array<std::size_t, 2> as_traffic{};
  };
  [[nodiscard]] Support test(const RadarScan& scan, const EgoMotion& ego);

 private:
  static constexpr std::size_t kMaxTested = 128, kLanes = 16;
  static_assert(kMaxTested % kLanes == 0);
  /// velocity = along · nominal + across · nominal turned by 90°
  struct Candidate {
    float along = 0.0F, across = 0.0F;
  };
  [[nodiscard]] std::size_t select(const RadarScan& scan, const Eigen::Vector3f& velocity_mps);
  void mirror(const Eigen::Vector3f& velocity_mps);
  /// Of residual and whole intervals; below the tolerance if the detection supports the candidate.
  [[nodiscard]] float deviation_mps(const Candidate& candidate, std::size_t k) const;
  [[nodiscard]] std::size_t count(const Candidate& candidate, std::size_t tested) const;
  /// Index of the candidate with the most support, or of the first one with more than `enough`.
  [[nodiscard]] std::size_t best(std::size_t tested, std::size_t enough, std::size_t& most) const;
  [[nodiscard]] std::size_t count_alike(std::size_t tested) const;
  [[nodiscard]] std::size_t count_as_traffic(const Candidate& candidate, std::size_t tested) const;
  [[nodiscard]] std::bitset<kMaxTested> supporters(const Candidate& candidate, std::size_t tested) const;
  void remember(std::size_t tested, std::size_t supporting);

  static constexpr int kYawSteps = 5, kScaleSteps = 2;  // to either side
  static constexpr std::size_t kCandidates = (2 * kYawSteps + 1) * (2 * kScaleSteps + 1);

  Eigen::Matrix3f vehicle_to_sensor_;
  std::array<double, 3> position_m_;
  float range_rate_std_mps_, azimuth_std_rad_;
  std::array<Candidate, kCandidates> candidates_;  // from the nominal one outwards
  std::array<Candidate, kAlternatives> alternatives_{};
  std::size_t last_best_ = 0;
  std::size_t last_clear_ = 0;  // best candidate of the last scan that was stationary in its majority
  std::size_t reported_ = 0;
  float ambiguity_mps_ = 0.0F;  // width of the unambiguous interval, 0 if unknown
  // Of the tested detections: range rate, its derivatives by `along` and `across`, and its tolerance.
  alignas(64) std::array<float, kMaxTested> rate_, by_along_, by_across_, tolerance_;
};

}  // namespace boresight::ingest
