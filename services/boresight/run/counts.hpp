// What the chain counts of a recording. Everything adds up: see run.json in config/schema/run.md.
#pragma once

#include <array>
#include <cstdint>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/boresight/run/results.hpp"

namespace boresight::run {

inline constexpr std::size_t kNumberOfPipelineFlags = 9;

/// Why the corrector rejected a detection; the first that applies.
enum class Rejection : std::uint8_t { kNone, kInvalid, kOutsideRegion, kWeak };
inline constexpr std::size_t kNumberOfRejections = 4;

struct RadarCounts {
  std::uint64_t scans = 0;
  std::uint64_t detections = 0;
  std::uint64_t dropped_detections = 0;                                  ///< beyond the capacity of a scan
  std::array<std::uint64_t, kNumberOfRejections> rejections{};           ///< detections; kNone stays 0
  std::array<std::uint64_t, kNumberOfProvenances> origins{};             ///< detections that were not rejected
  std::array<std::uint64_t, scan_integrity::kNumberOfBits> integrity{};  ///< scans with that fault
  std::array<std::uint64_t, kNumberOfPipelineFlags> flags{};             ///< scans that lacked that input
  std::uint64_t estimates = 0;                                           ///< published by the alignment estimator
};

struct Counts {
  std::uint64_t ego_motions = 0;
  std::uint64_t unknown_radar_scans = 0;  ///< of radars that are not in the vehicle file
  std::uint64_t tracks = 0;               ///< in all track lists
  std::uint64_t scans_out_of_order = 0;   ///< older than the tracks
  std::uint64_t tracker_restarts = 0;     ///< measurement time jumped: all tracks were dropped
  std::uint64_t tracker_at_budget = 0;    ///< scans in which the search for associations ended at its work budget
  std::uint64_t tracker_cut_gates = 0;    ///< scans in which objects that share detections were associated apart
  std::uint64_t tracker_dropped_detections = 0, tracker_dropped_objects = 0;  ///< beyond a capacity
  std::array<RadarCounts, kMaxRadars + 1> radars{};                           ///< by radar id
};

/// CPU time of the stages, ns.
struct StageTimes {
  std::int64_t estimator = 0, corrector = 0, ghost_filter = 0, tracker = 0, health = 0;
};

/// Why the corrector rejected a detection with these corrected_flag bits.
[[nodiscard]] Rejection rejection_of(std::uint16_t corrected_flags);
/// Adds detections, tracks, faults and missing inputs of a scan; the number of scans is counted by the caller.
void add(const ScanResult& result, Counts& counts);
/// Scans without an ego motion near their time: their detections are not classified.
[[nodiscard]] std::uint64_t scans_without_ego_motion(const Counts& counts);

}  // namespace boresight::run
