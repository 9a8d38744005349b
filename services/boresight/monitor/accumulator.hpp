// Messages in, snapshots out: the state of `boresight monitor` between two pictures.
#pragma once

#include <deque>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/boresight/monitor/snapshot.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::monitor {

/// Pure but for its own memory; `now_ns` is CLOCK_MONOTONIC. A radar that is not in the vehicle file gets a row with
/// the name "radar_<id>".
class Accumulator {
 public:
  explicit Accumulator(const VehicleConfig& vehicle);

  void observe(const RadarScan& scan, std::int64_t now_ns);
  void observe(const EgoMotion& ego);
  void observe(const AlignmentEstimate& estimate);
  void observe(const ClassifiedScan& scan);
  void observe(const TrackList& tracks);
  void observe(const HealthReport& report);
  void observe(const ServiceStatus& status);
  /// What a health report says of a radar, for a source that has it in words already.
  void explain(std::uint32_t radar_id, std::string explanation, const std::array<bool, 3>& beyond_tolerance);

  [[nodiscard]] Snapshot snapshot(std::int64_t now_ns) const;

 private:
  struct RadarMemory {
    RadarSnapshot seen;
    std::uint64_t last_sequence = 0;
    std::deque<std::int64_t> arrivals_ns;
  };
  [[nodiscard]] RadarMemory& radar(std::uint32_t id);
  [[nodiscard]] ServiceSnapshot& service(std::uint32_t index);

  VehicleConfig vehicle_;
  std::vector<RadarMemory> radars_;
  Snapshot current_;
};

}  // namespace boresight::monitor
