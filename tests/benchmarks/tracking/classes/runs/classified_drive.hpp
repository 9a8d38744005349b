// A simulated drive through the whole chain in this process, judged by the classes of its tracks.
#pragma once

#include <filesystem>

#include "tests/benchmarks/tracking/classes/judge/class_judge.hpp"
#include "tests/benchmarks/tracking/simulated/simulated_chain.hpp"

namespace boresight::bench::tracking {

/// Confirmed tracks are assigned to moving objects by judge::match(). `config`: folder with vehicle/ and services/.
/// Throws what the readers of the configuration throw.
[[nodiscard]] ClassJudge judge_drive(const SimulatedDrive& drive, const std::filesystem::path& config);

}  // namespace boresight::bench::tracking
