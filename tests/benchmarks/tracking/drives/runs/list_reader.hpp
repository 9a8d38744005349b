// The track lists of a run folder (config/schema/run.md), each track with its score.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "services/boresight/score/run_folder.hpp"
#include "services/boresight/score/table.hpp"
#include "tests/benchmarks/tracking/drives/judge/scene.hpp"

namespace boresight::bench::tracking {

/// Column of tracks.csv that holds the score.
inline constexpr const char* kExistenceColumn = "existence";
inline constexpr const char* kHitsColumn = "hits";

class ListReader {
 public:
  /// Throws score::InputError.
  ListReader(const std::filesystem::path& run, std::string score_column);

  /// Goes to the next list.
  [[nodiscard]] bool next();
  [[nodiscard]] const score::RunScan& scan() const { return scan_; }
  [[nodiscard]] const std::vector<ListedTrack>& tracks() const { return listed_; }

 private:
  std::string score_column_;
  score::RunScans scans_;
  score::RunTracks tracks_;
  score::Table scores_;  // tracks.csv again, for the column of the score
  score::RunScan scan_;
  std::vector<judge::ScoredTrack> list_;
  std::vector<ListedTrack> listed_;
};

}  // namespace boresight::bench::tracking
