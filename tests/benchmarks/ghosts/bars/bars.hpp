// The groups of bars, each in a file of its name.
#pragma once

#include "tests/benchmarks/common/options.hpp"
#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench {

void highway(const Options& options, Report& report);
void scenarios(const Options& options, Report& report);
void ablation(const Options& options, Report& report);
void plan(const Options& options, Report& report);
void cost(const Options& options, Report& report);

}  // namespace boresight::bench
