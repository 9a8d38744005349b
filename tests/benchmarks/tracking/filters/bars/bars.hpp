// The groups of bars, each in a file of its name.
#pragma once

#include "tests/benchmarks/common/options.hpp"
#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench::filters {

void monte_carlo(const Options& options, Report& report);
void precision(const Options& options, Report& report);
void time_of_a_step(const Options& options, Report& report);

}  // namespace boresight::bench::filters
