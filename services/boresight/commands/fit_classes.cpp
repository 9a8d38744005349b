// `boresight fit-classes`: labelled features of tracks, from which the forest of the tracker's classes is grown.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/fit_classes/labelled_features.hpp"
#include "services/boresight/fit_classes/random_traffic.hpp"
#include "services/boresight/run/settings.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"

namespace boresight {

namespace {

constexpr const char* kRandomTraffic = "random";

struct FitClassesOptions {
  std::vector<std::string> scenarios{kRandomTraffic}, profiles{"series_77ghz", "can_cluster"};
  std::uint64_t seed = 1;
  std::size_t drives = 1;
  double duration_s = 20.0;
  std::string tracker, out = "-";
  runtime::Configuration configuration;
};

int fit_classes_of(const FitClassesOptions& options) {
  terminal::OutputFile out(options.out);
  terminal::ProgressBar bar("simulating");
  const tracking::ObjectForest forest;
  out.write(fit_classes::features_head(forest));
  const std::size_t all = options.profiles.size() * options.scenarios.size() * options.drives;
  std::size_t done = 0;
  for (const std::string& profile : options.profiles) {
    runtime::Configuration configuration = options.configuration;
    configuration.statistics = profile;
    const VehicleConfig vehicle = configuration.vehicle();
    run::Settings settings = run::read_settings(configuration, vehicle);
    if (!options.tracker.empty()) settings.tracker.tracker = options.tracker;
    for (const std::string& name : options.scenarios) {
      for (std::uint64_t seed = options.seed; seed < options.seed + options.drives; ++seed, ++done) {
        fit_classes::SimulatedDrive drive;
        drive.scenario =
            name == kRandomTraffic ? fit_classes::random_traffic(seed, options.duration_s) : simulator::scenario(name);
        simulator::use_profile(drive.scenario, profile);
        drive.seed = seed;
        drive.duration_s = std::min(options.duration_s, drive.scenario.duration_s);
        const auto look = [&] {
          stop_if_interrupted();
          if (bar.is_due()) bar.show(static_cast<double>(done) / static_cast<double>(all), name);
        };
        const auto rows = fit_classes::labelled_features(drive, vehicle, settings, forest, look);
        for (const auto& row : rows) out.write(fit_classes::features_row(profile, name, seed, row));
      }
    }
  }
  bar.wipe();
  out.commit();
  return exit_code::kSuccess;
}

}  // namespace

void add_fit_classes_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "fit-classes", "Simulates drives and writes features of tracks with their true classes, to grow the forest.");
  const auto options = std::make_shared<FitClassesOptions>();
  command
      ->add_option("--scenarios", options->scenarios,
                   "Scenarios: names, files, or \"random\" for random traffic of all classes")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  command->add_option("--profiles", options->profiles, "Radar profiles: names or files")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of the first drive")->capture_default_str();
  command->add_option("--drives", options->drives, "Drives of each scenario and profile, with rising seeds")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--duration", options->duration_s, "Longest duration of a drive, s")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  command->add_option("--tracker", options->tracker, "Tracker whose tracks are used; default: that of tracker.toml")
      ->type_name("NAME");
  command->add_option("--out", options->out, "File for the table; \"-\": standard output")
      ->type_name("FILE")
      ->capture_default_str();
  runtime::add_vehicle_option(*command, options->configuration, "Vehicle: a name in the folder vehicle/, or a file")
      ->required();
  runtime::add_config_option(*command, options->configuration);
  on_call(
      *command, exit_code,
      {"fit-classes --vehicle demo --seed 100 --drives 20 --out features.csv", "the table was written", ""},
      [options] { return fit_classes_of(*options); }, &options->configuration);
}

}  // namespace boresight
