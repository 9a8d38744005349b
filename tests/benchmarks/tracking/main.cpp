// boresight-bench-baseline_tracker RUN --vehicle NAME --out DIR: the baseline's tracks of a run, for `boresight score`.
#include <cstdio>
#include <exception>
#include <string>

#include <CLI/CLI.hpp>

#include "services/common/runtime/options.hpp"
#include "tests/benchmarks/tracking/common/baseline_run.hpp"

int main(int argc, char** argv) {
  CLI::App app{"The baseline tracker over a folder of `boresight run`."};
  std::string run, out;
  boresight::runtime::Configuration configuration;
  boresight::bench::BaselineSettings settings;
  app.add_option("run", run, "Folder of a run")->required();
  app.add_option("--out", out, "Folder for the tracks of the baseline")->required();
  app.add_option("--min-points", settings.cluster_min_points, "Fewest detections within the radius of a core point")
      ->capture_default_str();
  boresight::runtime::add_vehicle_option(app, configuration);
  boresight::runtime::add_config_option(app, configuration);
  CLI11_PARSE(app, argc, argv);
  try {
    const boresight::VehicleConfig vehicle = configuration.vehicle(boresight::config::VehicleUse::kOffline);
    boresight::bench::run_baseline(run, vehicle, out, settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
