// Reads the tables of a run folder (config/schema/run.md), each from its beginning to its end.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/health_report.hpp"
#include "services/boresight/score/table.hpp"
#include "services/simulator/judge/alignment_judge.hpp"
#include "services/simulator/judge/scored_scene.hpp"

namespace boresight::score {

/// Times on the run's clock are at most so far from 1970, as in tables of a drive, so that their differences fit into
/// 64 bits.
inline constexpr std::int64_t kLatest_ns = 4'000'000'000'000'000'000;

/// A row of scans.csv.
struct RunScan {
  double t_s = 0.0;
  std::int64_t time_ns = 0;
  std::uint32_t radar = 0;
  std::uint64_t scan = 0;
  std::size_t detections = 0, tracks = 0;
  std::uint32_t flags = 0;  ///< pipeline_flag bits; 0 without the column
  // NaN where the table has no value:
  double sensor_x_m = kNaN, sensor_y_m = kNaN, ego_speed_mps = kNaN, ego_yaw_rate_radps = kNaN;
};

/// A table whose rows belong to scans, in the order of scans.csv. Rows of a scan that is not in scans.csv are passed
/// over: a live record that was cut off and continued may hold such.
class RowsOfScans {
 public:
  RowsOfScans(const std::filesystem::path& file, const std::vector<std::string_view>& columns)
      : table_(file, columns), has_row_(table_.next()) {}
  [[nodiscard]] const Table& table() const { return table_; }
  /// Calls `read()` at each row of the scan. Throws InputError if they are not as many as `stated`.
  template <typename Read>
  void take(const RunScan& scan, std::size_t stated, std::string_view what, const Read& read);
  /// The same where scans.csv states no number.
  template <typename Read>
  void take(const RunScan& scan, const Read& read);

 private:
  template <typename Read>
  std::size_t take_rows(const RunScan& scan, const Read& read);

  Table table_;
  bool has_row_;
};

class RunScans {
 public:
  explicit RunScans(const std::filesystem::path& folder);
  [[nodiscard]] bool next(RunScan& scan);

 private:
  Table table_;
};

struct RunDetection {
  Provenance origin = Provenance::kUnknown;
  bool rejected = false;
  double p_moving = kNaN;  ///< NaN: not given
  // With Detail::kAll only; NaN where the table has no value:
  std::uint16_t rejection = 0;  ///< corrected_flag bit of the reason
  std::array<double, kNumberOfOrigins> p_origin = {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};  ///< by index_of_origin()
  double x_vehicle_m = kNaN, y_vehicle_m = kNaN, range_rate_over_ground_mps = kNaN;
};

/// detections.csv.
class RunDetections {
 public:
  /// What is read, and which columns must be there.
  enum class Detail : std::uint8_t { kOrigin, kAll };
  explicit RunDetections(const std::filesystem::path& folder, Detail detail = Detail::kOrigin);
  /// The detections of a scan. Throws InputError if they are not as many as the scan has.
  void take(const RunScan& scan, std::vector<RunDetection>& detections);

 private:
  Detail detail_;
  RowsOfScans rows_;
};

/// reflectors.csv.
class RunReflectors {
 public:
  explicit RunReflectors(const std::filesystem::path& folder);
  /// The ends of the reflectors that were used for a scan.
  void take(const RunScan& scan, std::vector<ReflectorSegment>& reflectors);

 private:
  RowsOfScans rows_;
};

struct RunTrack : judge::ScoredTrack {
  double age_s = kNaN;           ///< NaN without the column
  std::uint32_t detections = 0;  ///< of the scan; 0 without the column
};

/// tracks.csv.
class RunTracks {
 public:
  explicit RunTracks(const std::filesystem::path& folder);
  /// The track list after a scan. Throws InputError if it has not as many tracks as scans.csv states.
  void take(const RunScan& scan, std::vector<judge::ScoredTrack>& tracks);
  void take(const RunScan& scan, std::vector<RunTrack>& tracks);

 private:
  RowsOfScans rows_;
};

/// alignment.csv. Rows of a radar without estimate (state no_data) are passed over.
class RunAlignment {
 public:
  explicit RunAlignment(const std::filesystem::path& folder);
  [[nodiscard]] bool next(judge::AlignmentSample& sample, std::int64_t& time_ns);
  // Of the present row:
  [[nodiscard]] AlignmentState state() const;
  /// alignment_axis bits; 0 without the column.
  [[nodiscard]] std::uint32_t observable() const;
  /// Over (speed scale, rotation about x, y, z); NaN where the table has no value.
  [[nodiscard]] Eigen::Matrix4d covariance() const;

 private:
  Table table_;
};

/// The verdict on each radar, a line of health.jsonl. Without the key, the data qualifier is NOT_AVAILABLE.
struct RunVerdicts {
  double t_s = 0.0;
  std::int64_t time_ns = 0;
  struct Radar {
    std::uint32_t radar;
    bool misaligned;
    DataQualifier data_qualifier;
    ExtendedQualifier extended_qualifier;
    std::uint64_t missed_scans;              ///< 0 without the key
    std::string explanation;                 ///< "" without the key
    std::array<bool, 3> beyond_tolerance{};  ///< yaw, pitch, roll; false without the key
  };
  std::vector<Radar> radars;
};

class RunHealth {
 public:
  explicit RunHealth(const std::filesystem::path& folder);
  [[nodiscard]] bool next(RunVerdicts& verdicts);

 private:
  recording::ByteSource source_;
  recording::LineReader lines_;
  std::uint64_t line_number_ = 0;
};

/// What run.json states.
struct RunSummary {
  std::string vehicle;  ///< name or file; "" if not stated
  double recording_s = kNaN;
  std::vector<std::pair<std::uint32_t, std::string>> radars;  ///< ids and names
  std::vector<std::pair<std::string, double>> timing;         ///< "wall_s", "stages.tracker.cpu_s", …
  std::optional<std::int64_t> truth_begin_ns;                 ///< time 0 of the truth on the run's clock
};
[[nodiscard]] RunSummary read_run_summary(const std::filesystem::path& folder);

}  // namespace boresight::score
