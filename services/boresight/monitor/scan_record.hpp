// Every scan as the ghost filter told it and every track list, as lines of text: what `boresight monitor
// --record-scans` writes and a report is drawn from. About 20 MB a minute for four radars of 100 detections at 20 Hz.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <utility>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/boresight/monitor/damaged_lines.hpp"

namespace boresight::monitor {

/// Numbers a line of the record holds of a scan: measurement time, flags, the sensor's place, of each detection place,
/// range rate over ground, label and ghost probability, and the reflector segments.
void write_scan(std::ostream& output, const ClassifiedScan& scan);
/// Of the confirmed tracks: box, movement, number of detections.
void write_tracks(std::ostream& output, const TrackList& list);

/// Reads a record back, line by line.
class ScanRecordReader {
 public:
  enum class Line { kScan, kTracks, kEnd };
  /// `input` is read from until next() says that the end is reached; `name` is what errors call it.
  ScanRecordReader(std::istream& input, std::string name) : input_(input), name_(std::move(name)) {}
  /// What is on the next line that is whole; others are counted as damaged. What the record does not hold of a message
  /// is 0; of what the corrector rejected the flag kWeak is set, whatever the reason was.
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
