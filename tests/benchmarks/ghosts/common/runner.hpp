// One method on one simulated drive, through corrector, ghost filter and tracker, judged by the truth.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "services/ghost_filter/core/config.hpp"
#include "tests/benchmarks/common/options.hpp"
#include "tests/benchmarks/ghosts/common/confusion.hpp"

namespace boresight::bench {

struct Outcome {
  Confusion confusion;
  std::uint64_t scans = 0;
  /// Confirmed tracks that were measured in more than five scans far from every object and where ghosts were.
  std::size_t long_ghost_tracks = 0;
  std::size_t longest_ghost_track_scans = 0;
  /// Seconds (whole ones) of objects in which most of their own moving detections were told to be ghosts or clutter,
  /// and no confirmed track was there for most of it.
  std::size_t object_seconds = 0, lost_object_seconds = 0;
};

/// `name`: of a scenario or its file; at most as long as that makes sense.
[[nodiscard]] Outcome run_ghost_drive(const std::string& name, const ghosts::Config& config, std::uint64_t seed,
                                      double duration_s);

/// Seeds 1 … `seeds`, spread over threads.
[[nodiscard]] std::vector<Outcome> run_ghost_drives(const std::string& scenario, const ghosts::Config& config,
                                                    std::size_t seeds, double duration_s, const Options& options);

/// Of a drive: --quick shows that it runs.
[[nodiscard]] inline double drive_seconds(const Options& options, double wanted) {
  return options.quick ? std::min(wanted, 2.0) : wanted;
}

/// Medians over drives.
[[nodiscard]] double median_percent(const std::vector<Outcome>& outcomes, Provenance truth, Provenance label);
[[nodiscard]] double median_percent_ghost(const std::vector<Outcome>& outcomes, Provenance truth);
[[nodiscard]] double median_count(const std::vector<Outcome>& outcomes, Provenance truth);

}  // namespace boresight::bench
