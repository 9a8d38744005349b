// A simulated drive through the whole chain in this process, judged by the classes of its tracks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/benchmarks/tracking/classes/judge/class_judge.hpp"

namespace boresight::bench::tracking {

struct ClassifiedDrive {
  std::string scenario, profile;  ///< names or files
  std::uint64_t seed = 1;
  double longest_s = 0.0;  ///< 0: as long as the scenario
  std::string tracker;     ///< empty: that of tracker.toml
};

/// Confirmed tracks are assigned to moving objects by judge::match(). `config`: folder with vehicle/ and services/.
/// Throws what the readers of the configuration throw.
[[nodiscard]] ClassJudge judge_drive(const ClassifiedDrive& drive, const std::filesystem::path& config);

}  // namespace boresight::bench::tracking
