// `boresight simulate`: a drive with truth, as recordings.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/alignment_drive_options.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/real_car_options.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/commands/simulate_drive.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/simulator/alignment/csv_writer.hpp"
#include "services/simulator/drive_writer.hpp"
#include "services/simulator/scenario/read_profile.hpp"

namespace boresight {

namespace {

constexpr double kAlignmentDrive_s = 45.0;

struct SimulateOptions {
  std::string scenario = "demo_drive";
  std::string profile;  ///< empty: as the scenario says
  runtime::Configuration configuration;
  std::string out;
  std::uint64_t seed = 1;
  double duration_s = 0.0;  ///< 0: as the scenario says, or kAlignmentDrive_s
  bool list = false;
  AlignmentDriveOptions alignment;
  RealCarOptions real_car;
};

/// Refuses "nan", which a range accepts because comparisons with it are false.
const CLI::Validator kFinite(
    [](std::string& text) {
      return text.find_first_not_of("0123456789.+-eE") == std::string::npos ? std::string() : text + " is not a number";
    },
    "", "finite");
/// Refuses a minus sign, with which the number would wrap round.
const CLI::Validator kUnsigned(
    [](std::string& text) {
      return text.find('-') == std::string::npos ? std::string() : "must not be negative, but is " + text;
    },
    "", "unsigned");

/// Says how fast a drive was simulated.
class Stopwatch {
 public:
  [[nodiscard]] std::string report(double duration_s, std::uint64_t scans, std::uint64_t detections) const {
    const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    return fmt::format("simulated {:.1f} s in {:.1f} s ({:.0f} times real time): {} scans, {} detections\n", duration_s,
                       took_s, duration_s / took_s, scans, detections);
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Calls `simulate(folder, progress, scans, detections)`, which returns the files that it wrote into `folder`; they get
/// their places in `out` when all of them are complete. Returns lines that describe the drive and name the files.
template <typename Simulate>
std::string simulate_into(const std::filesystem::path& out, double duration_s, const Simulate& simulate) {
  const Stopwatch watch;
  terminal::OutputFolder folder(out);
  terminal::ProgressBar bar("simulating");
  const auto progress = [&bar](double share) {
    stop_if_interrupted();
    if (bar.is_due()) bar.show(share);
  };
  std::uint64_t scans = 0, detections = 0;
  std::vector<std::filesystem::path> files;
  try {
    files = simulate(folder.temporary(), progress, scans, detections);
  } catch (const std::runtime_error& error) {
    throw terminal::OutputError(folder.with_final_places(error.what()));
  }
  folder.commit();
  std::string text = watch.report(duration_s, scans, detections);
  for (const std::filesystem::path& file : files) text += "  " + folder.final_place(file).string() + "\n";
  return text;
}

int simulate_alignment(const SimulateOptions& options) {
  const double duration_s = options.duration_s > 0.0 ? options.duration_s : kAlignmentDrive_s;
  std::optional<VehicleConfig> vehicle;
  if (!options.configuration.vehicle_name.empty()) {
    vehicle = options.configuration.vehicle(config::VehicleUse::kOffline);
  }
  simulator::AlignmentSpec spec =
      alignment_spec(options.alignment, vehicle ? &*vehicle : nullptr, options.seed, duration_s);
  if (const auto car = real_car(options.real_car)) spec.real_car = *car;
  terminal::print(simulate_into(options.out, duration_s,
                                [&](const std::filesystem::path& folder, const auto& progress, std::uint64_t& scans,
                                    std::uint64_t& detections) -> std::vector<std::filesystem::path> {
                                  const simulator::AlignmentFiles files =
                                      simulator::write_alignment_drive(spec, folder, progress);
                                  scans = files.scans;
                                  detections = files.detections;
                                  return {files.drive, files.ego, files.vehicle, files.truth};
                                }));
  return exit_code::kSuccess;
}

/// Prints the shipped scenarios, each with its description.
int list_scenarios() {
  std::size_t width = 0;
  for (const std::string& name : simulator::scenario_names()) width = std::max(width, name.size());
  std::string text;
  for (const std::string& name : simulator::scenario_names()) {
    const simulator::Scenario s = simulator::scenario(name);
    text += fmt::format("{:<{}}  {:3.0f} s, vehicle {}: {}\n", name, width, s.duration_s, s.vehicle, s.about);
  }
  terminal::print(text);
  return exit_code::kSuccess;
}

std::string shipped_names() {
  return fmt::format("{}", fmt::join(simulator::scenario_names(), ", "));
}

/// The vehicle of the command line, or else the vehicle that the scenario names.
VehicleConfig simulated_vehicle(const SimulateOptions& options, const simulator::Scenario& scenario) {
  runtime::Configuration configuration = options.configuration;
  if (configuration.vehicle_name.empty()) configuration.vehicle_name = scenario.vehicle;
  if (configuration.vehicle_name.empty()) throw UsageError("the scenario names no vehicle; name one by --vehicle");
  return configuration.vehicle();
}

int run_simulate(const SimulateOptions& options) {
  if (options.list) return list_scenarios();
  if (options.out.empty()) throw UsageError("--out is required: the folder for the recordings and the truth");
  if (!options.alignment.road.empty()) return simulate_alignment(options);
  simulator::Scenario scenario = simulator::scenario(options.scenario);
  if (!options.profile.empty()) simulator::use_profile(scenario, options.profile);
  if (const auto car = real_car(options.real_car)) scenario.effects.real_car = *car;
  const VehicleConfig vehicle = simulated_vehicle(options, scenario);
  const double duration_s = options.duration_s > 0.0 ? options.duration_s : scenario.duration_s;
  terminal::print(write_simulated_drive(scenario, vehicle, options.seed, duration_s, options.out));
  return exit_code::kSuccess;
}

}  // namespace

std::string write_simulated_drive(const simulator::Scenario& scenario, const VehicleConfig& vehicle, std::uint64_t seed,
                                  double duration_s, const std::filesystem::path& folder) {
  return simulate_into(folder, duration_s,
                       [&](const std::filesystem::path& temporary, const auto& progress, std::uint64_t& scans,
                           std::uint64_t& detections) -> std::vector<std::filesystem::path> {
                         const simulator::DriveFiles files =
                             simulator::write_drive(scenario, vehicle, seed, duration_s, temporary, progress);
                         scans = files.scans;
                         detections = files.number_of_detections;
                         return {files.radars,  files.ego,     files.truth,     files.detections,
                                 files.objects, files.sensors, files.visibility};
                       });
}

void add_simulate_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* const command =
      app.add_subcommand("simulate", "Simulates a drive and writes it as recordings with the truth beside them.");
  CLI::Option* const scenario =
      command
          ->add_option("--scenario", options->scenario, "Scenario: a file (TOML), or a shipped one: " + shipped_names())
          ->type_name("NAME|FILE")
          ->capture_default_str();
  runtime::add_vehicle_option(
      *command, options->configuration,
      "Vehicle: a name in the folder vehicle/, or a file. Default: the vehicle of the scenario; "
      "for an alignment drive, four corner radars");
  runtime::add_config_option(*command, options->configuration);
  CLI::Option* const profile =
      command
          ->add_option("--profile", options->profile,
                       "Radar profile of all radars: a file (TOML), or a shipped one: " +
                           fmt::format("{}", fmt::join(simulator::radar_profile_names(), ", ")) +
                           "; default: as the scenario says")
          ->type_name("NAME|FILE");
  CLI::Option* const out = command
                               ->add_option("--out", options->out,
                                            "Folder for the recordings and the truth; made if it does not exist, files "
                                            "of an earlier run in it are replaced")
                               ->type_name("DIR");
  command->add_flag("--list", options->list, "Lists the shipped scenarios, each with its description")
      ->excludes(scenario)
      ->excludes(out);
  command->add_option("--seed", options->seed, "Random seed: another seed is another drive")
      ->type_name("N")
      ->capture_default_str()
      ->check(kUnsigned);
  command
      ->add_option("--duration", options->duration_s,
                   "Duration in seconds; default: that of the scenario, 45 s for an alignment drive")
      ->type_name("S")
      ->check(CLI::Range(0.1, 36000.0))
      ->check(kFinite);
  add_real_car_options(*command, options->real_car);
  CLI::Option* const alignment = add_alignment_drive_options(*command, options->alignment);
  alignment->excludes(scenario);
  alignment->excludes(profile);
  on_call(
      *command, exit_code,
      {"simulate --scenario city_canyon --profile series_77ghz --out drive\n"
       "simulate --alignment-drive city --random-truth --out drive",
       "the drive is written", ""},
      [options] { return run_simulate(*options); }, &options->configuration);
}

}  // namespace boresight
