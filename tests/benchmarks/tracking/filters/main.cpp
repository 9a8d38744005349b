// boresight-bench-tracking_filters: the motion filters in the published test of square-root filters, each figure with
// its bar (required value). See README.md.
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tests/benchmarks/common/bars_main.hpp"
#include "tests/benchmarks/tracking/filters/bars/bars.hpp"

namespace {

using namespace boresight::bench;

constexpr BarGroup kGroups[] = {
    {"monte_carlo", filters::monte_carlo}, {"precision", filters::precision}, {"time", filters::time_of_a_step}};

/// A million seeds are enough, and such a number is short to type.
std::uint64_t draw_seed() {
  return 1 + std::random_device{}() % 1'000'000;
}

int run(const Options& options, const std::string& json) {
  std::printf("seeds from %llu on\n", static_cast<unsigned long long>(options.fresh_seed));
  Report report;
  for (const BarGroup& group : kGroups) {
    if (!options.wants(group.name)) continue;
    std::fprintf(stderr, "%s\n", group.name);
    group.run(options, report);
  }
  report.print(std::cout);
  if (json.empty()) return 0;
  std::ofstream out(json);
  report.write_json(out);
  out.flush();
  if (!out) std::fprintf(stderr, "cannot write %s\n", json.c_str());
  return out ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  options.fresh_seed = draw_seed();
  std::string json;
  std::vector<std::string> names;
  for (const BarGroup& group : kGroups) names.emplace_back(group.name);
  CLI::App app{"The motion filters in the published test. Exit code 0 also if bars fail, 1 on an error."};
  app.add_flag("--quick", options.quick, "two runs and two rounds: a check that it works, not a measurement");
  app.add_option("--most-seeds", options.most_seeds, "upper limit of the number of runs, for a quick look");
  app.add_option("--jobs", options.jobs, "threads; times are measured on one")->capture_default_str();
  app.add_option("--only", options.only, "run one group of bars only")->check(CLI::IsMember(names));
  app.add_option("--seed", options.fresh_seed, "first seed; default: a fresh one");
  app.add_option("--json", json, "write bars and tables to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options, json);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
