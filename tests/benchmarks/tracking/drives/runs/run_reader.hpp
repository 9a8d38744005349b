// The track lists of a run folder (config/schema/run.md) beside the truth of its drive.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "services/boresight/score/car_truth.hpp"
#include "services/boresight/score/object_truth.hpp"
#include "services/boresight/score/run_folder.hpp"
#include "services/boresight/score/table.hpp"
#include "tests/benchmarks/tracking/drives/judge/scene.hpp"

namespace boresight::bench::tracking {

/// Column of tracks.csv that holds the score.
inline constexpr const char* kExistenceColumn = "existence";
inline constexpr const char* kHitsColumn = "hits";

class RunReader {
 public:
  /// Throws score::InputError.
  RunReader(const std::filesystem::path& run, const std::filesystem::path& truth, std::string score_column);

  /// The next list; lists at times without truth are passed over.
  [[nodiscard]] bool next(Scene& scene);

 private:
  void read_tracks(std::vector<ListedTrack>& tracks);

  std::string score_column_;
  score::CarTruth car_;
  score::RunScans scans_;
  score::RunTracks tracks_;
  score::Table scores_;  // tracks.csv again, for the column of the score
  score::ObjectTruth objects_;
  score::RunScan scan_;
  std::vector<judge::ScoredTrack> list_;
  std::int64_t origin_ns_ = 0;
  bool has_scan_ = false;
};

/// CPU time of the tracker a scan, ms; NaN if run.json does not state it.
[[nodiscard]] double tracker_ms_per_scan(const std::filesystem::path& run, std::size_t scans);

}  // namespace boresight::bench::tracking
