// The groups of bars (limits that figures must meet); each group has a source file of its name.
#pragma once

#include "tests/benchmarks/common/options.hpp"
#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench {

void clean(const Options& options, Report& report);
void disturbed(const Options& options, Report& report);
void roll(const Options& options, Report& report);
void consistency(const Options& options, Report& report);
void degenerate(const Options& options, Report& report);
void cramer_rao(const Options& options, Report& report);
void time_to_95_percent(const Options& options, Report& report);
void published(const Options& options, Report& report);
void published_optimum(const Options& options, Report& report);
void published_filter(const Options& options, Report& report);
void outliers(const Options& options, Report& report);
void step_change(const Options& options, Report& report);
void cost(const Options& options, Report& report);
void plate(const Options& options, Report& report);
void drive_1(const Options& options, Report& report);
void real_car(const Options& options, Report& report);
void real_car_published(const Options& options, Report& report);
void real_car_drift(const Options& options, Report& report);
void real_car_no_change(const Options& options, Report& report);
void real_car_changes(const Options& options, Report& report);
void real_car_load(const Options& options, Report& report);
void world(const Options& options, Report& report);

}  // namespace boresight::bench
