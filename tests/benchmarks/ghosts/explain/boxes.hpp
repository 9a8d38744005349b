// Boxes over time: the tracks after each scan, and the true objects.
#pragma once

#include <cstdint>
#include <iosfwd>

#include "tests/benchmarks/ghosts/common/runner.hpp"

namespace boresight::bench {

[[nodiscard]] const char* boxes_header();
/// A row for each object of the scan and for each track after it.
void write_boxes(std::uint64_t seed, const Observed& observed, std::ostream& out);

}  // namespace boresight::bench
