// `boresight align`: an alignment method over a recorded drive, with the core that the service runs.
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "services/alignment_estimator/config.hpp"
#include "services/boresight/align/drive_csv.hpp"
#include "services/boresight/align/ego_csv.hpp"
#include "services/boresight/align/json.hpp"
#include "services/boresight/align/play.hpp"
#include "services/boresight/align/plot.hpp"
#include "services/boresight/align/recording_feed.hpp"
#include "services/boresight/align/run.hpp"
#include "services/boresight/align/table.hpp"
#include "services/boresight/align/truth_file.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"

namespace boresight {

namespace {

constexpr int kExitUsage = 2;

struct Options {
  std::string drive, ego, vehicle, config, truth, json, plot;
  std::vector<std::string> recordings;
  std::string method = "boresight";
};

/// A command line that contradicts itself.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::int64_t cpu_time_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

void write_file(const std::string& file, const std::string& text) {
  std::FILE* const stream = file == "-" ? stdout : std::fopen(file.c_str(), "we");
  const bool written =
      stream != nullptr && std::fwrite(text.data(), 1, text.size(), stream) == text.size() && std::fflush(stream) == 0;
  const int error = errno;
  if (stream != nullptr && stream != stdout) std::fclose(stream);
  if (!written) throw std::runtime_error(file + ": " + std::strerror(error));
}

void tell(const std::string& text) {
  std::fprintf(stderr, "boresight align: %s\n", text.c_str());
}

class Align {
 public:
  explicit Align(const Options& options)
      : options_(options), bar_("aligning"), problems_([this](const std::string& problem) {
          bar_.wipe();
          std::fprintf(stderr, "%s\n", problem.c_str());
        }) {}

  int run() {
    provenance_ = {.tool_version = BORESIGHT_VERSION,
                   .drive = options_.drive,
                   .ego = options_.ego,
                   .vehicle = options_.vehicle,
                   .config = options_.config,
                   .truth = options_.truth,
                   .recordings = options_.recordings};
    align::Run::Options run_options;
    run_options.method = options_.method;
    run_options.cpu_time_ns = cpu_time_ns;
    run_options.batch_calibration_progress = [this](auto phase, double share) { show_batch_calibration(phase, share); };
    if (!options_.config.empty()) {
      run_options.config = alignment::read_settings(config::Reader::open(options_.config)).estimator;
    }
    if (!options_.truth.empty()) {
      std::ifstream truth(options_.truth);
      if (!truth) throw std::runtime_error(options_.truth + ": " + std::strerror(errno));
      run_options.truth = align::read_truth(truth, options_.truth);
    }
    if (!options_.recordings.empty()) return report(run_recordings(std::move(run_options)));
    const VehicleConfig vehicle = config::read_vehicle_file(options_.vehicle, config::VehicleUse::kOffline);
    return report(run_tables(vehicle, std::move(run_options)));
  }

 private:
  align::Result run_tables(const VehicleConfig& vehicle, align::Run::Options run_options) {
    recording::ByteSource ego_source(options_.ego), drive_source(options_.drive);
    align::EgoReader ego(ego_source, vehicle.ego, problems_);
    align::DriveReader drive(drive_source, vehicle, problems_);
    const auto scan = std::make_unique<RadarScan>();
    EgoMotion motion{};
    double motion_s = 0.0, newest_motion_s = NAN, scan_s = 0.0;
    bool has_motion = ego.next(motion, motion_s);
    bool has_scan = drive.next(*scan, scan_s);
    run_options.origin_s = has_scan && has_motion ? std::min(scan_s, motion_s) : has_scan ? scan_s : motion_s;
    align::Run run(vehicle, std::move(run_options));
    for (std::uint64_t scans = 1; has_scan; has_scan = drive.next(*scan, scan_s), ++scans) {
      // Up to one motion beyond the scan, so that its own is interpolated.
      for (; has_motion && !(newest_motion_s > scan_s); has_motion = ego.next(motion, motion_s)) {
        newest_motion_s = motion_s;
        run.add_ego(motion, motion_s);
      }
      run.add_scan(*scan, scan_s);
      constexpr std::uint64_t kScansBetweenLooks = 64;
      if (scans % kScansBetweenLooks == 0 && bar_.is_due())
        show_progress(drive_source.position(), drive_source.total());
    }
    bar_.wipe();
    for (; has_motion; has_motion = ego.next(motion, motion_s)) run.add_ego(motion, motion_s);
    for (const auto& [name, columns] :
         {std::pair(options_.drive, drive.ignored_columns()), std::pair(options_.ego, ego.ignored_columns())}) {
      if (!columns.empty()) tell(fmt::format("{}: ignored columns: {}", name, fmt::join(columns, ", ")));
    }
    provenance_.dropped_detections = drive.dropped_detections();
    for (const auto& [id, lines] : drive.unknown_radars()) {
      complain(fmt::format("{}: radar {} ({} lines) is not in {}", options_.drive, id, lines, options_.vehicle));
    }
    return run.finish();
  }

  align::Result run_recordings(align::Run::Options run_options) {
    const VehicleConfig vehicle = config::read_vehicle_file(options_.vehicle);
    align::Run run(vehicle, std::move(run_options));
    align::RecordingFeed feed(run);
    ingest::Gateway gateway(vehicle, feed, ingest::read_mappings(vehicle));
    align::play({options_.recordings.begin(), options_.recordings.end()}, gateway, problems_,
                [this](const recording::Progress& progress) {
                  if (bar_.is_due()) show_progress(progress.position_bytes, progress.total_bytes);
                });
    feed.finish();
    bar_.wipe();
    if (feed.rejected() > 0) {
      tell(fmt::format("{} messages were rejected; `boresight decode --check` tells why", feed.rejected()));
    }
    if (feed.doubtful() > 0) tell(fmt::format("{} scans of doubtful integrity were left out", feed.doubtful()));
    return run.finish();
  }

