// boresight-bench-ghosts_explain: lists each detection that was classified wrongly, with its truth, object and track.
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "services/ghost_filter/config.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/ghosts/common/tables.hpp"
#include "tests/benchmarks/ghosts/explain/boxes.hpp"
#include "tests/benchmarks/ghosts/explain/explained.hpp"

using namespace boresight;
using namespace boresight::bench;

namespace {

struct Arguments {
  std::string scenario = "highway_multipath", method = "mirror", profile, config_file, csv_file, boxes_file;
  std::uint64_t seed = 101;
  std::size_t seeds = 1;
  double duration_s = 20.0;
  bool all = false;
};

NamedGhostMethod method_of(const Arguments& arguments) {
  ghosts::Config config;
  if (!arguments.config_file.empty()) config = ghosts::read_config(config::Reader::open(arguments.config_file));
  config.method = arguments.method == "mirror" ? ghosts::MethodName::kMirror : ghosts::MethodName::kPublished;
  return {arguments.method, config, {}};
}

void print_faults(const std::vector<Outcome>& outcomes, std::uint64_t seed) {
  for (const Outcome& outcome : outcomes) {
    for (const GhostTrack& track : outcome.long_ghost_tracks) {
      std::printf("seed %llu: ghost track %u, %zu scans from %.2f to %.2f s, last position (%.1f, %.1f) m\n",
                  static_cast<unsigned long long>(seed), track.tracking_id, track.scans, track.since_s, track.until_s,
                  track.x_vehicle_m, track.y_vehicle_m);
    }
    for (const LostSecond& lost : outcome.lost.lost) {
      std::printf("seed %llu: object %u lost in the second before %.0f s\n", static_cast<unsigned long long>(seed),
                  lost.object_id, lost.until_s);
    }
    ++seed;
  }
}

/// Opens a file and writes the header line; without a name the stream stays closed.
std::ofstream table(const std::string& name, const char* header) {
  std::ofstream out;
  if (!name.empty()) {
    out.open(name);
    out << header;
  }
  return out;
}

void close(std::ofstream& out, const std::string& name) {
  out.flush();
  if (!out) throw std::runtime_error("cannot write " + name);
}

void run(const Arguments& arguments) {
  const NamedGhostMethod method = method_of(arguments);
  std::ofstream csv = table(arguments.csv_file, csv_header()), boxes = table(arguments.boxes_file, boxes_header());
  Summary summary;
  Report report;
  std::vector<Outcome> outcomes;
  for (std::uint64_t seed = arguments.seed; seed < arguments.seed + arguments.seeds; ++seed) {
    Explainer explainer(seed);
    const Observer observe = [&](const Observed& observed) {
      for (const Explained& row : explainer.explain(observed)) {
        summary.add(row);
        const bool is_wrong = !row.rejected && row.truth.provenance != row.label;
        if (csv.is_open() && (is_wrong || arguments.all)) write_csv(row, csv);
      }
      if (boxes.is_open()) write_boxes(seed, observed, boxes);
    };
    outcomes.push_back(
        run_ghost_drive({arguments.scenario, arguments.profile, seed, arguments.duration_s}, {&method, 1}, observe)
            .front());
  }
  close(csv, arguments.csv_file);
  close(boxes, arguments.boxes_file);
  const std::string how =
      "seeds " + std::to_string(arguments.seed) + " to " + std::to_string(arguments.seed + arguments.seeds - 1);
  report.add(confusion_table("", arguments.scenario + ", " + arguments.method + ": % of each truth, " + how, outcomes));
  judge_tracks(arguments.scenario, outcomes, false, how, report);
  report.print(std::cout);
  std::cout << "\nNumber of detections by distance from their object's box (without an object: from the nearest box). "
               "tracked: the filter had a confirmed track of the object.\n";
  summary.print(std::cout);
  std::cout << std::endl;
  print_faults(outcomes, arguments.seed);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Lists the detections that the ghost filter classifies wrongly on a simulated drive."};
  app.add_option("scenario", arguments.scenario, "name, or a scenario file")->capture_default_str();
  app.add_option("--profile", arguments.profile, "radar profile of all radars; default: as the scenario says")
      ->type_name("NAME|FILE");
  app.add_option("--method", arguments.method, "ghost filter method")
      ->check(CLI::IsMember({"mirror", "published"}))
      ->capture_default_str();
  app.add_option("--config", arguments.config_file,
                 "file like config/services/ghost_filter.toml; its method is not used")
      ->check(CLI::ExistingFile);
  app.add_option("--seed", arguments.seed, "first seed; the bars use 1 to 20, so use others for tuning")
      ->capture_default_str();
  app.add_option("--seeds", arguments.seeds, "number of seeds")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--duration", arguments.duration_s, "s, at most the scenario's duration")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--csv", arguments.csv_file, "file with a row for each detection classified wrongly");
  app.add_option("--boxes", arguments.boxes_file,
                 "file with a row for each track and each true object after each scan");
  app.add_flag("--all", arguments.all, "also rows for detections classified correctly or rejected by the corrector");
  CLI11_PARSE(app, argc, argv);
  try {
    run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
