#include "tests/benchmarks/tracking/drives/runs/list_reader.hpp"

#include <utility>

namespace boresight::bench::tracking {

namespace {

constexpr double kLargestScore = 1e9;

}  // namespace

ListReader::ListReader(const std::filesystem::path& run, std::string score_column)
    : score_column_(std::move(score_column)),
      scans_(run),
      tracks_(run),
      scores_(run / "tracks.csv", {"id", score_column_}) {}

bool ListReader::next() {
  if (!scans_.next(scan_)) return false;
  tracks_.take(scan_, list_);
  listed_.clear();
  for (const judge::ScoredTrack& track : list_) {
    do {
      if (!scores_.next()) throw score::InputError(scores_.name() + ": ends early");
    } while (scores_.integer("id", 0, UINT32_MAX) != track.id);
    listed_.push_back({track, scores_.number(score_column_, 0.0, kLargestScore)});
  }
  return true;
}

}  // namespace boresight::bench::tracking
