// `boresight calibrate`: static calibrations from tables and recordings, by the core that the service runs.
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/calibrate/plate_csv.hpp"
#include "services/boresight/calibrate/plate_feed.hpp"
#include "services/boresight/calibrate/plate_report.hpp"
#include "services/boresight/calibrate/reflectors_csv.hpp"
#include "services/boresight/calibrate/reflectors_report.hpp"
#include "services/boresight/calibrate/state_file.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/input/play.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"

namespace boresight {

namespace {

namespace plate = alignment::plate;
namespace reflectors = alignment::reflectors;

/// Options of both calibrations.
struct CalibrateOptions {
  const CLI::App* command = nullptr;
  std::string table, json, plot, state;
  runtime::Configuration configuration;
  std::uint32_t radar = 0;

  [[nodiscard]] bool has_vehicle() const { return !configuration.vehicle_name.empty(); }
  void tell(const std::string& text) const { report_problem(*command, text); }
};

struct PlateOptions : CalibrateOptions {
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

struct ReflectorOptions : CalibrateOptions {
  reflectors::Config config;
};

/// A table with any bad line is rejected: a wrong calibration at the end of the line would stay in the vehicle.
void demand_all_lines(const std::string& file, const input::Problems& problems) {
  if (problems.lines() == 0) throw std::runtime_error(file + ": there is no measurement in it");
  if (problems.bad_lines() == 0) return;
  throw std::runtime_error(fmt::format("{}: {} of {} lines cannot be used; correct them or take them out", file,
                                       problems.bad_lines(), problems.lines()));
}

input::Problems printed_problems() {
  return input::Problems([](const std::string& problem) { std::fprintf(stderr, "%s\n", problem.c_str()); });
}

const RadarConfig& radar_of(const VehicleConfig& vehicle, const CalibrateOptions& options) {
  if (const RadarConfig* const radar = vehicle.radar(options.radar)) return *radar;
  std::string known;
  for (const RadarConfig& radar : vehicle.radars) known += fmt::format("{}{}", known.empty() ? "" : ", ", radar.id);
  throw UsageError(
      fmt::format("--radar {}: {} has the radars {}", options.radar, options.configuration.vehicle_name, known));
}

void keep_seed(const CalibrateOptions& options, const VehicleConfig& vehicle, const alignment::RotationSeed& seed) {
  if (options.state.empty()) return;
  const std::string note = calibrate::seed_state_file(options.state, vehicle, seed);
  if (!note.empty()) options.tell(note);
}

void check_calibrate_options(const CalibrateOptions& options) {
  if (options.json == "-" && options.plot == "-") throw UsageError("only one result can go to standard output");
  if (options.has_vehicle() && options.radar == 0) throw UsageError("--vehicle needs --radar");
  if (!options.has_vehicle() && options.radar != 0) throw UsageError("--radar needs --vehicle");
  if (!options.state.empty() && !options.has_vehicle()) throw UsageError("--state needs --vehicle and --radar");
}

/// Standard output is for one result.
void print_table(const CalibrateOptions& options, const std::string& table) {
  if (options.json == "-" || options.plot == "-") return;
  terminal::print(table);
}

plate::Measurements read_plate_table(const std::string& file) {
  input::Problems problems = printed_problems();
  recording::ByteSource source(file);
  const plate::Measurements measurements = calibrate::read_plate(source, problems);
  demand_all_lines(file, problems);
  return measurements;
}

/// The radar's detections of the plate during the intervals of the table of tilts.
plate::Measurements read_plate_recording(const PlateOptions& options, const VehicleConfig& vehicle,
                                         const RadarConfig& radar) {
  input::Problems problems = printed_problems();
  recording::ByteSource source(options.tilts);
  const std::vector<calibrate::TiltInterval> intervals = calibrate::read_tilts(source, problems);
  demand_all_lines(options.tilts, problems);
  plate::PlateWindow window = options.window;
  window.azimuth_half_width_rad = options.azimuth_half_width_deg / kDegreesPerRadian;
  calibrate::PlateFeed feed(radar.id, intervals, window);
  ingest::Gateway gateway(vehicle, feed, ingest::read_mappings(vehicle));
  input::Problems unreadable = printed_problems();
  input::play({options.recordings.begin(), options.recordings.end()}, gateway, unreadable,
              [](const auto&) { stop_if_interrupted(); });
  stop_if_interrupted();
  if (unreadable.bad_lines() > 0) options.tell(fmt::format("{} frames could not be read", unreadable.bad_lines()));
  if (feed.rejected() > 0) {
    options.tell(
        fmt::format("{} messages were rejected; `boresight decode --check` lists the reasons", feed.rejected()));
  }
  if (feed.scans() == 0) {
    throw std::runtime_error(fmt::format("radar {} {} has no scan in the recording", radar.id, radar.name));
  }
  if (feed.within() == 0) {
    throw std::runtime_error(
        fmt::format("no scan within the times of {}: those of radar {} {} are from {:.3f} to {:.3f} s", options.tilts,
                    radar.id, radar.name, feed.first_s(), feed.last_s()));
  }
  if (feed.doubtful() > 0) options.tell(fmt::format("{} scans of doubtful integrity were rejected", feed.doubtful()));
  if (feed.without_plate() > 0) {
    options.tell(
        fmt::format("{} of {} scans at the tilts do not show the plate: no stationary detection {:g} … {:g} m ahead",
                    feed.without_plate(), feed.within(), window.range_min_m, window.range_max_m));
  }
  return feed.measurements();
}

void check_plate_source(const PlateOptions& options) {
  const bool is_recorded = !options.recordings.empty();
  if (is_recorded == !options.table.empty()) throw UsageError("give either --table, or --recording and --tilts");
  if (is_recorded == options.tilts.empty()) throw UsageError("--recording and --tilts need each other");
  if (is_recorded && !options.has_vehicle()) throw UsageError("--recording needs --vehicle and --radar");
}

int run_plate(const PlateOptions& options) {
  check_calibrate_options(options);
  check_plate_source(options);
  const bool is_recorded = !options.recordings.empty();
  VehicleConfig vehicle;
  const RadarConfig* radar = nullptr;
  if (options.has_vehicle()) {
    vehicle = options.configuration.vehicle(is_recorded ? config::VehicleUse::kLive : config::VehicleUse::kOffline);
    radar = &radar_of(vehicle, options);
  }
  const auto run = std::make_unique<calibrate::PlateRun>();
  run->tool_version = BORESIGHT_VERSION;
  run->source = is_recorded ? fmt::format("{}", fmt::join(options.recordings, ", ")) : options.table;
  run->config = options.fit;
  run->config.method = options.method == "robust" ? plate::FitMethod::kRobust : plate::FitMethod::kPublished;
  run->config.consistency_rad = options.consistency_deg / kDegreesPerRadian;
  run->measurements = is_recorded ? read_plate_recording(options, vehicle, *radar) : read_plate_table(options.table);
  run->result = plate::evaluate(run->measurements, run->config);
  const plate::PlateResult& result = run->result;
  alignment::RotationSeed seed;
  if (result.ok() && radar != nullptr) {
    alignment::SeedConfig config = options.seed;
    config.placement_yaw_std_rad = options.placement_yaw_std_deg / kDegreesPerRadian;
    config.placement_pitch_std_rad = options.placement_pitch_std_deg / kDegreesPerRadian;
    if (!alignment::seed_from_plate(*radar, result.yaw_rad, result.yaw_std_rad, result.pitch_rad, result.pitch_std_rad,
                                    config, seed)) {
      throw UsageError(fmt::format("radar {} {} is mounted on its side: the tilting plate cannot measure its yaw",
                                   radar->id, radar->name));
    }
    run->seed = seed;
  }
  stop_if_interrupted();
  if (!options.json.empty()) terminal::write_file(options.json, calibrate::to_json(*run));
  if (!options.plot.empty()) terminal::write_file(options.plot, calibrate::to_svg(*run));
  if (run->seed) keep_seed(options, vehicle, seed);
  print_table(options, calibrate::to_table(*run));
  if (result.ok()) return exit_code::kSuccess;
  options.tell(fmt::format("{}: the run failed: {}", run->source, plate::explain(result.failure)));
  return exit_code::kFinding;
}

int run_reflectors(const ReflectorOptions& options) {
  check_calibrate_options(options);
  const VehicleConfig vehicle = options.configuration.vehicle(config::VehicleUse::kOffline);
  calibrate::ReflectorRun run;
  run.tool_version = BORESIGHT_VERSION;
  run.source = options.table;
  run.radar = radar_of(vehicle, options);
  run.config = options.config;
  input::Problems problems = printed_problems();
  recording::ByteSource source(options.table);
  run.table = calibrate::read_reflectors(source, problems);
  demand_all_lines(options.table, problems);
  run.config.has_elevation = run.table.has_elevation;
  run.result = reflectors::fit_directions(run.table.positions, run.radar, run.config);
  run.line = reflectors::fit_line(run.table.positions, run.radar, run.config);
  stop_if_interrupted();
  if (!options.json.empty()) terminal::write_file(options.json, calibrate::to_json(run));
  if (run.result.ok()) keep_seed(options, vehicle, run.result.rotation);
  print_table(options, calibrate::to_table(run));
  if (run.result.ok()) return exit_code::kSuccess;
  options.tell(calibrate::problem_of(run, run.result.problem, run.result.problem_position));
  return exit_code::kFinding;
}

void add_calibrate_options(CLI::App& command, CalibrateOptions& options, bool needs_vehicle) {
  options.command = &command;
  CLI::Option* const vehicle = runtime::add_vehicle_option(
      command, options.configuration,
      "Vehicle with the radar's nominal mounting: a name in the folder vehicle/, or a file");
  runtime::add_config_option(command, options.configuration);
  CLI::Option* const radar =
      command.add_option("--radar", options.radar, "Id of the radar in the vehicle file")->check(CLI::Range(1u, 16u));
  if (needs_vehicle) {
    vehicle->required();
    radar->required();
  }
  add_json_option(command, options.json, "Result as JSON; without FILE, or with \"-\": to standard output");
  command
      .add_option("--state", options.state,
                  "Memory file of the alignment estimator that receives the result; stop the service first")
      ->type_name("FILE");
  // The input was called --csv, which means output in CSV everywhere else.
  command
      .add_option_function<std::string>(
          "--csv", [](const std::string&) { throw CLI::ValidationError("--csv", "is called --table now"); })
      ->group("");
}

void add_plate(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "plate", "Estimates a radar's yaw and pitch error from scans of a tilting plate at known tilts.");
  const auto options = std::make_shared<PlateOptions>();
  command
      ->add_option(
          "--table", options->table,
          "Table with a row for each scan: tilt_deg (positive = toward the ground), amplitude_db, azimuth_deg; "
          "\"-\": standard input")
      ->type_name("FILE");
  command
      ->add_option("--recording", options->recordings,
                   "Instead of --table: pcap, pcapng or candump log of the radar; repeatable")
      ->type_name("FILE");
  command
      ->add_option("--tilts", options->tilts,
                   "Table for --recording with a row for each tilt: tilt_deg, begin_s, end_s (the recording's stamps)")
      ->type_name("FILE");
  const auto number = [command](const char* name, double& value, const char* unit, const char* about, double low,
                                double high) {
    command->add_option(name, value, about)->check(CLI::Range(low, high))->type_name(unit)->capture_default_str();
  };
  number("--range-min", options->window.range_min_m, "M",
         "For --recording: the plate is the strongest stationary detection from this range, m", 0.0, 100.0);
  number("--range-max", options->window.range_max_m, "M", "… to this range, m", 0.0, 100.0);
  number("--azimuth-half-width", options->azimuth_half_width_deg, "DEG", "… and within ± this azimuth, deg", 0.1, 90.0);
  command->add_option("--method", options->method, "Fit of the parabola")
      ->check(CLI::IsMember({"robust", "published"}))
      ->capture_default_str();
  command->add_option("--plot", options->plot, "Plot (SVG) of the amplitudes and the parabola; \"-\": standard output")
      ->type_name("FILE");
  number("--min-amplitude", options->fit.min_amplitude_db, "DB",
         "Lowest allowed maximum of the parabola, dB: a bumper attenuates", -200.0, 200.0);
  command->add_option("--min-tilts", options->fit.min_tilts, "Fewest tilts; the robust fit must also use so many")
      ->check(CLI::Range(plate::kFewestTilts, plate::kMaxTilts))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--triples", options->fit.triples, "Random triples of tilts for the self-consistency")
      ->check(CLI::Range(std::size_t{1}, plate::kMaxTriples))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--seed", options->fit.seed, "Random seed of the triples")->type_name("N")->capture_default_str();
  number("--consistency", options->consistency_deg, "DEG",
         "Largest pitch difference, deg, at which a triple still agrees with the fit", 0.01, 5.0);
  number("--placement-yaw-std", options->placement_yaw_std_deg, "DEG",
         "Standard deviation of the yaw between plate and vehicle, deg", 0.0, 5.0);
  number("--placement-pitch-std", options->placement_pitch_std_deg, "DEG",
         "Standard deviation of the pitch between plate and vehicle, deg", 0.0, 5.0);
  add_calibrate_options(*command, *options, false);
  on_call(
      *command, exit_code,
      {"calibrate plate --table run.csv --json result.json\n"
       "calibrate plate --recording plate.pcap --tilts tilts.csv --vehicle demo --radar 2",
       "the calibration is good",
       "the run failed: no maximum over the tilt, too few tilts or scans, or a maximum below the limit"},
      [options] { return run_plate(*options); }, &options->configuration);
}

void add_reflectors(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "reflectors", "Estimates a radar's mounting error from ten or more corner reflectors at surveyed positions.");
  const auto options = std::make_shared<ReflectorOptions>();
  command
      ->add_option("--table", options->table,
                   "Table with a row for each reflector, or each scan of it: x_m, y_m, z_m (surveyed, vehicle frame), "
                   "range_m, azimuth_deg, elevation_deg (if measured; sensor frame); \"-\": standard input")
      ->type_name("FILE")
      ->required();
  const auto metres = [command](const char* name, double& value, const char* about, double low, double high) {
    command->add_option(name, value, about)->check(CLI::Range(low, high))->type_name("M")->capture_default_str();
  };
  metres("--survey-std", options->config.survey_std_m, "Standard deviation of a surveyed position along x and y, m",
         0.0, 1.0);
  metres("--height-std", options->config.height_std_m, "Standard deviation of a surveyed height, m", 0.0, 1.0);
  metres("--mounting-std", options->config.mounting_std_m,
         "Standard deviation of the radar's own position along each axis, m", 0.0, 1.0);
  metres("--range-gate", options->config.range_gate_m, "Largest difference between measured and surveyed range, m",
         0.01, 10.0);
  add_calibrate_options(*command, *options, true);
  on_call(
      *command, exit_code,
      {"calibrate reflectors --table field.csv --vehicle demo --radar 1", "the calibration is good",
       "the run failed: too few reflectors, one out of range or out of view, or too few that agree"},
      [options] { return run_reflectors(*options); }, &options->configuration);
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "calibrate", "Estimates a radar's mounting error from a measurement with the vehicle at standstill.");
  command->require_subcommand(1);
  command->footer("'boresight calibrate plate --help' and 'boresight calibrate reflectors --help' list the options.");
  add_plate(*command, exit_code);
  add_reflectors(*command, exit_code);
}

}  // namespace boresight
