// `boresight simulate`: a drive with truth, as recordings.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "services/boresight/commands/alignment_drive_options.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "tests/simulator/alignment/csv_writer.hpp"
#include "tests/simulator/drive_writer.hpp"

namespace boresight {

namespace {

constexpr double kAlignmentDrive_s = 45.0;

struct Options {
  std::string scenario = "demo_drive";
  std::string vehicle;
  std::string out;
  std::uint64_t seed = 1;
  std::string config = "/etc/boresight";
  double duration_s = 0.0;  ///< 0: as the scenario says, or kAlignmentDrive_s
  bool list = false;
  AlignmentDriveOptions alignment;
};

/// What a range lets pass: comparisons with "not a number" are false.
const CLI::Validator kFinite(
    [](std::string& text) {
      return text.find_first_not_of("0123456789.+-eE") == std::string::npos ? std::string() : text + " is not a number";
    },
    "", "finite");
/// A sign would wrap round.
const CLI::Validator kUnsigned(
    [](std::string& text) {
      return text.find('-') == std::string::npos ? std::string() : "must not be negative, but is " + text;
    },
    "", "unsigned");

/// Tells how fast a drive was simulated.
class Stopwatch {
 public:
  void tell(double duration_s, std::uint64_t scans, std::uint64_t detections) const {
    const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    std::printf("simulated %.1f s in %.1f s (%.0f times real time): %llu scans, %llu detections\n", duration_s, took_s,
                duration_s / took_s, static_cast<unsigned long long>(scans),
                static_cast<unsigned long long>(detections));
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

int simulate_alignment(const Options& options) {
  const Stopwatch watch;
  const double duration_s = options.duration_s > 0.0 ? options.duration_s : kAlignmentDrive_s;
  std::optional<VehicleConfig> vehicle;
  if (!options.vehicle.empty()) vehicle = config::read_vehicle_file(options.vehicle);
  const simulator::AlignmentSpec spec =
      alignment_spec(options.alignment, vehicle ? &*vehicle : nullptr, options.seed, duration_s);
  terminal::ProgressBar bar("simulating");
  const simulator::AlignmentFiles files = simulator::write_alignment_drive(spec, options.out, [&bar](double share) {
    if (bar.is_due()) bar.show(share);
  });
  bar.wipe();
  watch.tell(duration_s, files.scans, files.detections);
  for (const auto& file : {files.drive, files.ego, files.vehicle, files.truth}) std::printf("  %s\n", file.c_str());
  return EXIT_SUCCESS;
}

/// The shipped scenarios with what they show.
int list() {
  std::size_t width = 0;
  for (const std::string& name : simulator::scenario_names()) width = std::max(width, name.size());
  for (const std::string& name : simulator::scenario_names()) {
    const simulator::Scenario s = simulator::scenario(name);
    std::printf("%-*s  %3.0f s, vehicle %s: %s\n", static_cast<int>(width), name.c_str(), s.duration_s,
                s.vehicle.c_str(), s.about.c_str());
  }
  return EXIT_SUCCESS;
}

std::string shipped_names() {
  std::string names;
  for (const std::string& name : simulator::scenario_names()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

/// The vehicle that was asked for, or the one the scenario is meant for.
VehicleConfig vehicle_of(const Options& options, const simulator::Scenario& scenario) {
  if (!options.vehicle.empty()) return config::read_vehicle_file(options.vehicle);
  const auto file = std::filesystem::path(options.config) / "vehicle" / (scenario.vehicle + ".toml");
  if (scenario.vehicle.empty() || !std::filesystem::exists(file)) {
    throw config::Error("no vehicle file " + file.string() + "; name one by --vehicle, or its folder by --config");
  }
  return config::read_vehicle_file(file);
}

int simulate(const Options& options) {
  if (options.list) return list();
  if (options.out.empty())
    throw std::invalid_argument("--out is required: the folder for the recordings and the truth");
  if (!options.alignment.road.empty()) return simulate_alignment(options);
  const Stopwatch watch;
  const simulator::Scenario scenario = simulator::scenario(options.scenario);
  const VehicleConfig vehicle = vehicle_of(options, scenario);
  const double duration_s = options.duration_s > 0.0 ? options.duration_s : scenario.duration_s;
  terminal::ProgressBar bar("simulating");
  const simulator::DriveFiles files =
      simulator::write_drive(scenario, vehicle, options.seed, duration_s, options.out, [&bar](double share) {
        if (bar.is_due()) bar.show(share);
      });
  bar.wipe();
  watch.tell(duration_s, files.scans, files.number_of_detections);
  for (const auto& file :
       {files.radars, files.ego, files.truth, files.detections, files.objects, files.sensors, files.visibility}) {
    std::printf("  %s\n", file.c_str());
  }
  return EXIT_SUCCESS;
}

}  // namespace

void add_simulate_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand("simulate", "simulate a drive and write it as recordings with truth");
  CLI::Option* const scenario = command
                                    ->add_option("--scenario", options->scenario,
                                                 "what to drive: a scenario file (TOML), or one of " + shipped_names())
                                    ->capture_default_str();
  command->add_option(
      "--vehicle", options->vehicle,
      "vehicle file (TOML); else the one the scenario names, or four corner radars for an alignment drive");
  command->add_option("--config", options->config, "folder of vehicle/, where the scenario's vehicle is looked for")
      ->capture_default_str();
  CLI::Option* const out = command->add_option(
      "--out", options->out,
      "folder for the recordings and the truth, made if absent; files of an earlier run in it are replaced");
  command->add_flag("--list", options->list, "tells the shipped scenarios and what each of them shows")
      ->excludes(scenario)
      ->excludes(out);
  command->add_option("--seed", options->seed, "another seed is another drive")
      ->capture_default_str()
      ->check(kUnsigned);
  command
      ->add_option("--duration", options->duration_s,
                   "seconds; else as long as the scenario, or 45 s of an alignment drive")
      ->check(CLI::Range(0.1, 36000.0))
      ->check(kFinite);
  CLI::Option* const alignment = add_alignment_drive_options(*command, options->alignment);
  alignment->excludes(scenario);
  command->callback([options, &exit_code] {
    try {
      exit_code = simulate(*options);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "boresight simulate: %s\n", error.what());
      const bool wrong_input = dynamic_cast<const config::Error*>(&error) != nullptr ||
                               dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
      exit_code = wrong_input ? 2 : EXIT_FAILURE;
    }
  });
}

}  // namespace boresight
