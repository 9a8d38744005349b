// boresight-bench-tracking_surroundings: road edges and collision warnings on simulated drives. See ../README.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/run/chain.hpp"
#include "services/boresight/run/settings.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/common/statistics.hpp"
#include "tests/benchmarks/tracking/surroundings/judge/edge_judge.hpp"
#include "tests/benchmarks/tracking/surroundings/judge/warning_judge.hpp"

namespace {

using namespace boresight;
using namespace boresight::bench;
using namespace boresight::bench::surroundings;

constexpr double kLongestRms_m = 0.3, kLeastNees = 0.5, kMostNees = 2.0, kLeastWarning_s = 2.0;
constexpr std::size_t kLongestBarHours = 1;
/// Scenarios in which a collision threatens.
const std::vector<std::string> kThreats{"stopped_car", "crossing_pedestrian"};
/// Scenarios in which none does, although something stands ahead.
const std::vector<std::string> kNoThreats{"parked_row_in_curve"};

struct Setup {
  std::vector<std::string> scenarios, profiles{"series_77ghz", "can_cluster"};
  std::size_t seeds = 5;
  std::uint64_t first_seed = 0;
  double hours = 0.0;  // at least, of drives without a threat; 0: one of each scenario and seed
  double duration_s = 0.0;
  std::size_t jobs = 2;
  std::string config = BORESIGHT_SOURCE_DIR "/config", tracker;
  bool verbose = false;
};

struct OneDrive {
  std::string profile, scenario;
  std::uint64_t seed = 0;
  EdgeFigures edges;
  std::vector<Warning> warnings;
  std::optional<double> shortest_s;
  double driven_s = 0.0;
  double cpu_s = 0.0;
};

void run(const Setup& setup, OneDrive& drive_of) {
  simulator::Scenario scenario = simulator::scenario(drive_of.scenario);
  simulator::use_profile(scenario, drive_of.profile);
  runtime::Configuration files;
  files.directory = setup.config;
  files.vehicle_name = scenario.vehicle.empty() ? "demo" : scenario.vehicle;
  files.statistics = drive_of.profile;
  const VehicleConfig vehicle = files.vehicle();
  run::Settings settings = run::read_settings(files, vehicle);
  if (!setup.tracker.empty()) settings.tracker.tracker = setup.tracker;
  const double duration_s =
      setup.duration_s > 0.0 ? std::min(setup.duration_s, scenario.duration_s) : scenario.duration_s;
  simulator::Drive drive(scenario, vehicle, drive_of.seed, duration_s);
  run::Chain chain(vehicle, settings);
  WarningJudge warnings;
  const std::int64_t begin_ns = runtime::thread_cpu_time_ns();
  const auto scan = std::make_unique<RadarScan>();
  while (const simulator::Event* event = drive.next()) {
    chain.advance(event->stamp_ns);
    if (event->scan == nullptr) {
      EgoMotion motion = simulator::to_message(*event, vehicle.ego);
      chain.add_ego(motion, event->stamp_ns);
      continue;
    }
    *scan = *event->scan;
    if (!chain.add_scan(*scan, event->stamp_ns)) continue;
    add(chain.tracks(), true_edges(scenario, drive.world(), drive.ego(event->t_s)), drive_of.edges);
    warnings.add(chain.tracks(), drive, event->t_s);
    drive_of.driven_s = event->t_s;
  }
  chain.finish();
  drive_of.cpu_s = 1e-9 * static_cast<double>(runtime::thread_cpu_time_ns() - begin_ns);
  drive_of.warnings = warnings.warnings();
  drive_of.shortest_s = warnings.shortest_s();
}

bool is_in(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void print(const OneDrive& d) {
  const EdgeFigures& e = d.edges;
  fmt::print(
      "{} {} {}: {:.0f} s, {:.0f} s CPU; edges rms {:.3f} m, out {:+.3f} m, NEES {:.2f}, found {:.0f} %, inner {:.0f} "
      "%, elsewhere {:.0f} %; shortest contact {}\n",
      d.profile, d.scenario, d.seed, d.driven_s, d.cpu_s, e.rms_m(), e.signed_m / static_cast<double>(e.samples),
      e.nees(), 100.0 * static_cast<double>(e.found) / static_cast<double>(e.wanted),
      100.0 * static_cast<double>(e.inner) / static_cast<double>(e.samples),
      100.0 * static_cast<double>(e.elsewhere) / static_cast<double>(e.samples + e.elsewhere),
      d.shortest_s ? fmt::format("{:.2f} s", *d.shortest_s) : "none");
  for (const Warning& w : d.warnings) {
    const PathObject& o = w.object;
    fmt::print(
        "  warning {:.2f} … {:.2f} s, true contact {}, {} {} at ({:.1f}, {:.1f}) m, v ({:.1f}, {:.1f}) m/s, in {:.2f} "
        "± "
        "{:.2f} s, offset {:.2f} ± {:.2f} m, box {:.1f} × {:.1f} m, P {:.2f}, existence {:.3f}, age {:.1f} s\n",
        w.begin_s, w.end_s, w.contact_s ? fmt::format("{:.2f} s", *w.contact_s) : "none",
        o.kind == PathObjectKind::kTrack ? "track" : "obstacle", o.object_id, o.position_vehicle_m[0],
        o.position_vehicle_m[1], o.velocity_over_ground_mps[0], o.velocity_over_ground_mps[1], o.time_to_collision_s,
        o.time_to_collision_std_s, o.path_offset_m, o.path_offset_std_m, o.length_m, o.width_m, o.collision_probability,
        o.existence_probability, o.age_s);
  }
}

/// Statistic of the pooled edges of drives with an interval over the drives.
template <typename Statistic>
std::pair<double, Interval> pooled(const std::vector<const OneDrive*>& drives, const Statistic& statistic) {
  const auto sum = [&](const std::vector<std::size_t>& picks) {
    EdgeFigures all;
    for (const std::size_t i : picks) {
      const EdgeFigures& e = drives[i]->edges;
      all.samples += e.samples;
      all.squares_m2 += e.squares_m2;
      all.normalised += e.normalised;
      all.inner += e.inner;
      all.elsewhere += e.elsewhere;
      all.wanted += e.wanted;
      all.found += e.found;
    }
    return statistic(all);
  };
  std::vector<std::size_t> every(drives.size());
  for (std::size_t i = 0; i < every.size(); ++i) every[i] = i;
  return {sum(every), bootstrap(drives.size(), sum)};
}

void judge_edges(const std::string& profile, const std::vector<const OneDrive*>& drives, Report& report) {
  const auto share = [](std::size_t part, std::size_t all) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(all);
  };
  const auto rms = pooled(drives, [](const EdgeFigures& e) { return e.rms_m(); });
  const auto nees = pooled(drives, [](const EdgeFigures& e) { return e.nees(); });
  const auto found = pooled(drives, [&](const EdgeFigures& e) { return share(e.found, e.wanted); });
  const auto elsewhere =
      pooled(drives, [&](const EdgeFigures& e) { return share(e.elsewhere, e.samples + e.elsewhere); });
  const auto how = [&](const Interval& interval) {
    return fmt::format("{}, {} drives, 95 %: {}–{}", profile, drives.size(), number(interval.low),
                       number(interval.high));
  };
  report.at_most("edges", "rms error within 30 m", rms.first, kLongestRms_m, "m", how(rms.second));
  report.within("edges", "squared error over stated variance", nees.first, kLeastNees, kMostNees, "1",
                how(nees.second));
  report.beside("edges", "innermost structures with an edge", found.first, "%", how(found.second));
  report.beside("edges", "edges at no structure", elsewhere.first, "%", how(elsewhere.second));
}

void judge_threats(const std::string& profile, const std::string& scenario, const std::vector<const OneDrive*>& drives,
                   Report& report) {
  std::vector<double> before_s;
  for (const OneDrive* d : drives) {
    double longest_s = 0.0;  // a warning that never comes is one of no time
    for (const Warning& w : d->warnings) {
      if (w.contact_s) longest_s = std::max(longest_s, *w.contact_s);
    }
    before_s.push_back(longest_s);
  }
  const Interval interval = median_interval(before_s);
  report.at_least("warnings", scenario + ": warned before contact, shortest of all drives", quantile(before_s, 0.0),
                  kLeastWarning_s, "s", fmt::format("{}, {} drives", profile, drives.size()));
  report.beside(
      "warnings", scenario + ": warned before contact, median", median(before_s), "s",
      fmt::format("{}, {} drives, 95 %: {}–{}", profile, drives.size(), number(interval.low), number(interval.high)));
}

/// False are warnings at times when no contact threatens, in any drive.
void judge_false(const std::string& profile, const std::vector<const OneDrive*>& drives, Report& report) {
  std::size_t count = 0;
  double hours = 0.0;
  for (const OneDrive* d : drives) {
    hours += d->driven_s / 3600.0;
    for (const Warning& w : d->warnings) count += w.contact_s ? 0 : 1;
  }
  const Interval interval = poisson_interval(count);
  const std::string how = fmt::format("{}, {} in {:.2f} h, 95 %: {}–{} an hour", profile, count, hours,
                                      number(interval.low / hours), number(interval.high / hours));
  const double per_hour = static_cast<double>(count) / hours;
  if (hours >= static_cast<double>(kLongestBarHours)) {
    report.at_most("warnings", "false warnings", per_hour, 0.0, "1/h", how);
  } else {
    report.beside("warnings", "false warnings", per_hour, "1/h", how + "; a bar from 1 h on");
  }
}

std::vector<OneDrive> drives_of(const Setup& setup) {
  std::vector<OneDrive> drives;
  for (const std::string& profile : setup.profiles) {
    double driven_s = 0.0;
    for (std::size_t k = 0; k < setup.seeds || driven_s < 3600.0 * setup.hours; ++k) {
      for (const std::string& name : setup.scenarios) {
        const bool is_other = !is_in(kThreats, name) && !is_in(kNoThreats, name);
        if (k >= setup.seeds && !is_other) continue;
        OneDrive& drive = drives.emplace_back();
        drive.profile = profile;
        drive.scenario = name;
        drive.seed = setup.first_seed + k;
        if (!is_other) continue;
        const double whole_s = simulator::scenario(name).duration_s;
        driven_s += setup.duration_s > 0.0 ? std::min(setup.duration_s, whole_s) : whole_s;
      }
      if (driven_s <= 0.0 && k + 1 >= setup.seeds) break;
    }
  }
  return drives;
}

void judge(const Setup& setup, Report& report) {
  std::vector<OneDrive> drives = drives_of(setup);
  parallel_for(drives.size(), setup.jobs, [&](std::size_t i) { run(setup, drives[i]); });
  for (const std::string& profile : setup.profiles) {
    std::vector<const OneDrive*> all;
    for (const OneDrive& d : drives) {
      if (d.profile != profile) continue;
      if (setup.verbose) print(d);
      all.push_back(&d);
    }
    std::vector<const OneDrive*> with_edges;
    std::copy_if(all.begin(), all.end(), std::back_inserter(with_edges),
                 [](const OneDrive* d) { return d->edges.wanted > 0; });
    if (!with_edges.empty()) judge_edges(profile, with_edges, report);
    for (const std::string& name : kThreats) {
      std::vector<const OneDrive*> same;
      std::copy_if(all.begin(), all.end(), std::back_inserter(same),
                   [&](const OneDrive* d) { return d->scenario == name; });
      if (!same.empty()) judge_threats(profile, name, same, report);
    }
    judge_false(profile, all, report);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Setup setup;
  setup.scenarios = simulator::scenario_names();
  std::string json;
  bool quick = false;
  CLI::App app{"Road edges and collision warnings on simulated drives. Exit code 0 also if bars fail, 1 on an error."};
  app.add_option("--scenarios", setup.scenarios, "scenarios by name; default: all that are shipped")->delimiter(',');
  app.add_option("--profiles", setup.profiles, "radar profiles")->delimiter(',')->capture_default_str();
  app.add_option("--seeds", setup.seeds, "drives of each scenario")->capture_default_str();
  app.add_option("--seed", setup.first_seed, "first seed; default: fresh ones");
  app.add_option("--hours", setup.hours, "more seeds of the scenarios without a threat, until they are that long");
  app.add_option("--duration", setup.duration_s, "longest drive in seconds; default: as the scenario says");
  app.add_option("--jobs", setup.jobs, "threads")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--config", setup.config, "folder with vehicle/ and services/")->capture_default_str();
  app.add_option("--tracker", setup.tracker, "tracker instead of the one in services/tracker.toml");
  app.add_flag("--verbose", setup.verbose, "print each drive and each warning");
  app.add_flag("--quick", quick, "two short drives: a check that it runs, not a measurement");
  app.add_option("--json", json, "write bars to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    if (setup.first_seed == 0) {
      constexpr std::uint64_t kStep = 1000, kSteps = 1'000'000;
      setup.first_seed = kStep * (1000 + std::random_device{}() % kSteps);
    }
    if (quick) {
      setup.scenarios = {"straight_rail", "stopped_car"};
      setup.profiles = {"series_77ghz"};
      setup.seeds = 1;
      setup.duration_s = 5.0;
    }
    fmt::print("seeds from {} on\n", setup.first_seed);
    Report report;
    judge(setup, report);
    report.print(std::cout);
    if (json.empty()) return 0;
    std::ofstream out(json);
    report.write_json(out);
    out.flush();
    if (!out) throw std::runtime_error(json + ": cannot be written");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