  void show_progress(std::uint64_t position, std::uint64_t total) {
    bar_.show(total == 0 ? -1.0 : static_cast<double>(position) / static_cast<double>(total),
              fmt::format("{:.0f} MB", 1e-6 * static_cast<double>(position)));
  }

  void show_batch_calibration(alignment::batch_calibration::Phase phase, double share) {
    struct Part {
      const char* what;
      double begin, end;  // of a bar over all phases, by what they cost on a drive of minutes
    };
    constexpr std::array<Part, 3> kParts{{{"finding what stands still", 0.0, 0.1},
                                          {"iterating", 0.1, 0.9},
                                          {"judging what the data support", 0.9, 1.0}}};
    const Part& part = kParts.at(static_cast<std::size_t>(phase));
    if (bar_.is_terminal()) {
      if (bar_.is_due()) bar_.show(part.begin + (part.end - part.begin) * share, part.what);
    } else if (phase != told_phase_) {
      tell(fmt::format("{}, step {} of {}: {} …", options_.method, static_cast<int>(phase) + 1, kParts.size(),
                       part.what));
    }
    told_phase_ = phase;
  }

  /// Something that makes the result doubtful.
  void complain(const std::string& text) {
    tell(text);
    exit_code_ = EXIT_FAILURE;
  }

  int report(const align::Result& result) {
    bar_.wipe();
    provenance_.lines = problems_.lines();
    provenance_.bad_lines = problems_.bad_lines();
    if (problems_.bad_lines() > align::Problems::kShown) {
      tell(fmt::format("… and {} more", problems_.bad_lines() - align::Problems::kShown));
    }
    if (problems_.bad_lines() > 0) {
      const std::string text = fmt::format("{} of {} {} were left out", problems_.bad_lines(), problems_.lines(),
                                           options_.recordings.empty() ? "lines" : "frames");
      if (problems_.too_many()) {
        complain(text + ": more than one in a hundred");
      } else {
        tell(text);
      }
    }
    if (provenance_.dropped_detections > 0) {
      tell(fmt::format("{} detections beyond the {} that a scan can have were left out", provenance_.dropped_detections,
                       kMaxDetections));
    }
    if (result.scans == 0) complain("there is no detection in the drive");
    if (!result.problem.empty()) complain(result.problem);
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
    if (!options_.json.empty()) write_file(options_.json, align::to_json(result, provenance_));
    if (!options_.plot.empty()) write_file(options_.plot, align::to_svg(result));
    // Standard output is for one thing.
    if (options_.json != "-" && options_.plot != "-") std::fputs(align::to_table(result).c_str(), stdout);
    if (std::fflush(stdout) != 0) throw std::runtime_error(std::string("standard output: ") + std::strerror(errno));
    return exit_code_;
  }

  Options options_;
  terminal::ProgressBar bar_;
  align::Problems problems_;
  align::Provenance provenance_;
  std::optional<alignment::batch_calibration::Phase> told_phase_;
  int exit_code_ = EXIT_SUCCESS;
};

}  // namespace

void add_align_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "align", "estimate how the radars are mounted and how wrong the speed signal is, from a recorded drive");
  const auto options = std::make_shared<Options>();
  command->add_option("--drive", options->drive,
                      "table of detections (t,radar,range,az,el,vr); \"-\" is standard input");
  command->add_option("--ego", options->ego, "table of ego motions (t,v,yaw_rate)");
  command->add_option("--recording", options->recordings,
                      "instead of tables: pcap, pcapng or candump log, as the vehicle's links have it; repeatable");
  command->add_option("--vehicle", options->vehicle, "vehicle file; for tables links may be left out in it")
      ->required();
  command->add_option("--method", options->method, "how to estimate")
      ->check(CLI::IsMember(align::method_names()))
      ->capture_default_str();
  command->add_option("--config", options->config, "settings, as alignment_estimator.toml (its method is overruled)");
  command->add_option("--truth", options->truth, "truth of a simulated drive, to be compared with");
  command->add_option("--json", options->json, "file for the result; \"-\" is standard output");
  command->add_option("--plot", options->plot, "SVG of how every parameter converged, and of the residuals");
  command->footer(
      "Exit codes: 0 done, 1 could not be read or written, or the result is doubtful (more than one line in a hundred\n"
      "left out, unknown radars, no detection, no ego motion), 2 wrong command line or configuration.");
  command->callback([options, &exit_code] {
    try {
      const bool has_tables = !options->drive.empty() && !options->ego.empty();
      const bool has_any_table = !options->drive.empty() || !options->ego.empty();
      if (options->recordings.empty() ? !has_tables : has_any_table) {
        throw UsageError("give either --drive and --ego, or --recording");
      }
      if (options->drive == "-" && options->ego == "-")
        throw UsageError("only one of the tables can be standard input");
      if (options->json == "-" && options->plot == "-") throw UsageError("only one result can go to standard output");
      exit_code = Align(*options).run();
    } catch (const std::exception& error) {
      tell(error.what());
      const bool usage = dynamic_cast<const UsageError*>(&error) != nullptr ||
                         dynamic_cast<const config::Error*>(&error) != nullptr ||
                         dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
      exit_code = usage ? kExitUsage : EXIT_FAILURE;
    }
  });
}

}  // namespace boresight
