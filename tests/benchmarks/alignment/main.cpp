// boresight-bench-alignment_bars: the accuracy, honesty and cost that the alignment estimator is held to, each figure
// with its bar. See README.md.
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <utility>

#include <CLI/CLI.hpp>

#include "tests/benchmarks/alignment/bars/bars.hpp"

using namespace boresight::bench;

namespace {

// clang-format off
constexpr std::pair<const char*, void (*)(const Options&, Report&)> kGroups[] = {
    {"clean", clean},
    {"disturbed", disturbed},
    {"roll", roll},
    {"honesty", honesty},
    {"degenerate", degenerate},
    {"cramer_rao", cramer_rao},
    {"time_to_95", time_to_95_percent},
    {"published", published},
    {"published_optimum", published_optimum},
    {"published_filter", published_filter},
    {"outliers", outliers},
    {"knock", knock},
    {"false_alarms", false_alarms},
    {"cost", cost},
    {"plate", plate},
    {"drive_1", drive_1},
};
// clang-format on

bool write(const std::string& path, const Report& report, void (Report::*writer)(std::ostream&) const) {
  if (path.empty()) return true;
  std::ofstream out(path);
  (report.*writer)(out);
  out.flush();
  if (!out) std::fprintf(stderr, "cannot write %s\n", path.c_str());
  return static_cast<bool>(out);
}

int run(int argc, char** argv) {
  Options options;
  std::string json, markdown;
  CLI::App app{"Each bar of the alignment estimator with its figure. Exit code 0 whatever passes, 1 on an error."};
  std::vector<std::string> names;
  for (const auto& [name, group] : kGroups) names.emplace_back(name);
  app.add_flag("--quick", options.quick, "two seeds and short drives: shows that it runs, not how good it is");
  app.add_option("--only", options.only, "one group of bars")->check(CLI::IsMember(names));
  app.add_option("--jobs", options.jobs, "threads")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--json", json, "file for bars, tables and curves");
  app.add_option("--markdown", markdown, "file for the tables, between the marks that docs/alignment.md has");
  app.add_option("--drive-data", options.drive_data, "folder of drive_1.csv.xz, ego_1.csv and truth_1.txt")
      ->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, argc, argv);

  Report report;
  for (const auto& [name, group] : kGroups) {
    if (!options.wants(name)) continue;
    std::fprintf(stderr, "%s\n", name);
    group(options, report);
  }
  report.print(std::cout);
  return write(json, report, &Report::write_json) && write(markdown, report, &Report::write_markdown) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
