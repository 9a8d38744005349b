// boresight-bench-tracking_drives: the product's trackers beside the plain baseline on simulated drives. See README.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/tracking/drives/perfect/perfect_run.hpp"
#include "tests/benchmarks/tracking/drives/report/findings.hpp"
#include "tests/benchmarks/tracking/drives/runs/drive_folder.hpp"
#include "tests/benchmarks/tracking/drives/runs/place.hpp"
#include "tests/benchmarks/tracking/drives/runs/run_reader.hpp"
#include "tests/benchmarks/tracking/simulated/simulated_chain.hpp"

namespace {

using namespace boresight;
using namespace boresight::bench::tracking;
namespace fs = std::filesystem;

constexpr int kError = 1;

struct Arguments {
  std::vector<std::string> scenarios, profiles{"series_77ghz", "can_cluster"}, trackers{kDefaultTracker};
  std::size_t seeds = 5, jobs = 2;
  std::uint64_t first_seed = 0;
  double longest_s = 0.0;
  bool quick = false, keeps_all = false, runs_again = false;
  std::string keep, programs, config{BORESIGHT_SOURCE_DIR "/config"}, only, json;
};

/// Drives that are there come first, unless the first seed is given.
std::vector<DriveSpec> drives_of(const Arguments& arguments, const DriveSetup& setup, const std::string& profile,
                                 std::uint64_t fresh_seed) {
  std::vector<DriveSpec> drives;
  for (const std::string& scenario : arguments.scenarios) {
    DriveSpec drive{profile, scenario, arguments.first_seed, arguments.longest_s};
    std::vector<std::uint64_t> seeds;
    if (arguments.first_seed == 0) seeds = seeds_there(setup, drive);
    const std::uint64_t first = arguments.first_seed != 0 ? arguments.first_seed : fresh_seed;
    for (std::uint64_t seed = first; seeds.size() < arguments.seeds; ++seed) {
      if (std::find(seeds.begin(), seeds.end(), seed) == seeds.end()) seeds.push_back(seed);
    }
    for (std::size_t i = 0; i < arguments.seeds; ++i) {
      drive.seed = seeds[i];
      drives.push_back(drive);
    }
  }
  return drives;
}

ScoredDrive read_drive(const NamedRun& run, const fs::path& truth) {
  ScoredDrive drive;
  RunReader reader(run.folder, truth, run.score_column);
  for (Scene scene; reader.next(scene);) drive.add(scene);
  return drive;
}

/// The run with true origins has measured the default tracker beside its own.
void add_step_times(const std::vector<NamedRun>& runs, std::size_t drive, std::vector<Contestant>& contestants) {
  const auto perfect =
      std::find_if(runs.begin(), runs.end(), [](const NamedRun& run) { return run.name == kPerfectTracker; });
  if (perfect == runs.end()) return;
  const StepTimes times = read_step_times(perfect->folder);
  for (std::size_t c = 0; c < runs.size(); ++c) {
    if (runs[c].name == kDefaultTracker) contestants[c].steps_ms[drive] = times.filtered_ms;
    if (runs[c].name == kPerfectTracker) contestants[c].steps_ms[drive] = times.perfect_ms;
  }
}

/// The drives of a profile, simulated, run and read. Their folders are deleted at once unless they are kept.
std::vector<Contestant> contestants_of(const DriveSetup& setup, const std::vector<DriveSpec>& drives, std::size_t jobs,
                                       bool is_kept) {
  const std::size_t count = setup.trackers.size() + setup.baselines.size();
  std::vector<Contestant> contestants(count);
  for (std::size_t c = 0; c < count; ++c) {
    contestants[c].is_baseline = c >= setup.trackers.size();
    if (c < setup.trackers.size() && setup.trackers[c] == kPerfectTracker) contestants[c].origins = Origins::kTrue;
    if (c < setup.trackers.size() && setup.trackers[c] == kUnfilteredTracker) contestants[c].origins = Origins::kNone;
    contestants[c].steps_ms.resize(drives.size());
    contestants[c].drives.resize(drives.size());
    contestants[c].ms_per_scan.resize(drives.size(), NAN);
  }
  bench::parallel_for(drives.size(), jobs, [&](std::size_t d) {
    const fs::path folder = folder_of(setup, drives[d]);
    std::fprintf(stderr, "%s\n", folder.lexically_relative(setup.place).c_str());
    const std::vector<NamedRun> runs = make_runs(setup, drives[d]);
    for (std::size_t c = 0; c < count; ++c) {
      if (d == 0) contestants[c].name = runs[c].name;
      contestants[c].drives[d] = read_drive(runs[c], folder / "drive");
      contestants[c].ms_per_scan[d] = tracker_ms_per_scan(runs[c].folder, contestants[c].drives[d].lists().size());
    }
    add_step_times(runs, d, contestants);
    if (is_kept) {
      trim(setup, drives[d]);
    } else {
      fs::remove_all(folder);
    }
  });
  return contestants;
}

int judge_all(const Arguments& arguments) {
  const Place place("boresight_tracking_drives", arguments.keep);
  DriveSetup setup;
  setup.programs = arguments.programs;
  setup.place = place.path();
  setup.config = arguments.config;
  setup.baseline_vehicle =
      config::read_vehicle_file(setup.config / "vehicle" / (setup.vehicle + ".toml"), config::VehicleUse::kOffline);
  setup.trackers = arguments.trackers;
  setup.unfiltered = setup.place / "config_unfiltered";
  if (std::find(setup.trackers.begin(), setup.trackers.end(), kUnfilteredTracker) != setup.trackers.end()) {
    write_unfiltered_config(setup.config, setup.unfiltered);
  }
  setup.baselines = {1, 2};
  setup.keeps_all = arguments.keeps_all && !arguments.keep.empty();
  setup.runs_again = arguments.runs_again;
  const std::uint64_t fresh_seed = draw_seed();
  Findings findings;
  std::vector<std::string> names;
  Evaluation pooled;
  pooled.name = "pooled";
  for (const std::string& profile : arguments.profiles) {
    const std::vector<DriveSpec> drives = drives_of(arguments, setup, profile, fresh_seed);
    std::string line = name_of(profile) + ":";
    for (const DriveSpec& drive : drives) {
      names.push_back(folder_of(setup, drive).lexically_relative(setup.place).string());
      line += fmt::format(" {}_{}", name_of(drive.scenario), drive.seed);
    }
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
    const Evaluation evaluation =
        evaluate(name_of(profile), contestants_of(setup, drives, arguments.jobs, !arguments.keep.empty()));
    add_tables(evaluation, findings);
    add_bars(evaluation, findings);
    pooled.append(evaluation);
  }
  if (arguments.profiles.size() > 1) {
    add_tables(pooled, findings);
    add_bars(pooled, findings);
  }
  print(findings, arguments.only, std::cout);
  if (arguments.json.empty()) return 0;
  std::ofstream out(arguments.json);
  write_json(findings, arguments.only, names, out);
  out.flush();
  if (!out) throw std::runtime_error(arguments.json + ": cannot be written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "The product's trackers beside the plain baseline on simulated drives, at equal numbers of false tracks. Exit "
      "code 0 also if bars are missed, 1 on an error."};
  Arguments arguments;
  try {
    arguments.scenarios = scenarios_with_moving_objects();
    arguments.programs = fs::read_symlink("/proc/self/exe").parent_path().string();
    app.add_option("--scenarios", arguments.scenarios, "names or files; default: all with moving objects");
    app.add_option("--profiles", arguments.profiles, "radar profiles, names or files")->capture_default_str();
    app.add_option("--trackers", arguments.trackers,
                   "names for `boresight run --tracker`; \"default\" is the one without this option, \"perfect\" the "
                   "same with the true origin of each detection, \"unfiltered\" without the ghost filter's ratio")
        ->capture_default_str();
    app.add_option("--seeds", arguments.seeds, "drives of each scenario and profile")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--seed", arguments.first_seed, "first seed; default: drawn, and printed")
        ->check(CLI::PositiveNumber);
    app.add_option("--duration", arguments.longest_s, "longest duration of a drive, s; default: that of the scenario")
        ->check(CLI::PositiveNumber);
    app.add_option("--keep", arguments.keep,
                   "folder for the drives, which are kept; drives that are there are used instead of fresh ones");
    app.add_flag("--keep-all", arguments.keeps_all, "with --keep: also recordings and detections, 0.3 GB a drive");
    app.add_flag("--rerun", arguments.runs_again, "run the trackers again over the drives of --keep");
    app.add_option("--bin", arguments.programs, "folder of the program boresight")->capture_default_str();
    app.add_option("--config", arguments.config, "folder with vehicle/ and services/")->capture_default_str();
    app.add_option("--jobs", arguments.jobs, "threads")->check(CLI::Range(1, 64))->capture_default_str();
    app.add_option("--only", arguments.only, "report one group only")
        ->check(CLI::IsMember(std::vector<std::string>{kTracked, kFalse, kExistence, kEllipse, kCars, kTime}));
    app.add_option("--json", arguments.json, "write bars and tables to this file");
    app.add_flag("--quick", arguments.quick, "one short drive: a check that it runs, no measurement");
    CLI11_PARSE(app, argc, argv);
    if (arguments.quick) {
      arguments.scenarios = {"highway_multipath"};
      arguments.profiles = {"series_77ghz"};
      arguments.trackers = {kDefaultTracker, kPerfectTracker, kUnfilteredTracker};
      arguments.seeds = 1;
      arguments.longest_s = 4.0;
    }
    return judge_all(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kError;
  }
}
