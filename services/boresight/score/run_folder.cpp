#include "services/boresight/score/run_folder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "interfaces/messages/header.hpp"
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
std::size_t word_of(const Table& table, std::string_view column, std::initializer_list<std::string_view> words) {
  const auto* const found = std::find(words.begin(), words.end(), table.text(column));
  if (found == words.end()) table.refuse(column, fmt::format("{}", fmt::join(words, ", ")));
  return static_cast<std::size_t>(found - words.begin());
}

/// Goes to the first row of a scan that has rows.
void find_first_row(Table& table, bool& has_row, const RunScan& scan, std::size_t stated) {
  while (stated > 0 && has_row && !is_of(table, scan)) has_row = table.next();
}

void expect_count(const Table& table, const char* what, const RunScan& scan, std::size_t rows, std::size_t stated) {
  if (rows == stated) return;
  throw InputError(fmt::format("{}: scan {} of radar {} has {} {}, scans.csv states {}", table.name(), scan.scan,
                               scan.radar, rows, what, stated));
}

}  // namespace

RunScans::RunScans(const std::filesystem::path& folder)
    : table_(folder / "scans.csv", {"t_s", "time_ns", "radar", "scan", "detections", "tracks"}) {}

bool RunScans::next(RunScan& scan) {
  if (!table_.next()) return false;
  scan = scan_of(table_);
  scan.detections = static_cast<std::size_t>(table_.integer("detections", 0, kMaxDetections));
  scan.tracks = static_cast<std::size_t>(table_.integer("tracks", 0, kMaxTracks));
  return true;
}

RunDetections::RunDetections(const std::filesystem::path& folder)
    : table_(folder / "detections.csv", {"t_s", "time_ns", "radar", "scan", "index", "origin", "rejected"}),
      has_row_(table_.next()) {}

void RunDetections::take(const RunScan& scan, std::vector<RunDetection>& detections) {
  detections.clear();
  find_first_row(table_, has_row_, scan, scan.detections);
  for (; has_row_ && is_of(table_, scan); has_row_ = table_.next()) {
    const auto index = static_cast<std::size_t>(table_.integer("index", 0, kMaxDetections - 1));
    if (index != detections.size()) table_.refuse("index", "the next one of the scan");
    RunDetection detection;
    detection.origin = static_cast<Provenance>(
        word_of(table_, "origin", {"unknown", "moving", "stationary", "ghost_type_1", "ghost_type_2", "clutter"}));
    detection.rejected = !table_.text("rejected").empty();
    detection.p_moving = table_.number_or_nan("p_moving", 0.0, 1.0);
    detections.push_back(detection);
  }
  expect_count(table_, "detections", scan, detections.size(), scan.detections);
}

RunTracks::RunTracks(const std::filesystem::path& folder)
    : table_(folder / "tracks.csv",
             {"t_s", "time_ns", "radar", "scan", "id", "status", "movement", "x_vehicle_m", "y_vehicle_m",
              "vx_over_ground_mps", "vy_over_ground_mps", "heading_rad", "length_m", "width_m"}),
      has_row_(table_.next()) {}

void RunTracks::take(const RunScan& scan, std::vector<judge::ScoredTrack>& tracks) {
  tracks.clear();
  find_first_row(table_, has_row_, scan, scan.tracks);
  const auto number = [this](const char* column) { return table_.number(column, -kMostValue, kMostValue); };
  const auto covariance = [this](const char* column) {
    return table_.number_or_nan(column, -kMostValue * kMostValue, kMostValue * kMostValue);
  };
  for (; has_row_ && is_of(table_, scan); has_row_ = table_.next()) {
    judge::ScoredTrack track;
    track.id = static_cast<std::uint32_t>(table_.integer("id", 1, std::numeric_limits<std::uint32_t>::max()));
    track.confirmed = word_of(table_, "status", {"tentative", "confirmed"}) == 1;
    track.movement =
        static_cast<MovementState>(word_of(table_, "movement", {"unknown", "moving", "stationary", "stopped"}));
    track.position_m = {number("x_vehicle_m"), number("y_vehicle_m")};
    track.velocity_mps = {number("vx_over_ground_mps"), number("vy_over_ground_mps")};
    track.heading_rad = number("heading_rad");
    track.length_m = table_.number("length_m", 0.0, kMostValue);
    track.width_m = table_.number("width_m", 0.0, kMostValue);
    // Read before the matrix is begun: one that is left incomplete by an exception ends the process.
    const double xx = covariance("cov_x_x"), xy = covariance("cov_x_y"), yy = covariance("cov_y_y");
    track.position_covariance_m2 << xx, xy, xy, yy;
    tracks.push_back(track);
  }
  expect_count(table_, "tracks", scan, tracks.size(), scan.tracks);
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
    sample.step_changes =
        static_cast<std::uint32_t>(table_.integer("step_changes", 0, std::numeric_limits<std::int32_t>::max()));
    return true;
  }
  return false;
}

}  // namespace boresight::score
