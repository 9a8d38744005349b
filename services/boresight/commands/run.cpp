// `boresight run`: the whole chain over a recorded drive, offline, with the cores and settings of the services.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/input/drive_csv.hpp"
#include "services/boresight/input/ego_csv.hpp"
#include "services/boresight/run/chain.hpp"
#include "services/boresight/run/gateway_feed.hpp"
#include "services/boresight/run/settings.hpp"
#include "services/boresight/run/summary.hpp"
#include "services/boresight/run/table_feed.hpp"
#include "services/boresight/run/writer.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/common/recording/reader.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"
#include "services/tracker/core/make_tracker.hpp"

namespace boresight {

namespace {

struct RunOptions {
  std::vector<std::filesystem::path> recordings;
  std::string detections, ego;
  std::filesystem::path out;
  runtime::Configuration configuration;
  std::string tracker;  ///< empty: the one of the configuration
  bool quiet = false;
};

/// A folder, which is made if it does not exist. It is removed again if it was made here and is empty at the end.
class MadeFolder {
 public:
  explicit MadeFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    is_new_ = !std::filesystem::exists(folder_, error);
    std::filesystem::create_directories(folder_, error);
    if (error) throw terminal::OutputError(folder_.string(), error.value());
  }
  ~MadeFolder() {
    std::error_code ignored;
    if (is_new_) std::filesystem::remove(folder_, ignored);
  }
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
  bool is_new_ = false;
};

/// The files of a run folder; without commit() an earlier run in it stays.
class RunFolder {
 public:
  explicit RunFolder(const std::filesystem::path& folder) : folder_(folder) {
    for (std::size_t i = 0; i < run::kFileNames.size(); ++i) {
      files_.at(i) = std::make_unique<terminal::OutputFile>(folder_.path() / run::kFileNames.at(i));
    }
  }

  void put(run::File file, std::string_view text) { files_.at(static_cast<std::size_t>(file))->write(text); }
  /// The tables, and last run.json: where it is, the folder is whole.
  void commit(const std::string& run_json) {
    for (auto& file : files_) file->flush();
    for (auto& file : files_) file->commit();
    terminal::write_file(folder_.path() / "run.json", run_json);
  }

 private:
  MadeFolder folder_;  // before the files, so that they are removed first
  std::array<std::unique_ptr<terminal::OutputFile>, run::kFileNames.size()> files_;
};

class RunDrive {
 public:
  RunDrive(const RunOptions& options, const CLI::App& command)
      : options_(options), command_(command), bar_("running"), problems_([this](const std::string& problem) {
          bar_.wipe();
          std::fprintf(stderr, "%s\n", problem.c_str());
        }) {}

  int run() {
    const bool has_tables = options_.recordings.empty();
    vehicle_ = options_.configuration.vehicle(has_tables ? config::VehicleUse::kOffline : config::VehicleUse::kLive);
    run::Settings settings = run::read_settings(options_.configuration, vehicle_);
    if (!options_.tracker.empty()) settings.tracker.tracker = options_.tracker;
    summary_.inputs = {.version = BORESIGHT_VERSION,
                       .recordings = {},
                       .detections = options_.detections,
                       .ego = options_.ego,
                       .vehicle_file = options_.configuration.vehicle_file().string(),
                       .configuration = options_.configuration.directory.string(),
                       .settings_files = run::settings_files(options_.configuration)};
    for (const auto& file : options_.recordings) summary_.inputs.recordings.push_back(file.string());
    begin_cpu_ns_ = runtime::thread_cpu_time_ns();

    std::optional<RunFolder> folder;
    std::optional<run::Writer> writer;
    const auto write = [&](const auto& result) {
      const std::int64_t from_ns = runtime::thread_cpu_time_ns();
      writer->write(result);
      write_ns_ += runtime::thread_cpu_time_ns() - from_ns;
    };
    const auto chain = std::make_unique<run::Chain>(vehicle_, settings, run::Listeners{write, write, write},
                                                    runtime::thread_cpu_time_ns);
    // Inputs are opened before the folder is made, so that a wrong name leaves nothing.
    const auto begin_output = [&] {
      folder.emplace(options_.out);
      writer.emplace([&](run::File file, std::string_view text) { folder->put(file, text); }, vehicle_);
    };
    if (has_tables) {
      play_tables(*chain, begin_output);
    } else {
      play_recordings(*chain, settings.contradiction, begin_output);
    }
    bar_.wipe();
    summary_.is_complete = !runtime::stop_signalled();
    if (summary_.is_complete) chain->finish();
    writer->flush();
    summarise(*chain);
    folder->commit(run::to_json(summary_, vehicle_));
    stop_if_interrupted();
    report();
    return exit_code_;
  }

