// The groups of bars, each in a file of its name.
#pragma once

#include "tests/benchmarks/common/options.hpp"
#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench::scenarios {

void recorded(const Options& options, Report& report);
void resampled(const Options& options, Report& report);
void hard_highway(const Options& options, Report& report);
void split_merge(const Options& options, Report& report);
void made(const Options& options, Report& report);
void growth(const Options& options, Report& report);

/// Passes over the same scans, for the CPU time.
[[nodiscard]] inline std::size_t passes(const Options& options, std::size_t wanted) {
  return options.quick ? 2 : wanted;
}

}  // namespace boresight::bench::scenarios
