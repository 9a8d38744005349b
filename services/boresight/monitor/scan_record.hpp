// Every classified scan and every track list as lines of text: written by `boresight monitor --record-scans`, read by
// the report. About 20 MB per minute for four radars of 100 detections at 20 Hz.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <utility>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/boresight/monitor/damaged_lines.hpp"

namespace boresight::monitor {

/// Writes measurement time, flags, position of the sensor, and the reflector segments; for each detection its position,
/// range rate over ground, label and ghost probability.
void write_scan(std::ostream& output, const ClassifiedScan& scan);
/// Writes box, movement and number of detections of each confirmed track.
void write_tracks(std::ostream& output, const TrackList& list);

/// Reads a record back, line by line.
class ScanRecordReader {
 public:
  enum class Line { kScan, kTracks, kEnd };
  /// `input` is read until next() returns kEnd. Errors name it `name`.
  ScanRecordReader(std::istream& input, std::string name) : input_(input), name_(std::move(name)) {}
  /// Reads the next complete line; other lines are counted as damaged. Fields that the record does not contain are 0.
  /// Rejected detections get the flag kWeak, because the record does not contain the reason.
  [[nodiscard]] Line next(ClassifiedScan& scan, TrackList& tracks);
  /// Of the lines read so far.
  [[nodiscard]] const DamagedLines& damaged() const { return damaged_; }

 private:
  std::istream& input_;
  std::string name_;
  std::string line_;
  std::uint64_t number_ = 0;  // of line_, from 1
  DamagedLines damaged_;
};

}  // namespace boresight::monitor
