// `boresight align`: an alignment method over a recorded drive, with the core that the service runs.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/alignment_estimator/config.hpp"
#include "services/boresight/align/json.hpp"
#include "services/boresight/align/plot.hpp"
#include "services/boresight/align/recording_feed.hpp"
#include "services/boresight/align/run.hpp"
#include "services/boresight/align/table.hpp"
#include "services/boresight/align/truth_file.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/input/drive_csv.hpp"
#include "services/boresight/input/ego_csv.hpp"
#include "services/boresight/input/play.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"
#include "services/simulator/drive.hpp"

namespace boresight {

namespace {

struct AlignOptions {
  std::string drive, ego, truth, json, plot;
  std::vector<std::string> recordings;
  runtime::Configuration configuration;
  bool has_config = false;  ///< the settings are read from the folder of the configuration
  std::string method = "boresight";
};

class Align {
 public:
  Align(const AlignOptions& options, const CLI::App& command)
      : options_(options), command_(command), bar_("aligning"), problems_([this](const std::string& problem) {
          bar_.wipe();
          std::fprintf(stderr, "%s\n", problem.c_str());
        }) {}

  int run() {
    provenance_ = {.tool_version = BORESIGHT_VERSION,
                   .drive = options_.drive,
                   .ego = options_.ego,
                   .vehicle = options_.configuration.vehicle_file().string(),
                   .config = options_.has_config ? settings_file().string() : "",
                   .truth = options_.truth,
                   .recordings = options_.recordings};
    align::Run::Options run_options;
    run_options.method = options_.method;
    run_options.cpu_time_ns = runtime::thread_cpu_time_ns;
    run_options.batch_calibration_progress = [this](auto phase, double share) { show_batch_calibration(phase, share); };
    if (options_.has_config) {
      run_options.config = alignment::read_settings(config::Reader::open(settings_file())).estimator;
    }
    if (!options_.truth.empty()) {
      // Recordings of a simulated drive carry stamps; its tables count from the beginning.
      const double origin_s =
          options_.recordings.empty() ? 0.0 : 1e-9 * static_cast<double>(simulator::Drive::kStart_ns);
      run_options.truth = align::read_truth_at(options_.truth, origin_s);
    }
    if (!options_.recordings.empty()) return report(run_recordings(std::move(run_options)));
    const VehicleConfig vehicle = options_.configuration.vehicle(config::VehicleUse::kOffline);
    return report(run_tables(vehicle, std::move(run_options)));
  }

 private:
  void tell(const std::string& text) const { report_problem(command_, text); }
  [[nodiscard]] std::filesystem::path settings_file() const {
    return options_.configuration.service_file("alignment_estimator");
  }

  align::Result run_tables(const VehicleConfig& vehicle, align::Run::Options run_options) {
    std::optional<align::Run> run;
    do {
      read_tables(vehicle, run_options, run);
    } while (run->needs_another_pass());
    return run->finish();
  }

  /// One pass over the tables; the first makes the run, and reports what is wrong with the tables.
  void read_tables(const VehicleConfig& vehicle, align::Run::Options& run_options, std::optional<align::Run>& run) {
    const bool is_first = !run;
    input::Problems silent([](const std::string&) {});
    input::Problems& problems = is_first ? problems_ : silent;
    recording::ByteSource ego_source(options_.ego), drive_source(options_.drive);
    input::EgoReader ego(ego_source, vehicle.ego, problems);
    input::DriveReader drive(drive_source, vehicle, problems);
    const auto scan = std::make_unique<RadarScan>();
    EgoMotion motion{};
    double motion_s = 0.0, newest_motion_s = NAN, scan_s = 0.0;
    bool has_motion = ego.next(motion, motion_s);
    bool has_scan = drive.next(*scan, scan_s);
    if (is_first) {
      run_options.origin_s = has_scan && has_motion ? std::min(scan_s, motion_s) : has_scan ? scan_s : motion_s;
      run.emplace(vehicle, std::move(run_options));
    }
    for (std::uint64_t scans = 1; has_scan; has_scan = drive.next(*scan, scan_s), ++scans) {
      // Up to one motion beyond the scan, so that its own is interpolated.
      for (; has_motion && !(newest_motion_s > scan_s); has_motion = ego.next(motion, motion_s)) {
        newest_motion_s = motion_s;
        run->add_ego(motion, motion_s);
      }
      run->add_scan(*scan, scan_s);
      constexpr std::uint64_t kScansBetweenLooks = 64;
      if (scans % kScansBetweenLooks != 0) continue;
      stop_if_interrupted();
      if (bar_.is_due()) show_progress(drive_source.position(), drive_source.total());
    }
    bar_.wipe();
    stop_if_interrupted();
    for (; has_motion; has_motion = ego.next(motion, motion_s)) run->add_ego(motion, motion_s);
    if (!is_first) return;
    for (const auto& [name, columns] :
         {std::pair(options_.drive, drive.ignored_columns()), std::pair(options_.ego, ego.ignored_columns())}) {
      if (!columns.empty()) tell(fmt::format("{}: ignored columns: {}", name, fmt::join(columns, ", ")));
    }
    provenance_.dropped_detections = drive.dropped_detections();
    for (const auto& [id, lines] : drive.unknown_radars()) {
      complain(fmt::format("{}: radar {} ({} lines) is not in {}", options_.drive, id, lines, provenance_.vehicle));
    }
  }

