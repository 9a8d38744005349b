// A made scenario of any size, for the growth of the cost: cars all over an area, which all live from the first scan to
// the last, and clutter.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tests/benchmarks/tracking/scenarios/common/scenario.hpp"

namespace boresight::bench::scenarios {

/// `measurements`: expected number a scan, with the clutter. The area is the same for all sizes.
[[nodiscard]] Scenario make_scenario(std::size_t targets, std::size_t measurements, std::size_t scans,
                                     std::uint64_t seed);

}  // namespace boresight::bench::scenarios
