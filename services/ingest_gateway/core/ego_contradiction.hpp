// Whether a radar's range rates contradict the motion of the vehicle, judged over many scans.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "services/ingest_gateway/core/range_rate_consensus.hpp"

namespace boresight::ingest {

/// Pools the support of scans until some thousand detections have spoken, then decides and begins anew: one scan can be
/// full of traffic, the second or two that this takes a radar of many detections can not. A radar of a dozen tracks
/// takes half a minute. No allocation.
class EgoContradiction {
 public:
  explicit EgoContradiction(const RadarConfig& radar) : consensus_(radar) {}

  /// Whether this scan is one of a series that contradicts the vehicle's motion. False where it cannot be tested: speed
  /// or yaw rate unknown, below 5 m/s, too few detections. `ego.header.measurement_time_ns` is used to bring the speed
  /// to the time of the scan by the acceleration.
  [[nodiscard]] bool judge(const RadarScan& scan, std::int64_t measurement_time_ns, const EgoMotion& ego);

 private:
  struct Pool {
    std::size_t scans = 0, reported = 0, tested = 0, by_ego = 0, by_chance = 0, alike = 0;
    std::array<std::size_t, RangeRateConsensus::kOtherScales> by_other{};
  };
  void add(const RangeRateConsensus::Support& support);
  [[nodiscard]] bool is_dense() const;
  [[nodiscard]] bool contradicts();

  RangeRateConsensus consensus_;
  Pool pool_;
  bool contradicts_ = false;
  bool nothing_stood_still_ = false;  // in the pool before
};

}  // namespace boresight::ingest