  align::Result run_recordings(align::Run::Options run_options) {
    const VehicleConfig vehicle = options_.configuration.vehicle();
    align::Run run(vehicle, std::move(run_options));
    bool is_first = true;
    do {
      align::RecordingFeed feed(run);
      ingest::Gateway gateway(vehicle, feed, ingest::read_mappings(vehicle));
      input::Problems silent([](const std::string&) {});
      input::play({options_.recordings.begin(), options_.recordings.end()}, gateway, is_first ? problems_ : silent,
                  [this](const recording::Progress& progress) {
                    stop_if_interrupted();
                    if (bar_.is_due()) show_progress(progress.position_bytes, progress.total_bytes);
                  });
      stop_if_interrupted();
      feed.finish();
      bar_.wipe();
      if (is_first && feed.rejected() > 0) {
        tell(fmt::format("{} messages were rejected; `boresight decode --check` lists the reasons", feed.rejected()));
      }
      if (is_first && feed.doubtful() > 0) {
        tell(fmt::format("{} scans of doubtful integrity were rejected", feed.doubtful()));
      }
      is_first = false;
    } while (run.needs_another_pass());
    return run.finish();
  }

  void show_progress(std::uint64_t position, std::uint64_t total) {
    bar_.show(total == 0 ? -1.0 : static_cast<double>(position) / static_cast<double>(total),
              fmt::format("{:.0f} MB", 1e-6 * static_cast<double>(position)));
  }

  void show_batch_calibration(alignment::batch_calibration::Phase phase, double share) {
    stop_if_interrupted();
    struct Part {
      const char* what;
      double begin, end;  // of a bar over all phases, by what they cost on a drive of minutes
    };
    constexpr std::array<Part, 3> kParts{{{"finding stationary detections", 0.0, 0.1},
                                          {"iterating", 0.1, 0.9},
                                          {"judging what the data support", 0.9, 1.0}}};
    const Part& part = kParts.at(static_cast<std::size_t>(phase));
    if (bar_.is_terminal()) {
      if (bar_.is_due()) bar_.show(part.begin + (part.end - part.begin) * share, part.what);
    } else if (phase != announced_phase_) {
      tell(fmt::format("{}, step {} of {}: {} …", options_.method, static_cast<int>(phase) + 1, kParts.size(),
                       part.what));
    }
    announced_phase_ = phase;
  }

  /// Something that makes the result doubtful.
  void complain(const std::string& text) {
    tell(text);
    exit_code_ = exit_code::kFinding;
  }

  int report(const align::Result& result) {
    bar_.wipe();
    provenance_.lines = problems_.lines();
    provenance_.bad_lines = problems_.bad_lines();
    if (problems_.bad_lines() > input::Problems::kShown) {
      tell(fmt::format("… and {} more", problems_.bad_lines() - input::Problems::kShown));
    }
    if (problems_.bad_lines() > 0) {
      const std::string text = fmt::format("{} of {} {} were skipped", problems_.bad_lines(), problems_.lines(),
                                           options_.recordings.empty() ? "lines" : "frames");
      if (problems_.too_many()) {
        complain(text + ": more than one in a hundred");
      } else {
        tell(text);
      }
    }
    if (provenance_.dropped_detections > 0) {
      tell(fmt::format("{} detections beyond the {} that a scan can have were skipped", provenance_.dropped_detections,
                       kMaxDetections));
    }
    if (result.scans == 0) complain("there is no detection in the drive");
    if (!result.problem.empty()) complain(result.problem);
    for (const align::RadarResult& radar : result.radars) {
      if (!radar.finding.empty()) complain(fmt::format("radar {} {}: {}", radar.id, radar.name, radar.finding));
    }
    std::uint64_t without_ego = 0;
    for (const align::RadarResult& radar : result.radars) without_ego += radar.scans_without_ego;
    if (without_ego > 0) {
      const std::string text = fmt::format(
          "{} of {} scans have no ego motion near their time; the drive lasts from {} to {} s, the ego motion from {} "
          "to {} s",
          without_ego, result.scans, result.start_s, result.end_s, result.ego_start_s, result.ego_end_s);
      if (2 * without_ego > result.scans) {
        complain(text);
      } else {
        tell(text);
      }
    }
    stop_if_interrupted();
    if (!options_.json.empty()) terminal::write_file(options_.json, align::to_json(result, provenance_));
    if (!options_.plot.empty()) terminal::write_file(options_.plot, align::to_svg(result));
    // Standard output is for one result.
    if (options_.json != "-" && options_.plot != "-") terminal::print(align::to_table(result));
    return exit_code_;
  }

