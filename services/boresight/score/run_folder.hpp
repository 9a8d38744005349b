// Reads the tables of a run folder (config/schema/run.md), each from its beginning to its end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
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
};

/// detections.csv, in the order of scans.csv. Rows of a scan that is not in scans.csv are passed over, as in
/// tracks.csv: a live record that was cut off and continued may hold such.
class RunDetections {
 public:
  explicit RunDetections(const std::filesystem::path& folder);
  /// The detections of a scan. Throws InputError if they are not as many as the scan has.
  void take(const RunScan& scan, std::vector<RunDetection>& detections);

 private:
  Table table_;
  bool has_row_ = false;
};

/// tracks.csv, in the order of scans.csv.
class RunTracks {
 public:
  explicit RunTracks(const std::filesystem::path& folder);
  /// The track list after a scan. Throws InputError if it has not as many tracks as scans.csv states.
  void take(const RunScan& scan, std::vector<judge::ScoredTrack>& tracks);

 private:
  Table table_;
  bool has_row_ = false;
};

/// alignment.csv. Rows of a radar without estimate (state no_data) are passed over.
class RunAlignment {
 public:
  explicit RunAlignment(const std::filesystem::path& folder);
  [[nodiscard]] bool next(judge::AlignmentSample& sample, std::int64_t& time_ns);

 private:
  Table table_;
};

/// Whether each radar was reported MISALIGNED, a line of health.jsonl.
struct RunVerdicts {
  double t_s = 0.0;
  std::int64_t time_ns = 0;
  struct Radar {
    std::uint32_t radar;
    bool misaligned;
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
