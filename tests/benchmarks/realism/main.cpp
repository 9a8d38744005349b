// boresight-bench-realism: what simulated radars report beside what real radars report, with a verdict per row.
// See README.md.
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/realism/common/drives.hpp"
#include "tests/benchmarks/realism/rows/tables.hpp"

namespace {

using namespace boresight;
using namespace boresight::bench;

constexpr int kMet = 0, kMissed = 1, kError = 3;

struct Arguments {
  realism::Drives drives;
  std::size_t seeds = 3;
  std::vector<std::string> profiles{"series_77ghz", "can_cluster", "ideal"};
  std::string json, markdown;
  bool quick = false;
};

/// Main roads and towns, as the measured drives. Standing trucks are in no shipped scenario of these.
const std::vector<std::string> kScenarios{
    "aligned_drive",
    "curve_with_rail",
    "highway_multipath",
    "straight_rail",
    "truck_overtaking",
    "motorway_braking",
    "city_canyon",
    "junction",
    BORESIGHT_SOURCE_DIR "/tests/benchmarks/realism/scenarios/standing_trucks.toml"};

/// A million seeds are enough, and such a number is short to type.
std::uint64_t fresh_seed() {
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

int run(const Arguments& arguments) {
  std::printf("seeds %llu … %llu, %zu scenarios\n", static_cast<unsigned long long>(arguments.drives.seed),
              static_cast<unsigned long long>(arguments.drives.seed + arguments.seeds - 1),
              arguments.drives.scenarios.size());
  std::fflush(stdout);
  const VehicleConfig demo = config::read_vehicle_file(
      std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml", config::VehicleUse::kOffline);
  std::vector<realism::Column> columns;
  for (const std::string& profile : arguments.profiles) {
    columns.push_back({profile, realism::source_of(profile), {}});
    realism::Drives drives = arguments.drives;
    for (const std::uint64_t last = drives.seed + arguments.seeds; drives.seed < last; ++drives.seed) {
      std::fprintf(stderr, "%s, seed %llu\n", profile.c_str(), static_cast<unsigned long long>(drives.seed));
      const realism::Statistics statistics = realism::simulate(drives, profile, demo);
      columns.back().figures.push_back(realism::figures_of(statistics));
      std::printf("%s, seed %llu: %zu scans, %zu detections\n", profile.c_str(),
                  static_cast<unsigned long long>(drives.seed), statistics.scans, statistics.detections);
    }
  }
  const realism::Tables tables = realism::make_tables(columns);
  Report report;
  for (const Table& table : tables.sections) {
    print_table(table, std::cout);
    report.add(table);
  }
  std::cout << '\n';
  for (const realism::Tally& tally : tables.tallies) {
    std::cout << tally.profile << ": " << tally.met + tally.met_by_interval << " of " << tally.judged()
              << " rows with a verdict are met, " << tally.met_by_interval << " of these only by their interval, "
              << tally.without_data << " have no data\n";
  }
  std::cout.flush();
  if (!write(arguments.json, report, &Report::write_json)) return kError;
  if (!write(arguments.markdown, report, &Report::write_markdown)) return kError;
  return tables.all_met() ? kMet : kMissed;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  arguments.drives.scenarios = kScenarios;
  arguments.drives.seed = fresh_seed();
  CLI::App app{
      "Compares simulated radars with measured ones. R: RadarScenes, N: nuScenes (aggregate figures). "
      "Exit code 0: every row with a verdict is met, 1: some are not, 3: error."};
  app.add_option("--seed", arguments.drives.seed, "first seed; default: a fresh one");
  app.add_option("--seeds", arguments.seeds, "number of seeds; each drives all scenarios once")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--profile", arguments.profiles, "radar profiles, by name or file")->capture_default_str();
  app.add_option("--scenario", arguments.drives.scenarios, "scenarios, by name or file")->capture_default_str();
  app.add_option("--jobs", arguments.drives.jobs, "threads")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--json", arguments.json, "write the tables to this file");
  app.add_option("--markdown", arguments.markdown, "write the tables to this file");
  app.add_flag("--quick", arguments.quick, "drives of 4 s: a check that it runs, not a measurement");
  CLI11_PARSE(app, argc, argv);
  if (arguments.quick) arguments.drives.longest_s = 4.0;
  try {
    return run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kError;
  }
}