 private:
  template <typename Begin>
  void play_recordings(run::Chain& chain, const ingest::ContradictionConfig& contradiction, const Begin& begin_output) {
    const auto reader = recording::open_recordings(options_.recordings, [this](const std::string& problem) {
      // A signal interrupts the reading of a pipe: no problem of the recording.
      if (!runtime::stop_signalled()) problems_.bad_line(problem);
    });
    run::GatewayFeed feed(chain);
    ingest::Gateway gateway(vehicle_, feed, ingest::read_mappings(vehicle_), contradiction);
    begin_output();
    recording::Frame frame;
    for (std::uint64_t frames = 1; !runtime::stop_signalled() && reader->next(frame); ++frames) {
      chain.advance(frame.stamp_ns);
      // The recording's own clock is the only one, so that the result depends on nothing else.
      gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
      problems_.good_line();
      constexpr std::uint64_t kFramesBetweenLooks = 256;
      if (frames % kFramesBetweenLooks == 0) look(reader->progress().position_bytes, reader->progress().total_bytes);
    }
    if (!runtime::stop_signalled()) gateway.finish();
    summary_.frames = reader->counts();
    summary_.rejected = feed.rejected();
    summary_.noted = feed.noted();
    rejected_messages_ = feed.number_rejected();
  }

  template <typename Begin>
  void play_tables(run::Chain& chain, const Begin& begin_output) {
    recording::ByteSource ego_source(options_.ego), drive_source(options_.detections);
    input::EgoReader ego(ego_source, vehicle_.ego, problems_);
    input::DriveReader drive(drive_source, vehicle_, problems_);
    begin_output();
    run::TableFeed feed(drive, ego, chain);
    while (!runtime::stop_signalled() && feed.next()) look(drive_source.position(), drive_source.total());
    bar_.wipe();
    for (const auto& [name, columns] :
         {std::pair(options_.detections, drive.ignored_columns()), std::pair(options_.ego, ego.ignored_columns())}) {
      if (!columns.empty()) tell(fmt::format("{}: ignored columns: {}", name, fmt::join(columns, ", ")));
    }
    for (const auto& [id, lines] : drive.unknown_radars()) {
      complain(fmt::format("{}: radar {} ({} lines) is not in {}", options_.detections, id, lines,
                           summary_.inputs.vehicle_file));
    }
    summary_.tables = run::TableLosses{.lines = problems_.lines(),
                                       .bad_lines = problems_.bad_lines(),
                                       .unknown_radars = {drive.unknown_radars().begin(), drive.unknown_radars().end()},
                                       .dropped_detections = drive.dropped_detections()};
  }

  void look(std::uint64_t position, std::uint64_t total) {
    if (options_.quiet || !bar_.is_due()) return;
    bar_.show(total == 0 ? -1.0 : static_cast<double>(position) / static_cast<double>(total),
              fmt::format("{:.0f} MB", 1e-6 * static_cast<double>(position)));
  }

