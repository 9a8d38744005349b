// `boresight track`: a tracker over the measurements of a simulated scenario, or a filter over those of one object.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/commands/track_filter.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/boresight/track/estimates.hpp"
#include "services/boresight/track/measurement_table.hpp"
#include "services/boresight/track/scenario_file.hpp"
#include "services/boresight/track/tracker_run.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/tracker/core/make_tracker.hpp"

namespace boresight {

namespace {

struct TrackOptions {
  std::string measurements, parameters, out;
  std::string tracker = "pmbm";
  std::size_t passes = 1;
  TrackFilterOptions filter;
};

void check_range_rates(const TrackOptions& options, bool has_parameter, bool has_column) {
  if (has_column && !has_parameter) {
    throw UsageError(fmt::format("{} has range rates, and {} lacks their keys range_rate_std and range_rate_span",
                                 options.measurements, options.parameters));
  }
  if (has_parameter && !has_column) {
    throw UsageError(fmt::format("{} has the key range_rate_std, and {} lacks the column range_rate",
                                 options.parameters, options.measurements));
  }
}

int run_track(const TrackOptions& options, const CLI::App& command) {
  if (tracking::filters::filter_kind(options.tracker)) {
    if (!options.parameters.empty()) throw UsageError("--params is an option of pmbm and phd, not of filters");
    return run_track_filter(options.tracker, options.measurements, options.out, options.passes, options.filter);
  }
  options.filter.refuse_for(options.tracker);
  if (options.parameters.empty()) throw UsageError("--params is required for the tracker " + options.tracker);
  const track::ScenarioFile scenario = track::read_scenario_file(options.parameters);
  const track::MeasurementTable table = track::read_measurements(options.measurements, scenario.number_of_scans);
  check_range_rates(options, scenario.model.range_rate_std_mps > 0.0, table.has_range_rates);
  const auto make = [&] { return tracking::make_scenario_tracker(options.tracker, scenario.model); };
  const track::TrackerRun run = track::run_tracker(make, table.scans, scenario.model.step_s, options.passes,
                                                   runtime::thread_cpu_time_ns, stop_if_interrupted);
  terminal::write_file(options.out, track::estimates_csv(run.estimates));

  if (options.out != "-") {
    const std::string least =
        options.passes > 1 ? fmt::format(", of each scan the least of {} passes", options.passes) : "";
    terminal::print(fmt::format("{}: {} scans, {} estimates; CPU time a scan: mean {:.3f} ms, worst {:.3f} ms{}\n",
                                options.tracker, table.scans.size(), track::number_of_objects(run.estimates),
                                run.mean_cpu_ms(), run.worst_cpu_ms(), least));
  }
  if (run.budget_reached > 0) {
    report_problem(command, fmt::format("the work budget ended the search in {} scans", run.budget_reached));
  }
  if (run.gates_cut > 0) {
    report_problem(command, fmt::format("crowds were associated in parts in {} scans", run.gates_cut));
  }
  if (run.dropped_detections + run.dropped_objects > 0) {
    report_problem(command, fmt::format("{} detections and {} objects were dropped for want of capacity",
                                        run.dropped_detections, run.dropped_objects));
  }
  if (!run.is_repeatable) throw Finding("the passes have different estimates: the tracker is not deterministic");
  return exit_code::kSuccess;
}

}  // namespace

void add_track_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "track",
      "Runs a tracker over the measurements of a simulated scenario with a linear model (no vehicle, no radar), or a "
      "filter over the radar measurements of one object.");
  const auto options = std::make_shared<TrackOptions>();
  command
      ->add_option("--measurements", options->measurements,
                   "Table with the columns step,x,y and, optionally, range_rate; for filters k,range,azimuth_rad,"
                   "radial_speed and, optionally, the true state tx,tvx,tax,ty,tvy,tay")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--params", options->parameters,
                   "Parameters of the scenario (params.txt); required for pmbm and phd")
      ->type_name("FILE");
  std::vector<std::string> trackers = track_filter_names();
  trackers.insert(trackers.begin(), {"pmbm", "phd"});
  command->add_option("--tracker", options->tracker, "Tracker, or filter of one object")
      ->check(CLI::IsMember(trackers))
      ->capture_default_str();
  command
      ->add_option(
          "--out", options->out,
          "Table of the estimates to write: step,cx,cy,vx,vy,X11,X12,X22,id, for filters k,x,vx,ax,y,vy,ay,range,"
          "azimuth_rad,radial_speed; \"-\": standard output")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--repeat", options->passes,
                   "Number of passes; the CPU time of each scan is the least of all passes, the estimates are the same")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_track_filter_options(*command, options->filter);
  on_call(*command, exit_code,
          {"track --measurements measurements.csv --params params.txt --tracker pmbm --out estimates.csv\n"
           "track --measurements radar.csv --tracker srukf --out estimates.csv --figure filter.svg",
           "the estimates are written", "two passes had different estimates, or a filter lost its covariance"},
          [options, command] { return run_track(*options, *command); });
}

}  // namespace boresight
