// boresight-bench-tracking_effects: recordings of what real radars do, through the whole chain. See ../README.md.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/tracking/drives/runs/place.hpp"
#include "tests/benchmarks/tracking/effects/runs/recorded_run.hpp"

namespace {

using namespace boresight::bench;
using namespace boresight::bench::tracking;
namespace fs = std::filesystem;

constexpr Rule kConfirmedRule{-std::numeric_limits<float>::infinity(), true}, kLikelyRule{0.5F, false};
constexpr double kLongestDelay_s = 0.3, kLongestSecond_s = 0.5;

/// An effect beside the same recording without it.
struct Effect {
  EffectRecording with, without;
};
constexpr Effect kWeakCar{{"weak_car", ".pcap", "real_effects"}, {"strong_car", ".pcap", "real_effects"}};
constexpr Effect kSideLobes{{"side_lobes", ".pcap", "real_effects"}, {"no_side_lobes", ".pcap", "real_effects"}};
constexpr Effect kWideRms{{"wide_rms", ".log", "real_effects_ars408"}, {"true_rms", ".log", "real_effects_ars408"}};

/// A figure of the recording with the effect is judged at confirmed tracks; all others stand beside it.
template <typename FigureOf>
void compare(const Effect& effect, const EffectSetup& setup, const std::string& what, const std::string& unit,
             double most, Report& report, const FigureOf& figure_of) {
  const std::string group = effect.with.name;
  for (const EffectRecording& recording : {effect.with, effect.without}) {
    const std::vector<ObservedList> lists = run_recording(setup, recording);
    const std::string at = std::string(recording.name) + ": " + what;
    const double figure = figure_of(lists, kConfirmedRule);
    if (recording.name == group) {
      report.at_most(group, at, figure, most, unit, "confirmed");
    } else {
      report.beside(group, at, figure, unit, "confirmed");
    }
    report.beside(group, at, figure_of(lists, kLikelyRule), unit, "existence ≥ 0.5");
    report.beside(group, std::string(recording.name) + ": lists with a track", tracked_percent(lists, kConfirmedRule),
                  "%", "confirmed, from the first detection on");
  }
}

void run(const EffectSetup& setup, Report& report) {
  compare(kWeakCar, setup, "first detection to first track", "s", kLongestDelay_s, report, delay_s);
  compare(kSideLobes, setup, "time with a second track", "s", kLongestSecond_s, report,
          [](const std::vector<ObservedList>& lists, const Rule& rule) { return second_tracks(lists, rule).total_s; });
  // Any delay is one.
  constexpr double kWholeRecording_s = 12.0;
  compare(kWideRms, setup, "first detection to first track", "s", kWholeRecording_s, report, delay_s);
}

}  // namespace

int main(int argc, char** argv) {
  EffectSetup setup;
  std::string data = BORESIGHT_SHARED_DATA, config = BORESIGHT_SOURCE_DIR "/config", json;
  CLI::App app{
      "Recordings of what real radars do, through the whole chain. Exit code 0 also if bars fail, 1 on an "
      "error."};
  app.add_option("--data", data, "folder of real_effects/")->capture_default_str();
  app.add_option("--config", config, "folder with services/")->capture_default_str();
  app.add_option("--tracker", setup.tracker, "tracker instead of the one in services/tracker.toml");
  app.add_option("--json", json, "write bars to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    setup.programs = fs::read_symlink("/proc/self/exe").parent_path();
    setup.services = fs::path(config) / "services";
    setup.data = fs::path(data) / "real_effects";
    if (!fs::exists(setup.data)) {
      std::puts("skipped: no shared data");
      return 0;
    }
    const Place place("boresight_tracking_effects");
    setup.place = place.path();
    Report report;
    run(setup, report);
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
