// CPU time of a step: all forms of the same kernels, in turns, in one run.
#include <algorithm>
#include <limits>
#include <string>

#include "services/common/runtime/clock.hpp"
#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/tracking/filters/bars/bars.hpp"
#include "tests/benchmarks/tracking/filters/common/scene.hpp"

namespace boresight::bench::filters {

namespace {

template <typename Real>
struct Workload {
  Model<Real> model;
  std::vector<Gaussian<Real, 6>> starts;
  std::vector<std::vector<Vector<Real, 3>>> measured;
};

template <typename Real>
Workload<Real> workload_of(const std::vector<Run>& runs) {
  Workload<Real> workload{model<Real>(), {}, {}};
  for (const Run& run : runs) {
    workload.starts.push_back(start_of<Real>(run));
    std::vector<Vector<Real, 3>>& measured = workload.measured.emplace_back();
    for (std::size_t k = 1; k < run.measured.size(); ++k) measured.push_back(run.measured[k].template cast<Real>());
  }
  return workload;
}

/// Mean time of a step over the workload, in µs. `sink` uses the result, so that the compiler keeps the work.
template <typename Filter, typename Real>
double step_us(const Workload<Real>& workload, double& sink) {
  constexpr double kNanosecondsPerMicrosecond = 1e3;
  std::size_t steps = 0;
  bool succeeds = true;
  const std::int64_t begin_ns = runtime::thread_cpu_time_ns();
  for (std::size_t i = 0; i < workload.starts.size(); ++i) {
    Filter filter(workload.starts[i]);
    for (const Vector<Real, 3>& measured : workload.measured[i]) {
      succeeds = filter.predict(workload.model.motion) &&
                 filter.update(workload.model.sensor, measured, workload.model.noise) && succeeds;
      ++steps;
    }
    sink += static_cast<double>(filter.gaussian().mean(0)) + (succeeds ? 0.0 : 1.0);
  }
  return static_cast<double>(runtime::thread_cpu_time_ns() - begin_ns) / kNanosecondsPerMicrosecond /
         static_cast<double>(steps);
}

/// Time of each form in each round.
template <typename Real>
std::array<std::vector<double>, kForms> measure(const std::vector<Run>& runs, std::size_t rounds, double& sink) {
  const Workload<Real> workload = workload_of<Real>(runs);
  std::array<std::vector<double>, kForms> times;
  for (std::size_t round = 0; round < rounds; ++round) {
    for_each_form<Real>([&]<typename Filter>(std::size_t form, const Filter&) {
      times[form].push_back(step_us<Filter, Real>(workload, sink));
    });
  }
  return times;
}

std::vector<double> ratios(const std::vector<double>& times, const std::vector<double>& full) {
  std::vector<double> result;
  for (std::size_t i = 0; i < times.size(); ++i) result.push_back(times[i] / full[i]);
  return result;
}

void add_rows(const std::array<std::vector<double>, kForms>& times, const char* number_type, Table& table) {
  for (std::size_t form = 0; form < kForms; ++form) {
    const std::vector<double> of_full = ratios(times[form], times[kFull]);
    table.rows.push_back({kFormNames[form], number_type,
                          fixed(*std::min_element(times[form].begin(), times[form].end()), 3),
                          fixed(median(times[form]), 3), with_interval(median(of_full), median_interval(of_full))});
  }
}

}  // namespace

void time_of_a_step(const Options& options, Report& report) {
  constexpr double kCovarianceBar = 0.45, kPureRootBar = 0.62, kFastest_us = 0.7;
  constexpr std::size_t kRuns = 40, kRounds = 60;
  const std::size_t rounds = options.quick ? 2 : kRounds;
  std::vector<Run> runs;
  for (std::size_t i = 0; i < kRuns; ++i) runs.push_back(draw_run(scenes()[i % 2], options.fresh_seed + i));
  double sink = 0.0;
  const auto in_double = measure<double>(runs, rounds, sink);
  const auto in_float = measure<float>(runs, rounds, sink);
  if (!std::isfinite(sink)) throw std::runtime_error("a filter diverged");

  Table table{"filters_time",
              "CPU time of a step (prediction and update), " + std::to_string(rounds) +
                  " rounds in which the filters take turns; ratio: median over the rounds (95 % interval)",
              {"filter", "number", "least µs", "median µs", "ratio to the full form"},
              {}};
  add_rows(in_double, "double", table);
  add_rows(in_float, "float", table);
  const auto judge_ratio = [&](std::size_t form, double bar) {
    const std::vector<double> of_full = ratios(in_double[form], in_double[kFull]);
    const Interval interval = median_interval(of_full);
    report.at_most("time", std::string(kFormNames[form]) + ": time over that of the full form", median(of_full), bar,
                   "",
                   "median of " + std::to_string(rounds) + " rounds in turns, 95 % interval " + number(interval.low) +
                       "–" + number(interval.high));
  };
  judge_ratio(kCovariance, kCovarianceBar);
  judge_ratio(kPureRoot, kPureRootBar);
  const std::vector<double>& fastest = in_double[kCovariance];
  report.at_most("time", std::string(kFormNames[kCovariance]) + ": CPU time of a step",
                 *std::min_element(fastest.begin(), fastest.end()), kFastest_us, "µs",
                 "least of " + std::to_string(rounds) + " rounds; median " + number(median(fastest)) + " µs");
  const std::vector<double> published = ratios(in_double[kPublished], in_double[kFull]);
  report.beside("time", std::string(kFormNames[kPublished]) + ": time over that of the full form", median(published),
                "", "published: 0.78");
  report.add(std::move(table));
}

}  // namespace boresight::bench::filters
