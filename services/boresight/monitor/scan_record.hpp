// Every scan as the ghost filter told it and every track list, as lines of text: what `boresight monitor
// --record-scans` writes and a report is drawn from. About 20 MB a minute for four radars of 100 detections at 20 Hz.
#pragma once

#include <iosfwd>
#include <string>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"

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
  /// Both are read from until next() says that the end is reached.
  explicit ScanRecordReader(std::istream& input) : input_(input) {}
  /// What is on the next line that is complete; other lines are passed over. What the record does not hold of a message
  /// is 0; of what the corrector rejected the flag kWeak is set, whatever the reason was.
  [[nodiscard]] Line next(ClassifiedScan& scan, TrackList& tracks);

 private:
  std::istream& input_;
  std::string line_;
};

}  // namespace boresight::monitor
