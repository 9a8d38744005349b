// `boresight calibrate`: static calibrations from tables and recordings, by the core that the service runs.
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "services/boresight/align/play.hpp"
#include "services/boresight/calibrate/plate_csv.hpp"
#include "services/boresight/calibrate/plate_feed.hpp"
#include "services/boresight/calibrate/plate_report.hpp"
#include "services/boresight/calibrate/reflectors_csv.hpp"
#include "services/boresight/calibrate/reflectors_report.hpp"
#include "services/boresight/calibrate/state_file.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"

namespace boresight {

namespace {

namespace plate = alignment::plate;
namespace reflectors = alignment::reflectors;

constexpr int kExitUsage = 2;
constexpr double kDegrees = 180.0 / M_PI;

/// A command line that contradicts itself.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What both calibrations take.
struct Common {
  std::string csv, json, plot, vehicle, state;
  std::uint32_t radar = 0;
};

struct PlateOptions : Common {
  std::vector<std::string> recordings;
  std::string tilts;
  plate::PlateWindow window;
  double azimuth_half_width_deg = 8.0;
  std::string method = "robust";
  plate::FitConfig fit;
  alignment::SeedConfig seed;
  double consistency_deg = 0.3;
  double placement_yaw_std_deg = 0.05, placement_pitch_std_deg = 0.05;
};

struct ReflectorOptions : Common {
  reflectors::Config config;
};

void write_file(const std::string& file, const std::string& text) {
  std::FILE* const stream = file == "-" ? stdout : std::fopen(file.c_str(), "we");
  const bool written =
      stream != nullptr && std::fwrite(text.data(), 1, text.size(), stream) == text.size() && std::fflush(stream) == 0;
  const int error = errno;
  if (stream != nullptr && stream != stdout) std::fclose(stream);
  if (!written) throw std::runtime_error(file + ": " + std::strerror(error));
}

void tell(const std::string& text) {
  std::fprintf(stderr, "boresight calibrate: %s\n", text.c_str());
}

/// Only a table without any fault is calibrated from: there is one chance at the end of the line to see it.
void demand_all_lines(const std::string& file, const align::Problems& problems) {
  if (problems.lines() == 0) throw std::runtime_error(file + ": there is no measurement in it");
  if (problems.bad_lines() == 0) return;
  throw std::runtime_error(fmt::format("{}: {} of {} lines cannot be used; correct them or take them out", file,
                                       problems.bad_lines(), problems.lines()));
}

align::Problems told_problems() {
  return align::Problems([](const std::string& problem) { std::fprintf(stderr, "%s\n", problem.c_str()); });
}

const RadarConfig& radar_of(const VehicleConfig& vehicle, const Common& options) {
  if (const RadarConfig* const radar = vehicle.radar(options.radar)) return *radar;
  std::string known;
  for (const RadarConfig& radar : vehicle.radars) known += fmt::format("{}{}", known.empty() ? "" : ", ", radar.id);
  throw UsageError(fmt::format("--radar {}: {} has the radars {}", options.radar, options.vehicle, known));
}

void keep_seed(const Common& options, const VehicleConfig& vehicle, const alignment::RotationSeed& seed) {
  if (options.state.empty()) return;
  const std::string news = calibrate::seed_state_file(options.state, vehicle, seed);
  if (!news.empty()) tell(news);
}

void check(const Common& options) {
  if (options.json == "-" && options.plot == "-") throw UsageError("only one result can go to standard output");
  if (!options.vehicle.empty() && options.radar == 0) throw UsageError("--vehicle needs --radar");
  if (options.vehicle.empty() && options.radar != 0) throw UsageError("--radar needs --vehicle");
  if (!options.state.empty() && options.vehicle.empty()) throw UsageError("--state needs --vehicle and --radar");
}

/// Standard output is for one thing.
void print_table(const Common& options, const std::string& table) {
  if (options.json == "-" || options.plot == "-") return;
  std::fputs(table.c_str(), stdout);
  if (std::fflush(stdout) != 0) throw std::runtime_error(std::string("standard output: ") + std::strerror(errno));
}

plate::Measurements read_plate_table(const std::string& file) {
  align::Problems problems = told_problems();
  recording::ByteSource source(file);
  const plate::Measurements measurements = calibrate::read_plate(source, problems);
  demand_all_lines(file, problems);
  return measurements;
}

/// What the radar saw of the plate while it stood at the tilts of the table.
plate::Measurements read_plate_recording(const PlateOptions& options, const VehicleConfig& vehicle,
                                         const RadarConfig& radar) {
  align::Problems problems = told_problems();
  recording::ByteSource source(options.tilts);
  const std::vector<calibrate::TiltInterval> intervals = calibrate::read_tilts(source, problems);
  demand_all_lines(options.tilts, problems);
  plate::PlateWindow window = options.window;
  window.azimuth_half_width_rad = options.azimuth_half_width_deg / kDegrees;
  calibrate::PlateFeed feed(radar.id, intervals, window);
  ingest::Gateway gateway(vehicle, feed, ingest::read_mappings(vehicle));
  align::Problems unreadable = told_problems();
  align::play({options.recordings.begin(), options.recordings.end()}, gateway, unreadable, [](const auto&) {});
  if (unreadable.bad_lines() > 0) tell(fmt::format("{} frames could not be read", unreadable.bad_lines()));
  if (feed.rejected() > 0) {
    tell(fmt::format("{} messages were rejected; `boresight decode --check` tells why", feed.rejected()));
  }
  if (feed.scans() == 0) {
    throw std::runtime_error(fmt::format("radar {} {} has no scan in the recording", radar.id, radar.name));
  }
  if (feed.within() == 0) {
    throw std::runtime_error(
        fmt::format("no scan within the times of {}: those of radar {} {} are from {:.3f} to {:.3f} s", options.tilts,
                    radar.id, radar.name, feed.first_s(), feed.last_s()));
  }
  if (feed.doubtful() > 0) tell(fmt::format("{} scans of doubtful integrity were left out", feed.doubtful()));
  if (feed.without_plate() > 0) {
    tell(fmt::format("{} of {} scans at the tilts do not show the plate: nothing stands still {:g} … {:g} m ahead",
                     feed.without_plate(), feed.within(), window.range_min_m, window.range_max_m));
  }
  return feed.measurements();
}

void check_source(const PlateOptions& options) {
  const bool is_recorded = !options.recordings.empty();
  if (is_recorded == !options.csv.empty()) throw UsageError("give either --csv, or --recording and --tilts");
  if (is_recorded == options.tilts.empty()) throw UsageError("--recording and --tilts need one another");
  if (is_recorded && options.vehicle.empty()) throw UsageError("--recording needs --vehicle and --radar");
}

int run_plate(const PlateOptions& options) {
  check(options);
  check_source(options);
  const bool is_recorded = !options.recordings.empty();
  VehicleConfig vehicle;
  const RadarConfig* radar = nullptr;
  if (!options.vehicle.empty()) {
    vehicle = config::read_vehicle_file(options.vehicle,
                                        is_recorded ? config::VehicleUse::kLive : config::VehicleUse::kOffline);
    radar = &radar_of(vehicle, options);
  }
  const auto run = std::make_unique<calibrate::PlateRun>();
  run->tool_version = BORESIGHT_VERSION;
  run->source = is_recorded ? fmt::format("{}", fmt::join(options.recordings, ", ")) : options.csv;
  run->config = options.fit;
  run->config.method = options.method == "robust" ? plate::FitMethod::kRobust : plate::FitMethod::kPublished;
  run->config.consistency_rad = options.consistency_deg / kDegrees;
  run->measurements = is_recorded ? read_plate_recording(options, vehicle, *radar) : read_plate_table(options.csv);
  run->result = plate::evaluate(run->measurements, run->config);
  const plate::PlateResult& result = run->result;
  alignment::RotationSeed seed;
  if (result.ok() && radar != nullptr) {
    alignment::SeedConfig config = options.seed;
    config.placement_yaw_std_rad = options.placement_yaw_std_deg / kDegrees;
    config.placement_pitch_std_rad = options.placement_pitch_std_deg / kDegrees;
    if (!alignment::seed_from_plate(*radar, result.yaw_rad, result.yaw_std_rad, result.pitch_rad, result.pitch_std_rad,
                                    config, seed)) {
      throw std::runtime_error(
          fmt::format("radar {} {} lies on its side: a plate does not tell its yaw", radar->id, radar->name));
    }
    run->seed = seed;
  }
  if (!options.json.empty()) write_file(options.json, calibrate::to_json(*run));
  if (!options.plot.empty()) write_file(options.plot, calibrate::to_svg(*run));
  print_table(options, calibrate::to_table(*run));
  if (!result.ok()) {
    tell(fmt::format("{}: the run failed: {}", run->source, plate::explain(result.failure)));
    return EXIT_FAILURE;
  }
  if (run->seed) keep_seed(options, vehicle, seed);
  return EXIT_SUCCESS;
}

int run_reflectors(const ReflectorOptions& options) {
  check(options);
  const VehicleConfig vehicle = config::read_vehicle_file(options.vehicle, config::VehicleUse::kOffline);
  calibrate::ReflectorRun run;
  run.tool_version = BORESIGHT_VERSION;
  run.source = options.csv;
  run.radar = radar_of(vehicle, options);
  run.config = options.config;
  align::Problems problems = told_problems();
  recording::ByteSource source(options.csv);
  run.table = calibrate::read_reflectors(source, problems);
  demand_all_lines(options.csv, problems);
  run.config.has_elevation = run.table.has_elevation;
  run.result = reflectors::fit_directions(run.table.positions, run.radar, run.config);
  run.line = reflectors::fit_line(run.table.positions, run.radar, run.config);
  if (!options.json.empty()) write_file(options.json, calibrate::to_json(run));
  print_table(options, calibrate::to_table(run));
  if (!run.result.ok()) {
    tell(calibrate::problem_of(run, run.result.problem, run.result.problem_position));
    return EXIT_FAILURE;
  }
  keep_seed(options, vehicle, run.result.rotation);
  return EXIT_SUCCESS;
}

void add_common(CLI::App& command, Common& options, bool needs_vehicle) {
  CLI::Option* const vehicle =
      command.add_option("--vehicle", options.vehicle, "vehicle file with the radar's mounting; links may be left out");
  CLI::Option* const radar =
      command.add_option("--radar", options.radar, "id of the radar")->check(CLI::Range(1u, 16u));
  if (needs_vehicle) {
    vehicle->required();
    radar->required();
  }
  command.add_option("--json", options.json, "file for the result; \"-\" is standard output");
  command.add_option("--state", options.state,
                     "alignment estimator's memory file to put the result in; not while the service runs");
  command.footer(
      "Exit codes: 0 good, 1 the run failed or something could not be read or written, 2 wrong command line or\n"
      "configuration.");
}

template <typename Run>
void on_call(CLI::App& command, int& exit_code, Run run) {
  command.callback([run, &exit_code] {
    try {
      exit_code = run();
    } catch (const std::exception& error) {
      tell(error.what());
      const bool usage =
          dynamic_cast<const UsageError*>(&error) != nullptr || dynamic_cast<const config::Error*>(&error) != nullptr;
      exit_code = usage ? kExitUsage : EXIT_FAILURE;
    }
  });
}

void add_plate(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "plate", "yaw and pitch error from a tilting plate: amplitude and azimuth of scans at known tilts");
  const auto options = std::make_shared<PlateOptions>();
  command->add_option(
      "--csv", options->csv,
      "a row a scan: tilt_deg (positive = toward the ground), amplitude_db, azimuth_deg; \"-\" is standard input");
  command->add_option("--recording", options->recordings,
                      "instead: pcap, pcapng or candump log of the radar, as the vehicle's link has it; repeatable");
  command->add_option("--tilts", options->tilts,
                      "for it, a row a tilt: tilt_deg, begin_s, end_s (by the recording's stamps)");
  command->add_option("--range-min", options->window.range_min_m, "of it: the plate is the strongest thing at rest, m")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("--range-max", options->window.range_max_m, "… within these ranges, m")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("--azimuth-half-width", options->azimuth_half_width_deg, "… and this about straight ahead, deg")
      ->check(CLI::Range(0.1, 90.0))
      ->capture_default_str();
  command->add_option("--method", options->method, "robust, or published (Burza 2025)")
      ->check(CLI::IsMember({"robust", "published"}))
      ->capture_default_str();
  command->add_option("--plot", options->plot, "SVG of the amplitudes and the parabola; \"-\" is standard output");
  command->add_option("--min-amplitude", options->fit.min_amplitude_db, "limit of the fitted maximum, dB (bumper)")
      ->check(CLI::Range(-200.0, 200.0))
      ->capture_default_str();
  command->add_option("--min-tilts", options->fit.min_tilts, "tilts that there must be and, robust, that must agree")
      ->check(CLI::Range(plate::kFewestTilts, plate::kMaxTilts))
      ->capture_default_str();
  command->add_option("--triples", options->fit.triples, "random triples of tilts for the self-consistency")
      ->check(CLI::Range(std::size_t{1}, plate::kMaxTriples))
      ->capture_default_str();
  command->add_option("--seed", options->fit.seed, "of their choice")->capture_default_str();
  command->add_option("--consistency", options->consistency_deg, "degrees by which a triple may miss and still agree")
      ->check(CLI::Range(0.01, 5.0))
      ->capture_default_str();
  command->add_option("--placement-yaw-std", options->placement_yaw_std_deg, "how well plate and car stand, degrees")
      ->check(CLI::Range(0.0, 5.0))
      ->capture_default_str();
  command->add_option("--placement-pitch-std", options->placement_pitch_std_deg, "the same of their level, degrees")
      ->check(CLI::Range(0.0, 5.0))
      ->capture_default_str();
  add_common(*command, *options, false);
  on_call(*command, exit_code, [options] { return run_plate(*options); });
}

void add_reflectors(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("reflectors", "mounting error from corner reflectors at surveyed positions, ten or more");
  const auto options = std::make_shared<ReflectorOptions>();
  command
      ->add_option("--csv", options->csv,
                   "a row a reflector or a scan of it: x_m, y_m, z_m (surveyed, vehicle frame), range_m, azimuth_deg, "
                   "elevation_deg (if measured; sensor frame); \"-\" is standard input")
      ->required();
  command->add_option("--survey-std", options->config.survey_std_m, "of a position along x and y, m")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--height-std", options->config.height_std_m, "of a position's height, m")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--mounting-std", options->config.mounting_std_m, "of the radar's own place along each axis, m")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--range-gate", options->config.range_gate_m, "m by which a range may miss the surveyed one")
      ->check(CLI::Range(0.01, 10.0))
      ->capture_default_str();
  add_common(*command, *options, true);
  on_call(*command, exit_code, [options] { return run_reflectors(*options); });
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("calibrate", "how a radar is mounted, from a measurement of the standing car");
  command->require_subcommand(1);
  add_plate(*command, exit_code);
  add_reflectors(*command, exit_code);
}

}  // namespace boresight
