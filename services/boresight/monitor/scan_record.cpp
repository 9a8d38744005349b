#include "services/boresight/monitor/scan_record.hpp"

#include <algorithm>
#include <charconv>
#include <istream>
#include <iterator>
#include <ostream>
#include <string_view>

#include <fmt/format.h>

namespace boresight::monitor {

namespace {

/// A letter for each Provenance, in its order; and one for what the corrector rejected.
constexpr std::string_view kLetters = "ums12c";
constexpr char kRejected = 'x';
/// Closes a line, so that one which was cut off is told from a whole one.
constexpr std::string_view kClosed = " .\n";

char letter_of(const ClassifiedScan& scan, std::size_t i) {
  if ((scan.detection_flags[i] & corrected_flag::kRejected) != 0) return kRejected;
  const auto index = static_cast<std::size_t>(scan.provenance[i]);
  return index < kLetters.size() ? kLetters[index] : kLetters[0];
}

/// The words of a line; `ok` turns false at the first that is missing or no number.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  [[nodiscard]] std::string_view word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
    const std::size_t end = std::min(rest_.find(' '), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    ok = ok && !word.empty();
    return word;
  }
  template <typename T>
  void read(T& value) {
    const std::string_view text = word();
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    ok = ok && result.ec == std::errc() && result.ptr == text.data() + text.size();
  }
  /// At most `limit`.
  [[nodiscard]] std::uint32_t count(std::size_t limit) {
    std::uint32_t value = 0;
    read(value);
    ok = ok && value <= limit;
    return ok ? value : 0;
  }
  bool ok = true;

 private:
  std::string_view rest_;
};

bool read_scan(Words& words, ClassifiedScan& scan) {
  scan = {};
  words.read(scan.header.source_id);
  words.read(scan.header.source_sequence);
  words.read(scan.header.measurement_time_ns);
  words.read(scan.flags);
  for (float& coordinate : scan.geometry.sensor_position_vehicle_m) words.read(coordinate);
  scan.number_of_valid_detections = words.count(kMaxDetections);
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    const std::string_view letter = words.word();
    const std::size_t index = kLetters.find(letter);
    if (letter.size() != 1 || (index == std::string_view::npos && letter[0] != kRejected)) return false;
    scan.provenance[i] = index == std::string_view::npos ? Provenance::kUnknown : static_cast<Provenance>(index);
    scan.detection_flags[i] = letter[0] == kRejected ? corrected_flag::kWeak : std::uint16_t{0};
    words.read(scan.x_vehicle_m[i]);
    words.read(scan.y_vehicle_m[i]);
    words.read(scan.range_rate_over_ground_mps[i]);
    words.read(scan.ghost_probability[i]);
  }
  scan.number_of_reflector_segments = words.count(kMaxReflectorSegments);
  for (std::size_t i = 0; i < scan.number_of_reflector_segments; ++i) {
    ReflectorSegment& segment = scan.reflector_segments[i];
    for (float& coordinate : segment.start_vehicle_m) words.read(coordinate);
    for (float& coordinate : segment.end_vehicle_m) words.read(coordinate);
  }
  return words.word() == "." && words.ok;
}

bool read_tracks(Words& words, TrackList& list) {
  list = {};
  words.read(list.header.source_id);
  words.read(list.header.source_sequence);
  words.read(list.header.measurement_time_ns);
  list.number_of_tracks = list.number_of_confirmed_tracks = words.count(kMaxTracks);
  for (std::size_t i = 0; i < list.number_of_tracks; ++i) {
    Track& track = list.tracks[i];
    track.status = TrackStatus::kConfirmed;
    std::uint32_t movement = 0;
    words.read(track.tracking_id);
    words.read(movement);
    track.movement = static_cast<MovementState>(std::min(movement, 3u));
    words.read(track.position_vehicle_m[0]);
    words.read(track.position_vehicle_m[1]);
    words.read(track.heading_rad);
    words.read(track.length_m);
    words.read(track.width_m);
    words.read(track.number_of_detections);
  }
  return words.word() == "." && words.ok;
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
    Words words(line_);
    const std::string_view tag = words.word();
    if (tag == "scan" && read_scan(words, scan)) return Line::kScan;
    if (tag == "tracks" && read_tracks(words, tracks)) return Line::kTracks;
  }
  return Line::kEnd;
}

}  // namespace boresight::monitor
