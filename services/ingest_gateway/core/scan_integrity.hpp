// The integrity bits of one radar's scans.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/core/copies.hpp"
#include "services/ingest_gateway/core/ego_contradiction.hpp"

namespace boresight::ingest {

/// Results so far.
struct IntegrityCounters {
  std::uint64_t scans = 0;
  std::uint64_t lost_scans = 0;  ///< by the sensor's counter, or by time without one
  std::array<std::uint64_t, scan_integrity::kNumberOfBits> by_bit{};  ///< scans with that bit
};

/// Judges the scans of one radar, in the order of reception. No allocation.
class ScanJudge {
 public:
  explicit ScanJudge(const RadarConfig& radar, const ContradictionConfig& contradiction = {});

  /// Returns scan_integrity bits, including those of the decoder in `scan.integrity`. Does not read `scan.header`.
  /// `cycle_counter_bits`: width of the sensor's counter in `scan.cycle_counter`, 0 without a counter. `latest_ego`:
  /// the newest ego motion with its header; nullptr if unknown or stale.
  [[nodiscard]] std::uint16_t judge(const RadarScan& scan, std::int64_t measurement_time_ns, std::int64_t received_ns,
                                    unsigned cycle_counter_bits, const EgoMotion* latest_ego);

  [[nodiscard]] const IntegrityCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] std::uint16_t judge_order(const RadarScan& scan, std::int64_t measurement_time_ns, unsigned bits);
  [[nodiscard]] std::uint16_t judge_counter(std::uint32_t steps, unsigned bits, double cycles);
  [[nodiscard]] bool is_stale(std::int64_t measurement_time_ns, std::int64_t received_ns) const;
  void compare(std::uint64_t fingerprint);
  [[nodiscard]] bool is_frozen(std::size_t detections, const EgoMotion* ego) const;
  [[nodiscard]] bool is_implausible(const RadarScan& scan, std::size_t detections) const;

  FieldOfView field_of_view_;
  double cycle_ns_;
  EgoContradiction contradiction_;
  CopyCounter copies_;
  IntegrityCounters counters_;

  bool has_last_ = false;
  std::uint32_t last_counter_ = 0;
  unsigned last_counter_bits_ = 0;
  std::int64_t last_measured_ns_ = 0, last_received_ns_ = 0;
  std::uint64_t repeats_since_start_ = 0;  // of the counter, which has not changed yet
  bool counter_moves_ = false;
  std::uint64_t last_fingerprint_ = 0;
  std::uint64_t equal_scans_ = 0;  // in a row, after the first of them
};

}  // namespace boresight::ingest
