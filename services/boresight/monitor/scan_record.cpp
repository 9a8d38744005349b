#include "services/boresight/monitor/scan_record.hpp"

#include <algorithm>
#include <istream>
#include <iterator>
#include <ostream>
#include <string_view>

#include <fmt/format.h>

#include "services/boresight/monitor/words.hpp"

namespace boresight::monitor {

namespace {

/// A letter for each Provenance, in its order; and one for detections that the corrector rejected.
constexpr std::string_view kLetters = "ums12c";
constexpr char kRejected = 'x';
/// Closes a line, so that a line that was cut off is detected.
constexpr std::string_view kClosed = " .\n";

char letter_of(const ClassifiedScan& scan, std::size_t i) {
  if ((scan.detection_flags[i] & corrected_flag::kRejected) != 0) return kRejected;
  const auto index = static_cast<std::size_t>(scan.provenance[i]);
  return index < kLetters.size() ? kLetters[index] : kLetters[0];
}

void read_header(Words& words, MessageHeader& header) {
  words.read("source id", header.source_id);
  words.read("source sequence", header.source_sequence);
  words.read("measurement time", header.measurement_time_ns);
}

void read_scan(Words& words, ClassifiedScan& scan) {
  scan = {};
  read_header(words, scan.header);
  words.read("flags", scan.flags);
  for (float& coordinate : scan.geometry.sensor_position_vehicle_m) words.read("place of the sensor", coordinate);
  scan.number_of_valid_detections = words.at_most("number of detections", kMaxDetections);
  for (std::size_t i = 0; i < scan.number_of_valid_detections && words.ok(); ++i) {
    words.item("detection", i);
    const std::string_view letter = words.word();
    const std::size_t index = kLetters.find(letter);
    const bool rejected = letter == std::string_view(&kRejected, 1);
    if (letter.size() != 1 || (index == std::string_view::npos && !rejected)) {
      words.refuse("label", letter, fmt::format("a letter of {}{}", kLetters, kRejected));
      return;
    }
    scan.provenance[i] = rejected ? Provenance::kUnknown : static_cast<Provenance>(index);
    scan.detection_flags[i] = rejected ? corrected_flag::kWeak : std::uint16_t{0};
    words.read("x", scan.x_vehicle_m[i]);
    words.read("y", scan.y_vehicle_m[i]);
    words.read("range rate over ground", scan.range_rate_over_ground_mps[i]);
    words.read("ghost probability", scan.ghost_probability[i]);
  }
  words.no_item();
  scan.number_of_reflector_segments = words.at_most("number of reflector segments", kMaxReflectorSegments);
  for (std::size_t i = 0; i < scan.number_of_reflector_segments && words.ok(); ++i) {
    ReflectorSegment& segment = scan.reflector_segments[i];
    words.item("reflector segment", i);
    for (float& coordinate : segment.start_vehicle_m) words.read("start", coordinate);
    for (float& coordinate : segment.end_vehicle_m) words.read("end", coordinate);
  }
  words.close();
}

void read_tracks(Words& words, TrackList& list) {
  list = {};
  read_header(words, list.header);
  list.number_of_tracks = list.number_of_confirmed_tracks = words.at_most("number of tracks", kMaxTracks);
  for (std::size_t i = 0; i < list.number_of_tracks && words.ok(); ++i) {
    Track& track = list.tracks[i];
    words.item("track", i);
    track.status = TrackStatus::kConfirmed;
    words.read("id", track.tracking_id);
    track.movement = words.value("movement", MovementState::kStopped);
    words.read("x", track.position_vehicle_m[0]);
    words.read("y", track.position_vehicle_m[1]);
    words.read("heading", track.heading_rad);
    words.read("length", track.length_m);
    words.read("width", track.width_m);
    words.read("number of detections", track.number_of_detections);
  }
  words.close();
}

}  // namespace

void write_scan(std::ostream& output, const ClassifiedScan& scan) {
  fmt::memory_buffer line;
  const auto to = std::back_inserter(line);
  const auto& sensor = scan.geometry.sensor_position_vehicle_m;
  const std::size_t detections = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  fmt::format_to(to, "scan {} {} {} {} {:.3f} {:.3f} {:.3f} {}", scan.header.source_id, scan.header.source_sequence,
                 scan.header.measurement_time_ns, scan.flags, sensor[0], sensor[1], sensor[2], detections);
  for (std::size_t i = 0; i < detections; ++i) {
    fmt::format_to(to, " {} {:.2f} {:.2f} {:.2f} {:.3f}", letter_of(scan, i), scan.x_vehicle_m[i], scan.y_vehicle_m[i],
                   scan.range_rate_over_ground_mps[i], scan.ghost_probability[i]);
  }
  const std::size_t segments = std::min<std::size_t>(scan.number_of_reflector_segments, kMaxReflectorSegments);
  fmt::format_to(to, " {}", segments);
  for (std::size_t i = 0; i < segments; ++i) {
    const ReflectorSegment& s = scan.reflector_segments[i];
    fmt::format_to(to, " {:.2f} {:.2f} {:.2f} {:.2f}", s.start_vehicle_m[0], s.start_vehicle_m[1], s.end_vehicle_m[0],
                   s.end_vehicle_m[1]);
  }
  output.write(line.data(), static_cast<std::streamsize>(line.size())) << kClosed;
}

void write_tracks(std::ostream& output, const TrackList& list) {
  fmt::memory_buffer line;
  const auto to = std::back_inserter(line);
  const auto end = list.tracks.begin() + std::min<std::ptrdiff_t>(list.number_of_tracks, kMaxTracks);
  const auto is_confirmed = [](const Track& track) { return track.status == TrackStatus::kConfirmed; };
  fmt::format_to(to, "tracks {} {} {} {}", list.header.source_id, list.header.source_sequence,
                 list.header.measurement_time_ns, std::count_if(list.tracks.begin(), end, is_confirmed));
  for (auto t = list.tracks.begin(); t != end; ++t) {
    if (!is_confirmed(*t)) continue;
    fmt::format_to(to, " {} {} {:.2f} {:.2f} {:.4f} {:.2f} {:.2f} {}", t->tracking_id, static_cast<int>(t->movement),
                   t->position_vehicle_m[0], t->position_vehicle_m[1], t->heading_rad, t->length_m, t->width_m,
                   t->number_of_detections);
  }
  output.write(line.data(), static_cast<std::streamsize>(line.size())) << kClosed;
}

ScanRecordReader::Line ScanRecordReader::next(ClassifiedScan& scan, TrackList& tracks) {
  while (std::getline(input_, line_)) {
    ++number_;
    Words words(line_);
    const std::string_view kind = words.word();
    if (kind == "scan") {
      read_scan(words, scan);
      if (words.ok()) return Line::kScan;
    } else if (kind == "tracks") {
      read_tracks(words, tracks);
      if (words.ok()) return Line::kTracks;
    } else {
      words.refuse("kind of line", kind, "scan or tracks");
    }
    damaged_.add(name_, number_, words.error());
  }
  return Line::kEnd;
}

}  // namespace boresight::monitor
