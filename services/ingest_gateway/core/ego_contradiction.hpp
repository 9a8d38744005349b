// Decides over many scans if a radar's range rates contradict the motion of the vehicle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "services/ingest_gateway/core/range_rate_consensus.hpp"

namespace boresight::ingest {

/// Pools the support of scans over some thousand detections, then decides and starts a new pool. A single scan may
/// contain mostly moving objects; a pool, one to two seconds for a radar of many detections, does not. A radar of a
/// dozen tracks needs half a minute. No allocation.
class EgoContradiction {
 public:
  explicit EgoContradiction(const RadarConfig& radar) : consensus_(radar) {}

  /// True if this scan belongs to a series that contradicts the vehicle's motion. False if the test is not possible:
  /// unknown speed or yaw rate, below 5 m/s, too few detections. The speed is extrapolated by the acceleration from
  /// `ego.header.measurement_time_ns` to the time of the scan.
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
  bool nothing_stood_still_ = false;  // in the previous pool
};

}  // namespace boresight::ingest
