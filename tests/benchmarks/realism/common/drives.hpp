// Simulated drives and their statistics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/benchmarks/realism/common/measuring_vehicle.hpp"
#include "tests/benchmarks/realism/statistics/statistics.hpp"

namespace boresight::bench::realism {

struct Drives {
  std::vector<std::string> scenarios;
  std::uint64_t seed = 0;  ///< of each drive
  double longest_s = 1e9;  ///< limit of a drive
  std::size_t jobs = 2;    ///< threads
};

/// Statistics of these drives with one radar profile. They do not depend on `jobs`. Throws std::exception for an
/// unknown scenario or profile.
[[nodiscard]] Statistics simulate(const Drives& drives, const std::string& profile, const VehicleConfig& demo);

}  // namespace boresight::bench::realism
