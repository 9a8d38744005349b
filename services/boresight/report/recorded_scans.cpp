#include "services/boresight/report/recorded_scans.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "services/boresight/monitor/snapshot.hpp"

namespace boresight::report {

namespace {

constexpr double kMostValue = 1e9;
constexpr std::int64_t kMostCount = std::numeric_limits<std::int64_t>::max();
/// Rows that are older belong to no scan that is still to come.
constexpr std::int64_t kOldest_ns = 2'000'000'000;

ScanRow key_of(const score::Table& table) {
  ScanRow row;
  row.radar = static_cast<std::uint32_t>(table.integer("radar", 1, kMaxRadars));
  row.scan = static_cast<std::uint64_t>(table.integer("scan", 0, kMostCount));
  row.time_ns = table.integer("time_ns", std::numeric_limits<std::int64_t>::min(), kMostCount);
  return row;
}

bool are_same(const ScanRow& a, const ScanRow& b) {
  return a.radar == b.radar && a.scan == b.scan && a.time_ns == b.time_ns;
}

float value_of(const score::Table& table, std::string_view column) {
  return static_cast<float>(table.number(column, -kMostValue, kMostValue));
}

float value_or(const score::Table& table, std::string_view column, float otherwise) {
  return table.text(column).empty() ? otherwise : value_of(table, column);
}

template <std::size_t N>
std::size_t index_of(const score::Table& table, std::string_view column, const std::array<std::string_view, N>& words) {
  const auto* const found = std::find(words.begin(), words.end(), table.text(column));
  if (found == words.end()) table.refuse(column, fmt::format("{}", fmt::join(words, ", ")));
  return static_cast<std::size_t>(found - words.begin());
}

std::uint16_t rejection_at(const score::Table& table) {
  constexpr std::array<std::string_view, 4> kWords = {"", "invalid", "outside_region", "weak"};
  constexpr std::array<std::uint16_t, 4> kFlags = {0, corrected_flag::kInvalid, corrected_flag::kOutsideRegion,
                                                   corrected_flag::kWeak};
  return kFlags.at(index_of(table, "rejected", kWords));
}

void read_detection(const score::Table& table, std::size_t i, ClassifiedScan& scan) {
  constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();
  scan.provenance[i] = static_cast<Provenance>(index_of(table, "origin", monitor::kLabelWords));
  scan.detection_flags[i] = rejection_at(table);
  scan.x_vehicle_m[i] = value_or(table, "x_vehicle_m", kNotKnown);
  scan.y_vehicle_m[i] = value_or(table, "y_vehicle_m", kNotKnown);
  scan.range_rate_over_ground_mps[i] = value_or(table, "range_rate_over_ground_mps", 0.0F);
  for (const char* const column : {"p_ghost_type_1", "p_ghost_type_2", "p_clutter"}) {
    scan.ghost_probability[i] += value_or(table, column, 0.0F);
  }
}

void read_reflector(const score::Table& table, ReflectorSegment& segment) {
  segment.start_vehicle_m = {value_of(table, "x1_vehicle_m"), value_of(table, "y1_vehicle_m")};
  segment.end_vehicle_m = {value_of(table, "x2_vehicle_m"), value_of(table, "y2_vehicle_m")};
}

void read_track(const score::Table& table, TrackList& list) {
  constexpr std::array<std::string_view, 2> kStatus = {"tentative", "confirmed"};
  constexpr std::array<std::string_view, 4> kMovements = {"unknown", "moving", "stationary", "stopped"};
  if (index_of(table, "status", kStatus) == 0) return;
  Track& track = list.tracks[list.number_of_tracks++];
  ++list.number_of_confirmed_tracks;
  track.status = TrackStatus::kConfirmed;
  track.tracking_id = static_cast<std::uint32_t>(table.integer("id", 1, std::numeric_limits<std::uint32_t>::max()));
  track.movement = static_cast<MovementState>(index_of(table, "movement", kMovements));
  track.position_vehicle_m = {value_of(table, "x_vehicle_m"), value_of(table, "y_vehicle_m"), 0.0F};
  track.velocity_over_ground_mps = {value_of(table, "vx_over_ground_mps"), value_of(table, "vy_over_ground_mps")};
  track.age_s = value_of(table, "age_s");
  track.heading_rad = value_of(table, "heading_rad");
  track.length_m = value_of(table, "length_m");
  track.width_m = value_of(table, "width_m");
  track.number_of_detections = static_cast<std::uint32_t>(table.integer("detections", 0, kMaxDetections));
}

}  // namespace

ScanRows::ScanRows(const std::filesystem::path& folder)
    : table_(folder / "scans.csv",
             {"time_ns", "radar", "scan", "detections", "flags", "sensor_x_m", "sensor_y_m", "tracks"}) {}

bool ScanRows::next(ScanRow& row) {
  if (!table_.next()) return false;
  row = key_of(table_);
  row.detections = static_cast<std::size_t>(table_.integer("detections", 0, kMaxDetections));
  row.tracks = static_cast<std::size_t>(table_.integer("tracks", 0, kMaxTracks));
  return true;
}

void ScanRows::read(ClassifiedScan& scan) const {
  const ScanRow row = key_of(table_);
  scan = {};
  scan.header.source_id = row.radar;
  scan.header.source_sequence = row.scan;
  scan.header.measurement_time_ns = row.time_ns;
  const std::string_view flags = table_.text("flags");
  if (flags.find("no_tracks") != std::string_view::npos) scan.flags |= pipeline_flag::kNoTracks;
  if (flags.find("tracks_stale") != std::string_view::npos) scan.flags |= pipeline_flag::kTracksStale;
  scan.geometry.sensor_position_vehicle_m = {value_of(table_, "sensor_x_m"), value_of(table_, "sensor_y_m"), 0.0F};
  scan.geometry.ego_speed_mps = value_or(table_, "ego_speed_mps", 0.0F);
  scan.geometry.ego_yaw_rate_radps = value_or(table_, "ego_yaw_rate_radps", 0.0F);
}

RecordedScans::RecordedScans(const std::filesystem::path& folder)
    : scans_(folder),
      detections_(folder / "detections.csv",
                  {"time_ns", "radar", "scan", "index", "x_vehicle_m", "y_vehicle_m", "range_rate_over_ground_mps",
                   "origin", "p_ghost_type_1", "p_ghost_type_2", "p_clutter", "rejected"}),
      reflectors_(folder / "reflectors.csv",
                  {"time_ns", "radar", "scan", "x1_vehicle_m", "y1_vehicle_m", "x2_vehicle_m", "y2_vehicle_m"}),
      tracks_(folder / "tracks.csv", {"time_ns", "radar", "scan", "id", "status", "movement", "x_vehicle_m",
                                      "y_vehicle_m", "vx_over_ground_mps", "vy_over_ground_mps", "age_s", "heading_rad",
                                      "length_m", "width_m", "detections"}) {}

template <typename Read>
void RecordedScans::take(Part& part, const ScanRow& scan, std::optional<std::size_t> stated, const Read& read) {
  if (stated == std::size_t{0}) return;
  const auto is_orphan = [&] {
    const ScanRow row = key_of(part.table);
    return !are_same(row, scan) && (stated.has_value() || row.time_ns < scan.time_ns - kOldest_ns);
  };
  while (part.has_row && is_orphan()) part.has_row = part.table.next();
  std::size_t rows = 0;
  for (; part.has_row && are_same(key_of(part.table), scan); part.has_row = part.table.next()) read(rows++);
  if (!stated || rows == *stated) return;
  throw score::InputError(fmt::format("{}: scan {} of radar {} has {} rows, scans.csv states {}", part.table.name(),
                                      scan.scan, scan.radar, rows, *stated));
}

bool RecordedScans::next(ClassifiedScan& scan, TrackList& tracks) {
  ScanRow row;
  if (!scans_.next(row)) return false;
  scans_.read(scan);
  scan.number_of_valid_detections = static_cast<std::uint32_t>(row.detections);
  take(detections_, row, row.detections, [&](std::size_t i) {
    if (i < row.detections) read_detection(detections_.table, i, scan);
  });
  take(reflectors_, row, std::nullopt, [&](std::size_t i) {
    if (i >= kMaxReflectorSegments) return;
    read_reflector(reflectors_.table, scan.reflector_segments[i]);
    scan.number_of_reflector_segments = static_cast<std::uint32_t>(i + 1);
  });
  tracks = {};
  tracks.header = scan.header;
  take(tracks_, row, row.tracks, [&](std::size_t i) {
    if (i < row.tracks) read_track(tracks_.table, tracks);
  });
  return true;
}

}  // namespace boresight::report
