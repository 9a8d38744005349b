// Decides from scan to scan if a radar's range rates contradict the motion of the vehicle.
// Equations: docs/algorithms/ingest.md (I5)–(I8).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/ingest_gateway/core/contradiction_config.hpp"
#include "services/ingest_gateway/core/range_rate_consensus.hpp"
#include "services/ingest_gateway/core/sequential_test.hpp"
#include "services/ingest_gateway/core/stationary_share.hpp"

namespace boresight::ingest {

/// One sequential test for each motion of the sensor that may explain the range rates instead of the vehicle's, and one
/// for "no motion explains them". No allocation.
class EgoContradiction {
 public:
  explicit EgoContradiction(const RadarConfig& radar, const ContradictionConfig& config = {});

  /// True if this scan belongs to a series that contradicts the vehicle's motion. False if the vehicle's motion makes
  /// no test possible: unknown speed or yaw rate, below 5 m/s. A scan that cannot be tested itself (too few detections,
  /// or perhaps measured in reverse) belongs to the series before it. The speed is extrapolated by the acceleration
  /// from `ego.header.measurement_time_ns` to the time of the scan.
  [[nodiscard]] bool judge(const RadarScan& scan, std::int64_t measurement_time_ns, const EgoMotion& ego);

 private:
  /// Sums of the last scans, which lose weight with time.
  struct Pool {
    double tested = 0.0, by_ego = 0.0, by_chance = 0.0, distinct = 0.0;
    void add(const RangeRateConsensus::Support& support, double usual_chance, double keep);
  };
  void weigh_alternatives(const RangeRateConsensus::Support& support);
  void weigh_chance(const RangeRateConsensus::Support& support);
  void learn(const RangeRateConsensus::Support& support);

  ContradictionConfig config_;
  RangeRateConsensus consensus_;
  double scene_scans_, pooled_scans_, noise_scans_;  // of the same objects; of pool_; of the same noise
  std::vector<SequentialTest> alternatives_;
  SequentialTest chance_;
  Pool pool_;
  StationaryShare share_, share_so_far_;  // the latter with the scans that may yet turn out to contradict
  double chance_if_wrong_ = 0.0;          // support by chance in the present series that contradicts
  bool contradicts_ = false;
};

}  // namespace boresight::ingest
