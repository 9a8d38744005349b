#include "services/boresight/score/run_folder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/header.hpp"
#include "services/boresight/run/words.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/simulator/judge/truth_files.hpp"

namespace boresight::score {

namespace {

constexpr double kLongestRun_s = 1e7;
constexpr double kMostValue = 1e9;
constexpr std::int64_t kMostCount = std::numeric_limits<std::int64_t>::max();

RunScan scan_of(const Table& table) {
  RunScan scan;
  scan.t_s = table.number("t_s", -kLongestRun_s, kLongestRun_s);
  scan.time_ns = table.integer("time_ns", -kLatest_ns, kLatest_ns);
  scan.radar = static_cast<std::uint32_t>(table.integer("radar", 1, kMaxRadars));
  scan.scan = static_cast<std::uint64_t>(table.integer("scan", 0, kMostCount));
  return scan;
}

bool is_of(const Table& table, const RunScan& scan) {
  const RunScan row = scan_of(table);
  return row.radar == scan.radar && row.scan == scan.scan && row.time_ns == scan.time_ns;
}

/// Index of a cell among the allowed words.
std::size_t word_of(const Table& table, std::string_view column, std::span<const std::string_view> words) {
  const auto found = std::find(words.begin(), words.end(), table.text(column));
  if (found == words.end()) table.refuse(column, fmt::format("{}", fmt::join(words, ", ")));
  return static_cast<std::size_t>(found - words.begin());
}

/// The bits of the words in a cell, joined by '+'. Other words are passed over.
std::uint32_t bits_of(const Table& table, std::string_view column, std::span<const std::string_view> words) {
  const std::string cell = fmt::format("+{}+", table.text(column));
  std::uint32_t bits = 0;
  for (std::size_t bit = 0; bit < words.size(); ++bit) {
    if (cell.find(fmt::format("+{}+", words[bit])) != std::string::npos) bits |= 1u << bit;
  }
  return bits;
}

/// Rows that are older belong to no scan that is still to come.
constexpr std::int64_t kOldestRow_ns = 2'000'000'000;

double value_or_nan(const Table& table, std::string_view column) {
  return table.number_or_nan(column, -kMostValue, kMostValue);
}

/// Columns of the probabilities, in the order of kOrigins.
constexpr std::array<std::string_view, kNumberOfOrigins> kProbabilityColumns = {
    "p_moving", "p_stationary", "p_ghost_type_1", "p_ghost_type_2", "p_clutter", "p_ambiguity"};

std::vector<std::string_view> columns_of_detections(RunDetections::Detail detail) {
  std::vector<std::string_view> columns = {"t_s", "time_ns", "radar", "scan", "index", "origin", "rejected"};
  if (detail == RunDetections::Detail::kAll) {
    columns.insert(columns.end(), {"x_vehicle_m", "y_vehicle_m", "range_rate_over_ground_mps"});
    columns.insert(columns.end(), kProbabilityColumns.begin(), kProbabilityColumns.end());
  }
  return columns;
}

void read_details(const Table& table, RunDetection& detection) {
  constexpr std::array<std::uint16_t, 4> kFlags = {0, corrected_flag::kInvalid, corrected_flag::kOutsideRegion,
                                                   corrected_flag::kWeak};
  detection.rejection = kFlags.at(word_of(table, "rejected", run::kRejectionWords));
  detection.x_vehicle_m = value_or_nan(table, "x_vehicle_m");
  detection.y_vehicle_m = value_or_nan(table, "y_vehicle_m");
  detection.range_rate_over_ground_mps = value_or_nan(table, "range_rate_over_ground_mps");
  for (std::size_t i = 0; i < kNumberOfOrigins; ++i) {
    detection.p_origin[i] = table.number_or_nan(kProbabilityColumns[i], 0.0, 1.0);
  }
}

RunTrack track_of(const Table& table) {
  const auto number = [&table](const char* column) { return table.number(column, -kMostValue, kMostValue); };
  const auto covariance = [&table](const char* column) {
    return table.number_or_nan(column, -kMostValue * kMostValue, kMostValue * kMostValue);
  };
  RunTrack track;
  track.id = static_cast<std::uint32_t>(table.integer("id", 1, std::numeric_limits<std::uint32_t>::max()));
  track.confirmed = word_of(table, "status", run::kStatusWords) == 1;
  track.movement = static_cast<MovementState>(word_of(table, "movement", run::kMovementWords));
  track.position_m = {number("x_vehicle_m"), number("y_vehicle_m")};
  track.velocity_mps = {number("vx_over_ground_mps"), number("vy_over_ground_mps")};
  track.heading_rad = number("heading_rad");
  track.length_m = table.number("length_m", 0.0, kMostValue);
  track.width_m = table.number("width_m", 0.0, kMostValue);
  track.age_s = value_or_nan(table, "age_s");
  if (table.has("detections")) {
    track.detections = static_cast<std::uint32_t>(table.integer("detections", 0, kMaxDetections));
  }
  // Read before the matrix is begun: one that is left incomplete by an exception ends the process.
  const double xx = covariance("cov_x_x"), xy = covariance("cov_x_y"), yy = covariance("cov_y_y");
  track.position_covariance_m2 << xx, xy, xy, yy;
  return track;
}

}  // namespace

template <typename Read>
std::size_t RowsOfScans::take_rows(const RunScan& scan, const Read& read) {
  std::size_t rows = 0;
  for (; has_row_ && is_of(table_, scan); has_row_ = table_.next(), ++rows) read();
  return rows;
}

template <typename Read>
void RowsOfScans::take(const RunScan& scan, std::size_t stated, std::string_view what, const Read& read) {
  while (stated > 0 && has_row_ && !is_of(table_, scan)) has_row_ = table_.next();
  const std::size_t rows = take_rows(scan, read);
  if (rows == stated) return;
  throw InputError(fmt::format("{}: scan {} of radar {} has {} {}, scans.csv states {}", table_.name(), scan.scan,
                               scan.radar, rows, what, stated));
}

template <typename Read>
void RowsOfScans::take(const RunScan& scan, const Read& read) {
  const auto is_orphan = [&] {
    const RunScan row = scan_of(table_);
    return !is_of(table_, scan) && row.time_ns < scan.time_ns - kOldestRow_ns;
  };
  while (has_row_ && is_orphan()) has_row_ = table_.next();
  take_rows(scan, read);
}

RunScans::RunScans(const std::filesystem::path& folder)
    : table_(folder / "scans.csv", {"t_s", "time_ns", "radar", "scan", "detections", "tracks"}) {}

bool RunScans::next(RunScan& scan) {
  if (!table_.next()) return false;
  scan = scan_of(table_);
  scan.detections = static_cast<std::size_t>(table_.integer("detections", 0, kMaxDetections));
  scan.tracks = static_cast<std::size_t>(table_.integer("tracks", 0, kMaxTracks));
  scan.flags = bits_of(table_, "flags", run::kFlagWords);
  scan.sensor_x_m = value_or_nan(table_, "sensor_x_m");
  scan.sensor_y_m = value_or_nan(table_, "sensor_y_m");
  scan.ego_speed_mps = value_or_nan(table_, "ego_speed_mps");
  scan.ego_yaw_rate_radps = value_or_nan(table_, "ego_yaw_rate_radps");
  return true;
}

RunDetections::RunDetections(const std::filesystem::path& folder, Detail detail)
    : detail_(detail), rows_(folder / "detections.csv", columns_of_detections(detail)) {}

void RunDetections::take(const RunScan& scan, std::vector<RunDetection>& detections) {
  detections.clear();
  const Table& table = rows_.table();
  rows_.take(scan, scan.detections, "detections", [&] {
    const auto index = static_cast<std::size_t>(table.integer("index", 0, kMaxDetections - 1));
    if (index != detections.size()) table.refuse("index", "the next one of the scan");
    RunDetection detection;
    detection.origin = static_cast<Provenance>(word_of(table, "origin", run::kOriginWords));
    detection.rejected = !table.text("rejected").empty();
    detection.p_moving = table.number_or_nan("p_moving", 0.0, 1.0);
    if (detail_ == Detail::kAll) read_details(table, detection);
    detections.push_back(detection);
  });
}

RunReflectors::RunReflectors(const std::filesystem::path& folder)
    : rows_(folder / "reflectors.csv",
            {"t_s", "time_ns", "radar", "scan", "x1_vehicle_m", "y1_vehicle_m", "x2_vehicle_m", "y2_vehicle_m"}) {}

void RunReflectors::take(const RunScan& scan, std::vector<ReflectorSegment>& reflectors) {
  reflectors.clear();
  const auto value = [this](const char* column) {
    return static_cast<float>(rows_.table().number(column, -kMostValue, kMostValue));
  };
  rows_.take(scan, [&] {
    ReflectorSegment segment{};
    segment.start_vehicle_m = {value("x1_vehicle_m"), value("y1_vehicle_m")};
    segment.end_vehicle_m = {value("x2_vehicle_m"), value("y2_vehicle_m")};
    reflectors.push_back(segment);
  });
}

RunTracks::RunTracks(const std::filesystem::path& folder)
    : rows_(folder / "tracks.csv",
            {"t_s", "time_ns", "radar", "scan", "id", "status", "movement", "x_vehicle_m", "y_vehicle_m",
             "vx_over_ground_mps", "vy_over_ground_mps", "heading_rad", "length_m", "width_m"}) {}

void RunTracks::take(const RunScan& scan, std::vector<judge::ScoredTrack>& tracks) {
  tracks.clear();
  rows_.take(scan, scan.tracks, "tracks", [&] { tracks.push_back(track_of(rows_.table())); });
}

void RunTracks::take(const RunScan& scan, std::vector<RunTrack>& tracks) {
  tracks.clear();
  rows_.take(scan, scan.tracks, "tracks", [&] { tracks.push_back(track_of(rows_.table())); });
}

RunAlignment::RunAlignment(const std::filesystem::path& folder)
    : table_(folder / "alignment.csv", {"t_s", "time_ns", "radar", "state", "speed_scale", "rotation_x_rad",
                                        "rotation_y_rad", "rotation_z_rad", "step_changes"}) {}

bool RunAlignment::next(judge::AlignmentSample& sample, std::int64_t& time_ns) {
  while (table_.next()) {
    if (table_.text("state") == "no_data") continue;
    sample.t_s = table_.number("t_s", -kLongestRun_s, kLongestRun_s);
    time_ns = table_.integer("time_ns", -kLatest_ns, kLatest_ns);
    sample.radar = static_cast<std::uint32_t>(table_.integer("radar", 1, kMaxRadars));
    sample.speed_scale = table_.number("speed_scale", 0.0, 10.0);
    const auto angle = [this](const char* column) { return table_.number(column, -4.0, 4.0); };
    sample.rotation = geometry::so3_exp({angle("rotation_x_rad"), angle("rotation_y_rad"), angle("rotation_z_rad")});
    constexpr std::array<const char*, 4> kVariances = {"cov_k_k", "cov_x_x", "cov_y_y", "cov_z_z"};
    for (std::size_t i = 0; i < kVariances.size(); ++i) {
      sample.variances(static_cast<Eigen::Index>(i)) = table_.number_or_nan(kVariances.at(i), 0.0, kMostValue);
    }
    sample.load_pitch_rad = table_.number_or_nan("load_pitch_rad", -4.0, 4.0);
    const double load_std_rad = table_.number_or_nan("load_pitch_std_rad", 0.0, kMostValue);
    sample.load_pitch_variance = load_std_rad * load_std_rad;
    sample.step_changes =
        static_cast<std::uint32_t>(table_.integer("step_changes", 0, std::numeric_limits<std::int32_t>::max()));
    return true;
  }
  return false;
}

AlignmentState RunAlignment::state() const {
  return static_cast<AlignmentState>(word_of(table_, "state", run::kStateWords));
}

std::uint32_t RunAlignment::observable() const {
  return bits_of(table_, "observable", run::kAxisWords);
}

Eigen::Matrix4d RunAlignment::covariance() const {
  constexpr std::array<std::string_view, 4> kNames = {"k", "x", "y", "z"};
  std::array<double, 16> cells{};
  for (std::size_t a = 0; a < kNames.size(); ++a) {
    for (std::size_t b = a; b < kNames.size(); ++b) {
      cells[4 * a + b] = cells[4 * b + a] =
          table_.number_or_nan(fmt::format("cov_{}_{}", kNames[a], kNames[b]), -kMostValue, kMostValue);
    }
  }
  return Eigen::Map<const Eigen::Matrix4d>(cells.data());
}

}  // namespace boresight::score
