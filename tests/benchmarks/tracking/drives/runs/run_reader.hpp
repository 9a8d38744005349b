// The track lists of a run folder (config/schema/run.md) beside the truth of its drive.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "services/boresight/score/car_truth.hpp"
#include "services/boresight/score/object_truth.hpp"
#include "tests/benchmarks/tracking/drives/judge/scene.hpp"
#include "tests/benchmarks/tracking/drives/runs/list_reader.hpp"

namespace boresight::bench::tracking {

class RunReader {
 public:
  /// Throws score::InputError.
  RunReader(const std::filesystem::path& run, const std::filesystem::path& truth, std::string score_column);

  /// The next list; lists at times without truth are passed over.
  [[nodiscard]] bool next(Scene& scene);

 private:
  score::CarTruth car_;
  ListReader lists_;
  score::ObjectTruth objects_;
  std::int64_t origin_ns_ = 0;
  bool has_list_ = false;
};

/// CPU time of the tracker a scan, ms; NaN if run.json does not state it.
[[nodiscard]] double tracker_ms_per_scan(const std::filesystem::path& run, std::size_t scans);

}  // namespace boresight::bench::tracking
