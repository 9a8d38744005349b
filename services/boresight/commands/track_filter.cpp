#include "services/boresight/commands/track_filter.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/boresight/track/filter_errors.hpp"
#include "services/boresight/track/filter_figure.hpp"
#include "services/common/runtime/clock.hpp"

namespace boresight {

void TrackFilterOptions::refuse_for(const std::string& tracker) const {
  for (const CLI::Option* option : all) {
    if (option->count() > 0) {
      throw UsageError(fmt::format("{} is an option of the filters {}, not of {}", option->get_name(),
                                   fmt::join(track_filter_names(), ", "), tracker));
    }
  }
}

void add_track_filter_options(CLI::App& command, TrackFilterOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* unit, const std::string& about) {
    CLI::Option* const option = command.add_option(name, value, about + " (filters)")->capture_default_str();
    option->type_name(unit);
    options.all.push_back(option);
    return option;
  };
  const CLI::Range positive(1e-9, 1e9, "POSITIVE");
  add("--step", options.setup.step_s, "S", "Time between steps")->check(positive);
  add("--range-std", options.setup.range_std_m, "M", "Standard deviation of ranges")->check(positive);
  add("--azimuth-std", options.azimuth_std_deg, "DEG", "Standard deviation of azimuths")->check(positive);
  add("--range-rate-std", options.setup.range_rate_std_mps, "M/S", "Standard deviation of radial speeds")
      ->check(positive);
  add("--jerk-density", options.setup.jerk_density_m2ps5, "M2/S5", "Density of white jerk")
      ->check(CLI::Range(0.0, 1e9, "NOT NEGATIVE"));
  add("--sigma-points", options.sigma_points, "ALPHA BETA KAPPA", "Parameters of the sigma points")->expected(3);
  add("--skip", options.skipped_steps, "N", "First steps that the errors do not count");
  add("--figure", options.figure, "FILE",
      "Picture (SVG) of range, azimuth and radial speed over time: measured, filtered and true");
}

std::vector<std::string> track_filter_names() {
  const auto names = tracking::filters::filter_kind_names();
  return {names.begin(), names.end()};
}

int run_track_filter(const std::string& filter, const std::string& measurements, const std::string& out,
                     std::size_t passes, const TrackFilterOptions& options) {
  track::FilterSetup setup = options.setup;
  setup.azimuth_std_rad = options.azimuth_std_deg * kRadiansPerDegree;
  setup.sigma_points = {options.sigma_points[0], options.sigma_points[1], options.sigma_points[2]};
  constexpr int kStateSize = 6;
  if (!setup.sigma_points.is_valid(kStateSize)) {
    throw UsageError(fmt::format("--sigma-points: ALPHA² · ({} + KAPPA) must be positive", kStateSize));
  }
  const track::RadarMeasurements table = track::read_radar_measurements(measurements);
  const track::FilterRun run = track::run_filter(*tracking::filters::filter_kind(filter), table, setup, passes,
                                                 runtime::thread_cpu_time_ns, stop_if_interrupted);
  terminal::write_file(out, track::filter_csv(table, run));
  if (!options.figure.empty()) {
    terminal::write_file(options.figure, track::filter_svg(filter, table, run, setup.step_s));
  }
  if (out != "-" && options.figure != "-") {
    std::string text =
        fmt::format("{}: {} estimates; CPU time a step: mean {:.2f} µs{}\n", filter, run.estimates.size(),
                    run.mean_cpu_us, passes > 1 ? fmt::format(", of the quickest of {} passes", passes) : "");
    text += table.truth.empty() ? "the table has no true states: no errors are stated\n"
                                : track::filter_errors_text(track::filter_errors(table, run, options.skipped_steps),
                                                            options.skipped_steps);
    terminal::print(text);
  }
  if (run.refused_row) {
    throw Finding(fmt::format("the filter lost its covariance in step {}: the estimates end there",
                              table.rows[*run.refused_row].step));
  }
  if (!run.is_repeatable) throw Finding("the passes have different estimates: the filter is not deterministic");
  return exit_code::kSuccess;
}

}  // namespace boresight
