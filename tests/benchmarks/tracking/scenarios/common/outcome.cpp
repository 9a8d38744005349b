#include "tests/benchmarks/tracking/scenarios/common/outcome.hpp"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <stdexcept>

#include "services/boresight/track/tracker_run.hpp"
#include "services/tracker/core/make_tracker.hpp"
#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/tracking/scenarios/common/oracle.hpp"

namespace boresight::bench::scenarios {

namespace {

std::int64_t thread_cpu_time_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

MeanGospa mean_of(const std::vector<Outcome>& outcomes) {
  MeanGospa sum;
  for (const Outcome& outcome : outcomes) {
    sum.squared += outcome.gospa.squared;
    sum.root += outcome.gospa.root;
  }
  const auto n = static_cast<double>(outcomes.size());
  return {sum.squared / n, sum.root / n};
}

std::string both(const MeanGospa& gospa) {
  return fixed(gospa.squared, 3) + " / " + fixed(gospa.root, 3);
}

std::string ratio_text(const std::vector<double>& ratios) {
  if (ratios.empty()) return "—";
  const std::string middle = fixed(median(ratios), 3);
  if (ratios.size() == 1) return middle;
  const Interval interval = median_interval(ratios);
  return middle + " (" + fixed(interval.low, 3) + "–" + fixed(interval.high, 3) + ")";
}

}  // namespace

Outcome run_tracker(const std::string& name, const Scenario& scenario, const Measurements& measurements,
                    std::size_t passes) {
  const auto make = [&] { return tracking::make_scenario_tracker(name, scenario.model); };
  const track::TrackerRun run =
      track::run_tracker(make, measurements.scans, scenario.model.step_s, passes, thread_cpu_time_ns);
  if (!run.is_repeatable)
    throw std::runtime_error(name + ", " + scenario.name + ": two passes have different estimates");
  return {mean_gospa(scenario.truth, run.estimates), count_lost_targets(scenario.truth, run.estimates),
          run.mean_cpu_ms(), run.worst_cpu_ms(), run.budget_reached};
}

Outcome run_oracle(const Scenario& scenario, const Measurements& measurements) {
  const track::ObjectsByStep estimates = oracle_estimates(scenario, measurements);
  return {mean_gospa(scenario.truth, estimates), count_lost_targets(scenario.truth, estimates), 0.0, 0.0, 0};
}

MeanGospa Runs::mean() const {
  return mean_of(outcomes);
}

MeanGospa Runs::mean_of_oracle() const {
  return mean_of(oracle);
}

std::vector<double> Runs::ratios(double MeanGospa::*base) const {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < oracle.size(); ++i) {
    ratios.push_back(outcomes[i].gospa.*base / oracle[i].gospa.*base);
  }
  return ratios;
}

std::size_t Runs::lost() const {
  std::size_t sum = 0;
  for (const Outcome& outcome : outcomes) sum += outcome.targets.lost;
  return sum;
}

double Runs::mean_cpu_ms() const {
  double sum = 0.0;
  for (const Outcome& outcome : outcomes) sum += outcome.mean_cpu_ms;
  return sum / static_cast<double>(outcomes.size());
}

double Runs::worst_cpu_ms() const {
  double worst = 0.0;
  for (const Outcome& outcome : outcomes) worst = std::max(worst, outcome.worst_cpu_ms);
  return worst;
}

std::vector<std::string> outcome_header() {
  return {"scenario",   "tracker",   "runs",         "GOSPA squared / true", "oracle",           "ratio squared",
          "ratio true", "reference", "lost targets", "CPU mean / worst ms",  "scans over budget"};
}

std::vector<std::string> row_of(const Runs& runs, const MeanGospa* reference) {
  std::size_t over_budget = 0, targets = 0;
  for (const Outcome& outcome : runs.outcomes) {
    over_budget += outcome.scans_over_budget;
    targets += outcome.targets.targets;
  }
  return {runs.scenario,
          runs.tracker,
          std::to_string(runs.outcomes.size()),
          both(runs.mean()),
          runs.oracle.empty() ? "—" : both(runs.mean_of_oracle()),
          ratio_text(runs.ratios(&MeanGospa::squared)),
          ratio_text(runs.ratios(&MeanGospa::root)),
          reference == nullptr ? "—" : both(*reference),
          std::to_string(runs.lost()) + " of " + std::to_string(targets),
          number(runs.mean_cpu_ms()) + " / " + number(runs.worst_cpu_ms()),
          std::to_string(over_budget)};
}

void judge_ratio(const std::string& group, const Runs& runs, double bar, const std::string& how, Report& report) {
  for (const auto& [name, base] : {std::pair{"squared", &MeanGospa::squared}, std::pair{"true", &MeanGospa::root}}) {
    report.at_most(group, runs.scenario + ", " + runs.tracker + ": ratio to the oracle, " + name,
                   median(runs.ratios(base)), bar, "", how);
  }
}

void judge_cpu(const std::string& group, const Runs& runs, double mean_ms, double worst_ms, const std::string& how,
               Report& report) {
  report.at_most(group, runs.scenario + ", " + runs.tracker + ": CPU time of a scan, mean", runs.mean_cpu_ms(), mean_ms,
                 "ms", how);
  report.at_most(group, runs.scenario + ", " + runs.tracker + ": CPU time of a scan, worst", runs.worst_cpu_ms(),
                 worst_ms, "ms", how);
}

}  // namespace boresight::bench::scenarios