  AlignOptions options_;
  const CLI::App& command_;
  terminal::ProgressBar bar_;
  input::Problems problems_;
  align::Provenance provenance_;
  std::optional<alignment::batch_calibration::Phase> announced_phase_;
  int exit_code_ = exit_code::kSuccess;
};

}  // namespace

void add_align_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "align", "Estimates each radar's mounting error and the scale error of the speed signal from a recorded drive.");
  const auto options = std::make_shared<AlignOptions>();
  command
      ->add_option("--drive", options->drive,
                   "Table of detections with the columns t_s, radar, range_m, azimuth_rad, range_rate_mps …; \"-\": "
                   "standard input")
      ->type_name("FILE");
  command->add_option("--ego", options->ego, "Table of ego motions with the columns t_s, speed_mps, yaw_rate_radps")
      ->type_name("FILE");
  command
      ->add_option("--recording", options->recordings,
                   "Instead of tables: pcap, pcapng or candump log of the vehicle's links; repeatable")
      ->type_name("FILE");
  runtime::add_vehicle_option(*command, options->configuration,
                              "Vehicle: a name in the folder vehicle/, or a file. Tables need no links in it")
      ->required();
  const CLI::Option* const config = runtime::add_config_option(*command, options->configuration);
  command
      ->add_option("--method", options->method,
                   "Estimation method; batch: the most accurate for a recorded drive, which it reads several times")
      ->check(CLI::IsMember(align::method_names()))
      ->capture_default_str();
  command
      ->add_option(
          "--truth", options->truth,
          "Truth of a simulated drive, to compare the result with: its folder, or the file of an alignment drive")
      ->type_name("DIR|FILE");
  add_json_option(*command, options->json, "Result as JSON; without FILE, or with \"-\": to standard output");
  command
      ->add_option("--plot", options->plot,
                   "Plot (SVG) of the convergence of every parameter and of the residuals; \"-\": standard output")
      ->type_name("FILE");
  on_call(
      *command, exit_code,
      {"align --drive drive.csv --ego ego.csv --vehicle alignment_drive --json result.json\n"
       "align --recording radars.pcap --recording ego.candump.log --vehicle demo --method batch",
       "the result is complete",
       "the result is doubtful: more than one line in a hundred was skipped, a radar is not in the vehicle file,\n"
       "       there is no detection, most scans have no ego motion, an input is wrong (swapped radars, sign, unit,\n"
       "       frozen speed …; the sentence is on standard error), or a batch method found no solution.\n"
       "       The result is written all the same"},
      [options, command, config] {
        const bool has_tables = !options->drive.empty() && !options->ego.empty();
        const bool has_any_table = !options->drive.empty() || !options->ego.empty();
        if (options->recordings.empty() ? !has_tables : has_any_table) {
          throw UsageError("give either --drive and --ego, or --recording");
        }
        if (options->drive == "-" && options->ego == "-") {
          throw UsageError("only one of the tables can be standard input");
        }
        if (options->method == "batch" && (options->drive == "-" || options->ego == "-")) {
          throw UsageError("method batch reads the drive several times, so it cannot be standard input");
        }
        if (options->json == "-" && options->plot == "-") {
          throw UsageError("only one result can go to standard output");
        }
        // Without the option, what the service would read; without that either, its defaults.
        options->has_config =
            config->count() > 0 || std::filesystem::exists(options->configuration.service_file("alignment_estimator"));
        return Align(*options, *command).run();
      },
      &options->configuration);
}

}  // namespace boresight
