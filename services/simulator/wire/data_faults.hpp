// Damage to the lists that a simulated radar sends. The truth of the drive stays that of the undamaged lists.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/radar_effects.hpp"

namespace boresight::simulator::wire {

/// What a radar sends for a scan: the list, and how often. 0: the list is lost; 2: it comes twice.
struct SentList {
  const RadarScan* scan;
  std::uint32_t times;
};

/// Applies the faults of a scenario to the scans of a drive, in the order of measurement.
class DataFaults {
 public:
  DataFaults(std::vector<RadarDataFault> faults, std::uint64_t seed);

  /// `t_s`: time since the start of the drive. The result is valid until the next call.
  [[nodiscard]] SentList apply(const RadarScan& scan, const RadarConfig& radar, double t_s);

 private:
  /// The list as a copy that may be changed.
  RadarScan& own(SentList& sent);
  void apply_one(const RadarDataFault& fault, const RadarConfig& radar, std::size_t index, SentList& sent);

  std::vector<RadarDataFault> faults_;
  std::uint64_t seed_;
  std::unique_ptr<RadarScan> copy_;
  /// By fault and radar: the first list of a frozen radar.
  std::vector<std::array<std::unique_ptr<RadarScan>, kMaxRadars + 1>> frozen_;
};

}  // namespace boresight::simulator::wire
