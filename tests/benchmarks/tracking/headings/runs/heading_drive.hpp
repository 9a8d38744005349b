// The headings of the classical chain on a simulated drive.
#pragma once

#include <filesystem>

#include "tests/benchmarks/tracking/headings/judge/heading_judge.hpp"
#include "tests/benchmarks/tracking/simulated/simulated_chain.hpp"

namespace boresight::bench::tracking {

/// Which cars and tracks are judged.
inline constexpr double kFarthest_m = 40.0;        ///< of the centre of a car from the vehicle's origin
inline constexpr double kSlowest_mps = 1.0;        ///< a slower car does not count as moving
inline constexpr double kLeastExistence = 0.5;     ///< of the track
inline constexpr double kFarthestFromBox_m = 3.0;  ///< of the track's centre from the car's box

/// The chain's own classes of the tracks do not matter: the model of radars and the filter are those of `classical`.
[[nodiscard]] HeadingJudge judge_headings(const SimulatedDrive& drive, const std::filesystem::path& config);

}  // namespace boresight::bench::tracking
