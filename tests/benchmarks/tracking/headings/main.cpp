// boresight-bench-tracking_headings: headings of the classical chain, each source alone and fused. See ../README.md.
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/tracking/drives/report/findings.hpp"
#include "tests/benchmarks/tracking/headings/runs/heading_drive.hpp"

namespace {

using namespace boresight;
using namespace boresight::bench;
using namespace boresight::bench::tracking;

constexpr int kError = 1;
constexpr const char* kGroup = "headings";
constexpr double kMostRms_deg = 5.0, kMostNees = 2.0;

struct Arguments {
  std::vector<std::string> scenarios, profiles{"series_77ghz", "can_cluster"};
  std::size_t seeds = 5, jobs = 2;
  std::uint64_t first_seed = 0;
  double longest_s = 0.0;
  bool quick = false;
  std::string config{BORESIGHT_SOURCE_DIR "/config"}, json;
};

HeadingJudge judge_of(const Arguments& arguments, const std::string& profile, std::vector<std::string>& names) {
  std::vector<SimulatedDrive> drives;
  for (const std::string& scenario : arguments.scenarios) {
    for (std::size_t s = 0; s < arguments.seeds; ++s) {
      drives.push_back({scenario, profile, arguments.first_seed + s, arguments.longest_s, {}});
      names.push_back(fmt::format("{}/{}_{}", profile, scenario, drives.back().seed));
    }
  }
  std::vector<HeadingJudge> of_drives(drives.size());
  parallel_for(drives.size(), arguments.jobs,
               [&](std::size_t d) { of_drives[d] = judge_headings(drives[d], arguments.config); });
  HeadingJudge all;
  for (const HeadingJudge& each : of_drives) all.append(each);
  return all;
}

void add(const std::string& profile, const HeadingJudge& judge, Findings& findings) {
  for (std::size_t k = 0; k < kHeadingSources.size(); ++k) {
    const auto source = static_cast<HeadingSource>(k);
    const HeadingJudge::Figures f = judge.figures(source);
    const std::string of{kHeadingSources[k]};
    const double rms_deg = kDegreesPerRadian * f.rms_rad;
    const Interval rms_interval{kDegreesPerRadian * f.rms_interval.low, kDegreesPerRadian * f.rms_interval.high};
    const std::string shown = fmt::format("{} °, {} objects", with_interval(rms_deg, rms_interval), f.objects);
    // Only the heading that is published has a bar of its error; a figure whose interval reaches the bar is met.
    const bool is_fused = source == HeadingSource::kFused;
    findings.bars.push_back({kGroup, profile, "classical", of + ": rms error of the heading", rms_deg, shown,
                             is_fused ? fmt::format("≤ {} °", kMostRms_deg) : "—",
                             !is_fused || rms_interval.low <= kMostRms_deg});
    findings.bars.push_back({kGroup, profile, "classical", of + ": squared error over the stated variance", f.nees,
                             with_interval(f.nees, f.nees_interval), fmt::format("≤ {}", kMostNees),
                             f.nees_interval.low <= kMostNees});
  }
}

int judge_all(Arguments arguments) {
  if (arguments.first_seed == 0) arguments.first_seed = draw_seed();
  std::printf("seeds %llu to %llu\n", static_cast<unsigned long long>(arguments.first_seed),
              static_cast<unsigned long long>(arguments.first_seed + arguments.seeds - 1));
  std::fflush(stdout);
  Findings findings;
  std::vector<std::string> names;
  HeadingJudge pooled;
  for (const std::string& profile : arguments.profiles) {
    const HeadingJudge judge = judge_of(arguments, profile, names);
    add(profile, judge, findings);
    pooled.append(judge);
  }
  if (arguments.profiles.size() > 1) add("pooled", pooled, findings);
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
      "Headings of moving cars by the classical chain on simulated drives: each source alone and fused, beside the "
      "stated deviations. Exit code 0 also if bars are missed, 1 on an error."};
  Arguments arguments;
  try {
    arguments.scenarios = scenarios_with_moving_objects();
    app.add_option("--scenarios", arguments.scenarios, "names or files; default: all with moving objects");
    app.add_option("--profiles", arguments.profiles, "radar profiles, names or files")->capture_default_str();
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
