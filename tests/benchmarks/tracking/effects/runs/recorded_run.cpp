#include "tests/benchmarks/tracking/effects/runs/recorded_run.hpp"

#include <cmath>

#include "services/boresight/score/run_folder.hpp"
#include "tests/benchmarks/tracking/drives/runs/list_reader.hpp"
#include "tests/benchmarks/tracking/drives/runs/process.hpp"

namespace boresight::bench::tracking {

namespace fs = std::filesystem;

namespace {

/// The vehicle of the recording with the settings of the services.
fs::path make_configuration(const EffectSetup& setup, const EffectRecording& recording) {
  const fs::path config = setup.place / "config";
  const std::string vehicle = std::string(recording.vehicle) + ".toml";
  for (const char* const folder : {"vehicle", "mappings"}) fs::create_directories(config / folder);
  const auto replaced = fs::copy_options::overwrite_existing;
  for (const char* const folder : {"services", "radar_profiles"}) {
    fs::copy(setup.services.parent_path() / folder, config / folder, replaced | fs::copy_options::recursive);
  }
  fs::copy_file(setup.data / vehicle, config / "vehicle" / vehicle, replaced);
  for (const char* const file : {"zoe.toml", "zoe.dbc"}) {
    fs::copy_file(setup.data / file, config / "mappings" / file, replaced);
  }
  return config;
}

}  // namespace

std::vector<ObservedList> run_recording(const EffectSetup& setup, const EffectRecording& recording) {
  const std::string file = std::string(recording.name) + recording.ending;
  const fs::path unpacked = setup.place / file, run = setup.place / recording.name;
  const fs::path config = make_configuration(setup, recording);
  run_program({"xz", "-dc", (setup.data / (file + ".xz")).string()}, unpacked, {0});
  std::vector<std::string> words = {(setup.programs / "boresight").string(),
                                    "run",
                                    unpacked.string(),
                                    "--config",
                                    config.string(),
                                    "--vehicle",
                                    recording.vehicle,
                                    "--out",
                                    run.string(),
                                    "--quiet"};
  if (!setup.tracker.empty()) words.insert(words.end(), {"--tracker", setup.tracker});
  run_program(words, setup.place / "log.txt", {0});

  std::vector<ObservedList> lists;
  score::RunDetections detections(run, score::RunDetections::Detail::kAll);
  std::vector<score::RunDetection> of_scan;
  for (ListReader reader(run, kExistenceColumn); reader.next();) {
    ObservedList& list = lists.emplace_back(ObservedList{reader.scan().t_s, reader.tracks(), {}});
    detections.take(reader.scan(), of_scan);
    for (const score::RunDetection& detection : of_scan) {
      if (!(std::abs(detection.range_rate_over_ground_mps) > kMoves_mps)) continue;
      list.moving_m.emplace_back(detection.x_vehicle_m, detection.y_vehicle_m);
    }
  }
  return lists;
}

}  // namespace boresight::bench::tracking
