// boresight-bench-tracking_classes: class probabilities of a tracker's tracks on simulated drives. See ../README.md.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/tracking/classes/judge/class_judge.hpp"
#include "tests/benchmarks/tracking/classes/runs/classified_drive.hpp"
#include "tests/benchmarks/tracking/drives/report/findings.hpp"

namespace {

using namespace boresight;
using namespace boresight::bench;
using namespace boresight::bench::tracking;

constexpr int kError = 1;
constexpr const char* kGroup = "classes";
constexpr double kLeastAccuracy = 0.75, kMostError = 0.1;

struct Arguments {
  std::vector<std::string> scenarios, profiles{"series_77ghz", "can_cluster"}, trackers{""};
  std::size_t seeds = 5, jobs = 2;
  std::uint64_t first_seed = 0;
  double longest_s = 0.0;
  bool quick = false;
  std::string config{BORESIGHT_SOURCE_DIR "/config"}, json;
};

ClassJudge judge_of(const Arguments& arguments, const std::string& tracker, const std::string& profile,
                    std::vector<std::string>& names) {
  std::vector<SimulatedDrive> drives;
  for (const std::string& scenario : arguments.scenarios) {
    for (std::size_t s = 0; s < arguments.seeds; ++s) {
      drives.push_back({scenario, profile, arguments.first_seed + s, arguments.longest_s, tracker});
      names.push_back(fmt::format("{}/{}_{}", profile, scenario, drives.back().seed));
    }
  }
  std::vector<ClassJudge> of_drives(drives.size());
  parallel_for(drives.size(), arguments.jobs,
               [&](std::size_t d) { of_drives[d] = judge_drive(drives[d], arguments.config); });
  ClassJudge all;
  for (const ClassJudge& each : of_drives) all.append(each);
  return all;
}

Table confusion_table(const std::string& tracker, const std::string& profile, const ClassFigures& figures) {
  Table table{"confusion",
              fmt::format("{}, {}: lists of each track in which a class is the likeliest, %, mean over "
                          "tracks older than {} s",
                          tracker, profile, ClassJudge::kLeastAge_s),
              {"true \\ reported"},
              {}};
  for (const std::string_view name : kClassNames) table.header.emplace_back(name);
  table.header.emplace_back("tracks");
  for (std::size_t a = 0; a < kClassNames.size(); ++a) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.emplace_back(kClassNames[a]);
    for (const double share : figures.confusion[a]) row.push_back(fixed(100.0 * share, 0));
    row.push_back(std::to_string(figures.cases[a]));
  }
  return table;
}

void add(const std::string& tracker, const std::string& profile, const ClassJudge& judge, Findings& findings) {
  const ClassFigures f = class_figures(judge);
  findings.tables.push_back({kGroup, confusion_table(tracker, profile, f)});
  findings.bars.push_back({kGroup, profile, tracker, "balanced accuracy", f.balanced_accuracy,
                           with_interval(f.balanced_accuracy, f.accuracy_interval), fmt::format("≥ {}", kLeastAccuracy),
                           f.balanced_accuracy >= kLeastAccuracy});
  findings.bars.push_back(
      {kGroup, profile, tracker, "largest calibration error", f.calibration.largest,
       fmt::format("{}, mean {}", with_interval(f.calibration.largest, f.largest_interval), number(f.calibration.mean)),
       fmt::format("≤ {}", kMostError), f.calibration.largest <= kMostError});
}

int judge_all(Arguments arguments) {
  if (arguments.first_seed == 0) arguments.first_seed = draw_seed();
  std::printf("seeds %llu to %llu\n", static_cast<unsigned long long>(arguments.first_seed),
              static_cast<unsigned long long>(arguments.first_seed + arguments.seeds - 1));
  std::fflush(stdout);
  Findings findings;
  std::vector<std::string> names;
  for (const std::string& tracker : arguments.trackers) {
    const std::string shown = tracker.empty() ? "default" : tracker;
    ClassJudge pooled;
    for (const std::string& profile : arguments.profiles) {
      const ClassJudge judge = judge_of(arguments, tracker, profile, names);
      add(shown, profile, judge, findings);
      pooled.append(judge);
    }
    if (arguments.profiles.size() > 1) add(shown, "pooled", pooled, findings);
  }
  print(findings, "", std::cout);
  if (arguments.json.empty()) return 0;
  std::ofstream out(arguments.json);
  write_json(findings, "", names, out);
  out.flush();
  if (!out) throw std::runtime_error(arguments.json + ": cannot be written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Class probabilities of a tracker's tracks on simulated drives: confusion, balanced accuracy, calibration. Exit "
      "code 0 also if bars are missed, 1 on an error."};
  Arguments arguments;
  try {
    arguments.scenarios = scenarios_with_moving_objects();
    app.add_option("--scenarios", arguments.scenarios, "names or files; default: all with moving objects");
    app.add_option("--profiles", arguments.profiles, "radar profiles, names or files")->capture_default_str();
    app.add_option("--trackers", arguments.trackers, "names of trackers; default: that of tracker.toml");
    app.add_option("--seeds", arguments.seeds, "drives of each scenario and profile")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--seed", arguments.first_seed, "first seed; default: drawn, and printed")
        ->check(CLI::PositiveNumber);
    app.add_option("--duration", arguments.longest_s, "longest duration of a drive, s; default: that of the scenario")
        ->check(CLI::PositiveNumber);
    app.add_option("--config", arguments.config, "folder with vehicle/ and services/")->capture_default_str();
    app.add_option("--jobs", arguments.jobs, "threads")->check(CLI::Range(1, 64))->capture_default_str();
    app.add_option("--json", arguments.json, "write bars and tables to this file");
    app.add_flag("--quick", arguments.quick, "one short drive: a check that it runs, no measurement");
    CLI11_PARSE(app, argc, argv);
    if (arguments.quick) {
      arguments.scenarios = {"junction"};
      arguments.profiles = {"series_77ghz"};
      arguments.seeds = 1;
      arguments.longest_s = 6.0;
    }
    return judge_all(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kError;
  }
}
