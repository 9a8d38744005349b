// Judges what was decoded of a recording, source by source: sound, damaged, or absent.
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

/// Times between scans, as counts in bins of five per cent, so that memory does not grow with the recording.
class Intervals {
 public:
  /// Ten microseconds and less … over an hour.
  void add(std::int64_t interval_ns);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// Seconds, within five per cent; 0 if there are none.
  [[nodiscard]] double median_s() const;
  [[nodiscard]] std::uint64_t longer_than(double seconds) const;

 private:
  static constexpr std::size_t kBins = 410;
  static double lower_edge_s(std::size_t bin);
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
};

/// What came of one radar, or (id 0) of the ego signals and of frames that belong to no source.
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
  /// The first scan and the latest lack frames: a recording begins and ends in the middle of a cycle.
  bool first_is_incomplete = false, last_is_incomplete = false;
  std::int64_t first_ns = 0, last_ns = 0;  ///< times of measurement
  Intervals intervals;
  std::uint64_t backwards = 0;  ///< scans measured before the one before
};

enum class Verdict : std::uint8_t { kSound, kDamaged, kAbsent };

class Check {
 public:
  Check() { add_source(0, "vehicle"); }
  void add_source(std::uint32_t id, std::string name);

  void take_scan(std::uint32_t id, const RadarScan& scan, const ingest::MeasurementTime& time);
  void take_ego(const ingest::MeasurementTime& time);
  /// A clock that jumps or is not synchronised is noted and no damage by itself: what matters of it is seen in the
  /// times of the scans.
  void take_fault(std::uint32_t id, Fault fault, std::string_view what);

  /// Intervals of more than two and a half median ones.
  [[nodiscard]] static std::uint64_t gaps(const SourceFindings& findings);
  /// Damaged: something was rejected, is missing or cannot be as the sensor sent it. A hundredth of the scans may be
  /// implausible or contradict the ego motion, as such judgements err. Absent: nothing came and nothing was rejected.
  [[nodiscard]] static Verdict judge(const SourceFindings& findings, const SourceStatistics& statistics);

  /// The report; `statistics` by radar id. `damaged` tells the verdict on the recording as a whole: damaged as soon as
  /// a source is, or a line or packet could not be read, or nothing at all came.
  [[nodiscard]] std::string report(const std::array<SourceStatistics, kMaxRadars + 1>& statistics,
                                   const recording::Counts& counts, bool& damaged) const;

 private:
  std::map<std::uint32_t, SourceFindings> sources_;
};

}  // namespace boresight::decode
