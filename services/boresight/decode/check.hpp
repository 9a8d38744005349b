// Judges the decoded messages of a recording, source by source: sound, damaged, or absent.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/common/recording/reader.hpp"
#include "services/ingest_gateway/codecs/frame_stamp.hpp"

namespace boresight::decode {

/// Histogram of the times between scans in bins of five per cent, so that memory does not grow with the recording.
class Intervals {
 public:
  /// The bins cover ten microseconds and less to more than an hour.
  void add(std::int64_t interval_ns);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// In seconds, accurate to five per cent; 0 without intervals.
  [[nodiscard]] double median_s() const;
  [[nodiscard]] std::uint64_t longer_than(double seconds) const;

 private:
  static constexpr std::size_t kBins = 410;
  static double lower_edge_s(std::size_t bin);
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
};

/// Findings for one radar, or (id 0) for the ego signals and for frames that belong to no source.
struct SourceFindings {
  std::string name;
  std::uint64_t scans = 0;  ///< ego motions for id 0
  std::uint64_t detections = 0;
  std::uint64_t dropped_detections = 0;
  std::uint64_t rejected = 0;
  /// By reason, with numbers replaced by '#'; at most 32 reasons, then "other reasons".
  std::map<std::string, std::uint64_t, std::less<>> rejected_by_reason;
  std::map<std::string, std::uint64_t, std::less<>> noted_by_reason;     ///< likewise
  std::array<std::uint64_t, scan_integrity::kNumberOfBits> integrity{};  ///< scans with that bit
  /// The first and the last scan may lack frames, because a recording begins and ends in the middle of a cycle.
  bool first_is_incomplete = false, last_is_incomplete = false;
  std::int64_t first_ns = 0, last_ns = 0;  ///< times of measurement
  Intervals intervals;
  std::uint64_t backwards = 0;  ///< scans with a measurement time before that of the previous scan
};

enum class Verdict : std::uint8_t { kSound, kDamaged, kAbsent };

class Check {
 public:
  Check() { add_source(0, "vehicle"); }
  void add_source(std::uint32_t id, std::string name);

  void take_scan(std::uint32_t id, const RadarScan& scan, const ingest::MeasurementTime& time);
  void take_ego(const ingest::MeasurementTime& time);
  /// A clock that jumps or is not synchronised is noted, but is no damage: its effect shows in the times of the scans.
  void take_fault(std::uint32_t id, Fault fault, std::string_view what);

  /// Number of intervals longer than two and a half medians.
  [[nodiscard]] static std::uint64_t gaps(const SourceFindings& findings);
  /// Damaged: a message was rejected, is missing, or cannot have been sent by the sensor. One scan in a hundred may be
  /// implausible or contradict the ego motion, because these judgements are uncertain. Absent: no message was received
  /// and none was rejected.
  [[nodiscard]] static Verdict judge(const SourceFindings& findings, const SourceStatistics& statistics);

  /// The report; `statistics` by radar id. Sets `damaged`, the verdict on the whole recording: true if a source is
  /// damaged, if a line or packet could not be read, or if there is no message at all.
  [[nodiscard]] std::string report(const std::array<SourceStatistics, kMaxRadars + 1>& statistics,
                                   const recording::Counts& counts, bool& damaged) const;

 private:
  std::map<std::uint32_t, SourceFindings> sources_;
};

}  // namespace boresight::decode
