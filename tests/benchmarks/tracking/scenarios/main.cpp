// boresight-bench-tracking_scenarios: the trackers on simulated scenarios of extended objects, each figure with its bar
// (required value). See README.md.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tests/benchmarks/common/bars_main.hpp"
#include "tests/benchmarks/tracking/scenarios/bars/bars.hpp"

namespace {

using namespace boresight::bench;

constexpr BarGroup kGroups[] = {{"recorded", scenarios::recorded},
                                {"resampled", scenarios::resampled},
                                {"hard_highway", scenarios::hard_highway},
                                {"split_merge", scenarios::split_merge},
                                {"made", scenarios::made},
                                {"growth", scenarios::growth}};

/// A million seeds are enough, and such a number is short to type.
std::uint64_t draw_seed() {
  return 1 + std::random_device{}() % 1'000'000;
}

bool write(const std::string& path, const Report& report, void (Report::*writer)(std::ostream&) const) {
  if (path.empty()) return true;
  std::ofstream out(path);
  (report.*writer)(out);
  out.flush();
  if (!out) std::fprintf(stderr, "cannot write %s\n", path.c_str());
  return static_cast<bool>(out);
}

int run(const Options& options, const std::string& json, const std::string& markdown) {
  std::printf("seeds from %llu on\n", static_cast<unsigned long long>(options.fresh_seed));
  Report report;
  for (const BarGroup& group : kGroups) {
    if (!options.wants(group.name)) continue;
    std::fprintf(stderr, "%s\n", group.name);
    group.run(options, report);
  }
  report.print(std::cout);
  return write(json, report, &Report::write_json) && write(markdown, report, &Report::write_markdown) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  options.fresh_seed = draw_seed();
  options.data_folder = BORESIGHT_SHARED_DATA;
  std::string json, markdown;
  std::vector<std::string> names;
  for (const BarGroup& group : kGroups) names.emplace_back(group.name);
  CLI::App app{"The trackers on simulated scenarios. Exit code 0 also if bars fail, 1 on an error."};
  app.add_flag("--quick", options.quick, "two seeds and short runs: a check that it runs, not a measurement");
  app.add_option("--most-seeds", options.most_seeds, "upper limit of the number of seeds, for a quick look");
  app.add_option("--only", options.only, "run one group of bars only")->check(CLI::IsMember(names));
  app.add_option("--seed", options.fresh_seed, "first seed; default: a fresh one");
  app.add_option("--data", options.data_folder, "folder of tracking_scenarios/ and ett_pmbm_benchmark/")
      ->capture_default_str();
  app.add_option("--json", json, "write bars, tables and curves to this file");
  app.add_option("--markdown", markdown, "write the tables to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options, json, markdown);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