  void summarise(const run::Chain& chain) {
    summary_.start_ns = chain.start_ns();
    summary_.recording_s = static_cast<double>(chain.length_ns()) / 1e9;
    summary_.counts = chain.counts();
    summary_.sources = chain.sources;
    summary_.timing.stages = chain.stage_times();
    summary_.timing.write_s = static_cast<double>(write_ns_) / 1e9;
    summary_.timing.cpu_s = static_cast<double>(runtime::thread_cpu_time_ns() - begin_cpu_ns_) / 1e9;
    summary_.timing.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

  void tell(const std::string& text) const { report_problem(command_, text); }
  /// Something that makes the result doubtful.
  void complain(const std::string& text) {
    tell(text);
    exit_code_ = exit_code::kFinding;
  }
  void tell_or_complain(bool is_doubtful, const std::string& text) {
    if (is_doubtful) {
      complain(text);
    } else {
      tell(text);
    }
  }

  void report() {
    std::uint64_t scans = 0, detections = 0;
    for (const run::RadarCounts& radar : summary_.counts.radars) {
      scans += radar.scans;
      detections += radar.detections;
    }
    const std::uint64_t without_ego = run::scans_without_ego_motion(summary_.counts);
    if (problems_.bad_lines() > input::Problems::kShown) {
      tell(fmt::format("… and {} more", problems_.bad_lines() - input::Problems::kShown));
    }
    if (problems_.bad_lines() > 0) {
      const bool too_many = problems_.too_many();
      tell_or_complain(
          too_many, fmt::format("{} of {} {} were skipped{}", problems_.bad_lines(), problems_.lines(),
                                summary_.tables ? "lines" : "frames", too_many ? ": more than one in a hundred" : ""));
    }
    if (rejected_messages_ > 0) {
      const bool too_many = rejected_messages_ * 100 > rejected_messages_ + scans;
      tell_or_complain(too_many, fmt::format("{} messages were rejected{}; run.json has the reasons",
                                             rejected_messages_, too_many ? ", more than one in a hundred" : ""));
    }
    if (scans == 0) complain("there is no scan in the recording");
    if (without_ego > 0) {
      tell_or_complain(2 * without_ego > scans,
                       fmt::format("{} of {} scans have no ego motion near their time", without_ego, scans));
    }
    if (options_.quiet) return;
    terminal::print(fmt::format("ran {:.1f} s in {:.1f} s ({:.1f} times real time): {} scans, {} detections\n{}\n",
                                summary_.recording_s, summary_.timing.wall_s,
                                summary_.recording_s / std::max(1e-9, summary_.timing.wall_s), scans, detections,
                                (options_.out / "run.json").string()));
  }

  RunOptions options_;
  const CLI::App& command_;
  terminal::ProgressBar bar_;
  input::Problems problems_;
  VehicleConfig vehicle_;
  run::Summary summary_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::int64_t begin_cpu_ns_ = 0, write_ns_ = 0;
  std::uint64_t rejected_messages_ = 0;
  int exit_code_ = exit_code::kSuccess;
};

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "run", "Runs the whole chain over a recorded drive, offline, and writes every result as tables.");
  const auto options = std::make_shared<RunOptions>();
  command
      ->add_option("recordings", options->recordings,
                   "pcap, pcapng or candump logs of the vehicle's links, merged by time; \"-\": standard input")
      ->type_name("RECORDING");
  command
      ->add_option("--detections", options->detections,
                   "Instead of recordings: table of detections; \"-\": standard input")
      ->type_name("FILE");
  command->add_option("--ego", options->ego, "Table of ego motions, with --detections")->type_name("FILE");
  runtime::add_vehicle_option(*command, options->configuration,
                              "Vehicle: a name in the folder vehicle/, or a file. Tables need no links in it")
      ->required();
  runtime::add_config_option(*command, options->configuration);
  command->add_option("--out", options->out, "Folder for the results; files of an earlier run in it are replaced")
      ->type_name("DIR")
      ->required();
  command
      ->add_option("--statistics", options->configuration.statistics,
                   "Radar profile of all radars, instead of those in the vehicle file: a name in the folder "
                   "radar_profiles/, or a file")
      ->type_name("NAME|FILE");
  command->add_option("--tracker", options->tracker, "Tracker instead of the one in services/tracker.toml")
      ->check(CLI::IsMember(tracking::tracker_names()));
  command->add_flag("--quiet", options->quiet, "No progress bar and no summary; problems are reported all the same");
  on_call(
      *command, exit_code,
      {"run radars.pcap ego.candump.log --vehicle demo --out run\n"
       "run --detections detections.csv --ego ego.csv --vehicle my_car.toml --out run",
       "the results are complete",
       "the results are doubtful: more than one frame or line in a hundred was skipped, or more than one message in\n"
       "       a hundred rejected, a radar is not in the vehicle file, there is no scan, or most scans have no ego "
       "motion.\n"
       "       The results are written all the same"},
      [options, command] {
        const bool has_tables = !options->detections.empty() && !options->ego.empty();
        const bool has_any_table = !options->detections.empty() || !options->ego.empty();
        if (options->recordings.empty() ? !has_tables : has_any_table) {
          throw UsageError("give either recordings, or --detections and --ego");
        }
        if (options->detections == "-" && options->ego == "-") {
          throw UsageError("only one of the tables can be standard input");
        }
        return RunDrive(*options, *command).run();
      },
      &options->configuration);
}

}  // namespace boresight
