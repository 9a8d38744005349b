// `boresight simulate`: a drive with truth, as recordings.
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>

#include "services/boresight/commands/alignment_drive_options.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "tests/simulator/alignment/csv_writer.hpp"
#include "tests/simulator/drive_writer.hpp"

namespace boresight {

namespace {

struct Options {
  std::string scenario = "demo_drive";
  std::string vehicle;
  std::string out;
  std::uint64_t seed = 1;
  double duration_s = 45.0;
  AlignmentDriveOptions alignment;
};

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
  std::optional<VehicleConfig> vehicle;
  if (!options.vehicle.empty()) vehicle = config::read_vehicle_file(options.vehicle);
  const simulator::AlignmentSpec spec =
      alignment_spec(options.alignment, vehicle ? &*vehicle : nullptr, options.seed, options.duration_s);
  terminal::ProgressBar bar("simulating");
  const simulator::AlignmentFiles files = simulator::write_alignment_drive(spec, options.out, [&bar](double share) {
    if (bar.is_due()) bar.show(share);
  });
  bar.wipe();
  watch.tell(options.duration_s, files.scans, files.detections);
  for (const auto& file : {files.drive, files.ego, files.vehicle, files.truth}) std::printf("  %s\n", file.c_str());
  return EXIT_SUCCESS;
}

int simulate(const Options& options) {
  if (!options.alignment.road.empty()) return simulate_alignment(options);
  const Stopwatch watch;
  terminal::ProgressBar bar("simulating");
  const VehicleConfig vehicle = config::read_vehicle_file(options.vehicle);
  const simulator::DriveFiles files =
      simulator::write_drive(simulator::scenario(options.scenario), vehicle, options.seed, options.duration_s,
                             options.out, [&bar](double share) {
                               if (bar.is_due()) bar.show(share);
                             });
  bar.wipe();
  watch.tell(options.duration_s, files.scans, files.number_of_detections);
  for (const auto& file : {files.radars, files.ego, files.truth, files.detections, files.objects}) {
    std::printf("  %s\n", file.c_str());
  }
  return EXIT_SUCCESS;
}

}  // namespace

void add_simulate_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand("simulate", "simulate a drive and write it as recordings with truth");
  CLI::Option* const scenario = command->add_option("--scenario", options->scenario, "what to drive")
                                    ->check(CLI::IsMember(simulator::scenario_names()))
                                    ->capture_default_str();
  command->add_option("--vehicle", options->vehicle,
                      "vehicle file (TOML); for an alignment drive four corner radars if not given");
  command->add_option("--out", options->out, "folder for the recordings and the truth")->required();
  command->add_option("--seed", options->seed, "another seed is another drive")->capture_default_str();
  command->add_option("--duration", options->duration_s, "seconds")
      ->check(CLI::Range(0.1, 36000.0))
      ->capture_default_str();
  CLI::Option* const alignment = add_alignment_drive_options(*command, options->alignment);
  alignment->excludes(scenario);
  command->callback([options, &exit_code] {
    if (options->alignment.road.empty() && options->vehicle.empty()) throw CLI::RequiredError("--vehicle");
    try {
      exit_code = simulate(*options);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "boresight simulate: %s\n", error.what());
      exit_code = dynamic_cast<const config::Error*>(&error) != nullptr ? 2 : EXIT_FAILURE;
    }
  });
}

}  // namespace boresight
