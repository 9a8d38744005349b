// boresight-bench-bad_input: what health reports and what the tracker shows while radars send bad data. See README.md.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/scenario/shipped.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/bad_input/verdicts/verdicts.hpp"
#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/common/statistics.hpp"
#include "tests/benchmarks/tracking/drives/judge/scored_drive.hpp"
#include "tests/benchmarks/tracking/drives/runs/drive_folder.hpp"
#include "tests/benchmarks/tracking/drives/runs/place.hpp"
#include "tests/benchmarks/tracking/drives/runs/run_reader.hpp"

namespace {

using namespace boresight;
using namespace boresight::bench;
using namespace boresight::bench::bad_input;
namespace fs = std::filesystem;

constexpr int kError = 1, kMissed = 2;
/// The damage: after half a minute of sound driving it has time to be found, and the radar time to recover.
constexpr Window kDamage{20.0, 35.0};
/// The bars of the verdict and of the tracks.
constexpr double kLatestVerdict_s = 5.0, kMostFalseTracks = 1.0;

struct Kind {
  const char* name;
  const char* table;  ///< of radars (config/schema/scenario.md); nullptr: sound data
  const char* keys;   ///< its keys beside the times
  std::set<std::string> right;
};

const std::vector<Kind>& kinds() {
  static const std::set<std::string> blind = {"BLOCKED", "BEGINNING_BLOCKAGE"};
  static const std::vector<Kind> all = {
      {"empty lists", "data_fault", "kind = \"few\"\ndetections = 0", blind},
      {"few detections", "data_fault", "kind = \"few\"\ndetections = 3", blind},
      {"near only", "data_fault", "kind = \"near\"\nreach_m = 8.0", blind},
      {"80 % lost", "data_fault", "kind = \"lost\"\nshare = 0.8", {"RATE_REDUCED", "NO_DATA"}},
      {"mirrored azimuth", "data_fault", "kind = \"mirrored_azimuth\"", {"WRONG_INPUT", "INVALID_DATA"}},
      {"frozen", "data_fault", "kind = \"frozen\"", {"INVALID_DATA"}},
      {"repeated", "data_fault", "kind = \"repeated\"", {"INVALID_DATA"}},
      {"random", "data_fault", "kind = \"random\"", {"INVALID_DATA", "WRONG_INPUT", "EXTERNAL_DISTURBANCE"}},
      {"interference", "interference", "detections_per_scan = 150.0", {"EXTERNAL_DISTURBANCE", "INVALID_DATA"}},
      {"sound", nullptr, nullptr, {}},
  };
  return all;
}

struct Arguments {
  std::vector<std::string> scenarios{"aligned_drive", "straight_rail", "tunnel", "truck_overtaking"};
  std::vector<std::string> profiles{"series_77ghz", "can_cluster", "ideal"};
  std::vector<std::string> only;
  std::size_t seeds = 1, jobs = 2;
  std::uint64_t first_seed = 0;
  std::string keep, programs, config{BORESIGHT_SOURCE_DIR "/config"}, json;
};

/// Of one drive.
struct Result {
  std::vector<Outcome> radars;
  double false_tracks = 0.0;         ///< at a time, from the latest time of the verdict to the end of the damage
  double false_tracks_before = 0.0;  ///< in the damage before that
};

fs::path write_scenario(const fs::path& place, const std::string& name, const Kind& kind, std::size_t index) {
  const auto shipped = simulator::shipped_scenarios();
  const auto found = std::find_if(shipped.begin(), shipped.end(), [&name](const auto& s) { return s.name == name; });
  if (found == shipped.end()) throw std::invalid_argument(name + ": no shipped scenario");
  const fs::path file = place / fmt::format("{}_{}.toml", name, index);
  std::ofstream out(file);
  out << found->text << "\n";
  if (kind.table != nullptr) {
    out << fmt::format("[[radars.{}]]\n{}\nbegin_s = {}\nduration_s = {}\n", kind.table, kind.keys, kDamage.begin_s,
                       kDamage.end_s - kDamage.begin_s);
  }
  out.flush();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
  return file;
}

/// Mean number of confirmed false tracks in the lists between two times.
double false_tracks_between(const bench::tracking::NamedRun& run, const fs::path& truth, double begin_s, double end_s) {
  bench::tracking::ScoredDrive drive;
  bench::tracking::RunReader reader(run.folder, truth, run.score_column);
  for (bench::tracking::Scene scene; reader.next(scene);) {
    if (scene.t_s >= begin_s && scene.t_s < end_s) drive.add(scene);
  }
  const auto confirmed = std::count_if(drive.false_tracks().begin(), drive.false_tracks().end(),
                                       [](const auto& track) { return track.confirmed; });
  // No list at all shows no false track.
  return drive.lists().empty() ? 0.0 : static_cast<double>(confirmed) / static_cast<double>(drive.lists().size());
}

Result judge(const bench::tracking::DriveSetup& setup, const bench::tracking::DriveSpec& drive, const Kind& kind) {
  const bench::tracking::NamedRun run = bench::tracking::make_runs(setup, drive).front();
  const fs::path folder = bench::tracking::folder_of(setup, drive);
  Result result;
  for (const auto& [radar, verdicts] : read_verdicts(run.folder / "health.jsonl")) {
    result.radars.push_back(outcome_of(verdicts, kDamage, kind.right));
  }
  const double settled_s = kDamage.begin_s + kLatestVerdict_s;
  result.false_tracks_before = false_tracks_between(run, folder / "drive", kDamage.begin_s, settled_s);
  result.false_tracks = false_tracks_between(run, folder / "drive", settled_s, kDamage.end_s);
  return result;
}

void add(const std::string& profile, const Kind& kind, const std::vector<Result>& results, Report& report) {
  std::vector<double> right_after_s, clear_after_s, false_tracks, false_before;
  double returns = 0.0, wrong_at_end = 0.0;
  std::map<std::string, int> at_end;
  for (const Result& result : results) {
    for (const Outcome& radar : result.radars) {
      right_after_s.push_back(radar.right_after_s);
      clear_after_s.push_back(radar.clear_after_s);
      returns += radar.returns;
      wrong_at_end += radar.is_right_at_end ? 0.0 : 1.0;
      ++at_end[radar.at_end];
    }
    false_tracks.push_back(result.false_tracks);
    false_before.push_back(result.false_tracks_before);
  }
  const std::string how = fmt::format("{} drives, {} radars", results.size(), right_after_s.size());
  const std::string group = profile + ", " + kind.name;
  if (kind.table != nullptr) {
    report.at_most(group, "right verdict after, largest", *std::max_element(right_after_s.begin(), right_after_s.end()),
                   kLatestVerdict_s, "s", how);
    report.beside(group, "right verdict after, median", median(right_after_s), "s", how);
    report.at_most(group, "radars with another verdict at the end of the damage", wrong_at_end, 0.0, "", how);
    report.at_most(group, "returns to \"no fault\" during the damage", returns, 0.0, "", how);
    report.beside(group, "no fault again after the end, median", median(clear_after_s), "s", how);
  }
  const Interval interval = median_interval(false_tracks);
  report.at_most(group, "confirmed false tracks at a time, mean of the drives", mean(false_tracks), kMostFalseTracks,
                 "", fmt::format("{}; median {}", how, with_interval(median(false_tracks), interval)));
  report.beside(group, fmt::format("the same in the first {:g} s", kLatestVerdict_s), mean(false_before), "", how);
  std::string verdicts;
  for (const auto& [words, count] : at_end)
    verdicts += fmt::format("{}{} × {}", verdicts.empty() ? "" : ", ", count, words);
  std::printf("%s: %s\n", group.c_str(), verdicts.c_str());
}

int run(const Arguments& arguments) {
  const bench::tracking::Place place("boresight_bad_input", arguments.keep);
  bench::tracking::DriveSetup setup;
  setup.programs = arguments.programs;
  setup.place = place.path();
  setup.config = arguments.config;
  setup.trackers = {bench::tracking::kDefaultTracker};
  setup.keeps_all = !arguments.keep.empty();
  const std::uint64_t first =
      arguments.first_seed != 0 ? arguments.first_seed : 1'000'000 + 1'000 * (std::random_device{}() % 1'000'000);
  std::printf("seeds from %llu on; damage of all radars from %g to %g s\n", static_cast<unsigned long long>(first),
              kDamage.begin_s, kDamage.end_s);
  Report report;
  for (const std::string& profile : arguments.profiles) {
    for (std::size_t k = 0; k < kinds().size(); ++k) {
      const Kind& kind = kinds()[k];
      if (!arguments.only.empty() && std::count(arguments.only.begin(), arguments.only.end(), kind.name) == 0) continue;
      std::vector<bench::tracking::DriveSpec> drives;
      for (const std::string& scenario : arguments.scenarios) {
        const std::string file = write_scenario(place.path(), scenario, kind, k).string();
        for (std::uint64_t s = 0; s < arguments.seeds; ++s) drives.push_back({profile, file, first + s, 0.0});
      }
      std::vector<Result> results(drives.size());
      parallel_for(drives.size(), arguments.jobs, [&](std::size_t d) {
        results[d] = judge(setup, drives[d], kind);
        if (arguments.keep.empty()) fs::remove_all(bench::tracking::folder_of(setup, drives[d]));
      });
      add(profile, kind, results, report);
      std::fflush(stdout);
    }
  }
  report.print(std::cout);
  if (!arguments.json.empty()) {
    std::ofstream out(arguments.json);
    report.write_json(out);
    out.flush();
    if (!out) throw std::runtime_error(arguments.json + ": cannot be written");
  }
  const bool all_pass = std::all_of(report.bars().begin(), report.bars().end(),
                                    [](const Bar& b) { return !b.is_judged() || b.passes(); });
  return all_pass ? 0 : kMissed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "What health reports and what the tracker shows while all radars send bad data. Exit code 0 if all bars are met, "
      "2 if one is missed, 1 on an error."};
  Arguments arguments;
  try {
    arguments.programs = fs::read_symlink("/proc/self/exe").parent_path().string();
    std::vector<std::string> names;
    for (const Kind& kind : kinds()) names.emplace_back(kind.name);
    app.add_option("--scenarios", arguments.scenarios, "shipped scenarios of 40 s or more whose vehicle drives")
        ->capture_default_str();
    app.add_option("--profiles", arguments.profiles, "radar profiles, names or files")->capture_default_str();
    app.add_option("--only", arguments.only, "kinds of damage; default: all")->check(CLI::IsMember(names));
    app.add_option("--seeds", arguments.seeds, "drives of each scenario, profile and kind")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--seed", arguments.first_seed, "first seed; default: drawn, and printed")
        ->check(CLI::PositiveNumber);
    app.add_option("--keep", arguments.keep, "folder for the drives, which are kept");
    app.add_option("--config", arguments.config, "folder with vehicle/ and services/")->capture_default_str();
    app.add_option("--jobs", arguments.jobs, "drives at the same time")
        ->check(CLI::Range(1, 64))
        ->capture_default_str();
    app.add_option("--json", arguments.json, "write the report to this file");
    CLI11_PARSE(app, argc, argv);
    return run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kError;
  }
}
