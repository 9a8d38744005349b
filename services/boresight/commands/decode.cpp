// `boresight decode`: what the gateway understands of recordings, as a table or as a verdict.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/decode/csv.hpp"
#include "services/boresight/decode/decode_sink.hpp"
#include "services/boresight/decode/made_up_vehicle.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/common/recording/reader.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"

namespace boresight {

namespace {

constexpr std::uint64_t kProblemsShown = 20;

struct DecodeOptions {
  std::vector<std::filesystem::path> files;
  std::string profile;
  std::string interface;
  std::uint32_t sensor_id = 0;
  std::string mapping;
  runtime::Configuration configuration;
  bool csv = false, ego = false, check = false;
  std::string out = "-";
};

recording::ReadOptions decode_read_options(const DecodeOptions& options) {
  return {.can_interface = options.interface.empty() ? "can0" : options.interface};
}

VehicleConfig decode_vehicle(const DecodeOptions& options) {
  if (options.profile.empty() == options.configuration.vehicle_name.empty()) {
    throw UsageError("give either --profile or --vehicle");
  }
  if (options.profile.empty()) return options.configuration.vehicle();
  decode::MadeUp made_up{.interface = options.interface, .sensor_id = options.sensor_id, .mapping = options.mapping};
  for (const auto& [name, profile] : decode::profiles()) {
    if (name == options.profile) made_up.profile = profile;
  }
  if ((made_up.profile == RadarProfile::kMapping) == options.mapping.empty()) {
    throw UsageError("--profile mapping and --mapping belong together");
  }
  const bool can_be_read_twice = std::find(options.files.begin(), options.files.end(), "-") == options.files.end();
  const bool has_senders = made_up.profile == RadarProfile::kArs548 || made_up.profile == RadarProfile::kBoresight;
  if (has_senders && can_be_read_twice) {
    const auto reader = recording::open_recordings(
        options.files, [](const std::string&) {}, decode_read_options(options));
    made_up.senders = decode::find_senders(*reader, made_up.profile);
  }
  if (made_up.profile == RadarProfile::kBoresight && made_up.senders.radars.empty()) {
    throw UsageError(
        can_be_read_twice
            ? "no detection list of a Boresight service is among the first datagrams"
            : "--profile boresight searches the recording for the service first: give a file, or --vehicle");
  }
  return decode::made_up_vehicle(made_up);
}

void show_decode_progress(terminal::ProgressBar& bar, const recording::Reader& reader, double took_s) {
  const recording::Progress progress = reader.progress();
  const double position = static_cast<double>(progress.position_bytes);
  const double share = progress.total_bytes == 0 ? -1.0 : position / static_cast<double>(progress.total_bytes);
  const double left_s = share > 0.0 ? took_s * (1.0 - share) / share : 0.0;
  bar.show(share, fmt::format("{:.0f} MB, {:.0f} MB/s{}", position * 1e-6, position * 1e-6 / took_s,
                              share > 0.0 ? fmt::format(", {:.0f} s left", left_s) : ""));
}

int run_decode(const DecodeOptions& options) {
  if (int{options.csv} + int{options.ego} + int{options.check} != 1) {
    throw UsageError("give one of --csv, --ego and --check");
  }
  const VehicleConfig vehicle = decode_vehicle(options);
  decode::DecodeSink sink(options.csv   ? decode::Table::kDetections
                          : options.ego ? decode::Table::kEgo
                                        : decode::Table::kNone);
  for (const RadarConfig& radar : vehicle.radars) sink.check().add_source(radar.id, radar.name);
  ingest::Gateway gateway(vehicle, sink, ingest::read_mappings(vehicle));

  terminal::ProgressBar bar("decoding");
  std::uint64_t problems = 0;
  const auto tell = [&](const std::string& problem) {
    if (++problems > kProblemsShown) return;
    bar.wipe();
    std::fprintf(stderr, "%s\n", problem.c_str());
  };
  const auto reader = recording::open_recordings(options.files, tell, decode_read_options(options));
  terminal::OutputFile output(options.out);
  std::string& rows = sink.rows();
  if (options.csv) rows += decode::detection_header();
  if (options.ego) rows += decode::ego_header();

  constexpr std::size_t kEnoughText = 1 << 20;
  constexpr std::uint64_t kFramesBetweenLooks = 256;
  const auto begin = std::chrono::steady_clock::now();
  recording::Frame frame;
  for (std::uint64_t frames = 1; !runtime::stop_signalled() && reader->next(frame); ++frames) {
    // The recording's own clock is the only one, so that the result depends on nothing else.
    gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
    if (rows.size() > kEnoughText) {
      output.write(rows);
      rows.clear();
    }
    if (frames % kFramesBetweenLooks == 0 && bar.is_due()) {
      show_decode_progress(bar, *reader,
                           std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
  }
  bar.wipe();
  if (runtime::stop_signalled()) {
    // Standard output ends at a complete row; a file is not kept.
    if (options.out == "-" && !options.check) {
      output.write(rows);
      output.commit();
    }
    throw Interrupted{};
  }
  gateway.finish();
  if (problems > kProblemsShown) {
    std::fprintf(stderr, "… and %llu more problems\n", static_cast<unsigned long long>(problems - kProblemsShown));
  }
  bool damaged = false;
  const std::string report = sink.check().report(sink.all_statistics(), reader->counts(), damaged);
  output.write(options.check ? report : rows);
  output.commit();
  if (!options.check) std::fputs(report.c_str(), stderr);
  return options.check && damaged ? exit_code::kFinding : exit_code::kSuccess;
}

}  // namespace

void add_decode_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "decode", "Decodes recordings (candump logs, pcap, pcapng) with the decoders of the ingest gateway.");
  const auto options = std::make_shared<DecodeOptions>();
  std::vector<std::string> names;
  for (const auto& [name, profile] : decode::profiles()) names.push_back(name);
  command->add_option("files", options->files, "Recordings, merged by time; \"-\": standard input")
      ->type_name("FILE")
      ->required();
  command->add_option("--profile", options->profile, "Protocol of the radars, from any sender; needs no vehicle file")
      ->check(CLI::IsMember(names));
  command
      ->add_option(
          "--interface", options->interface,
          "For --profile: the CAN interface, else any; also the name of CAN interfaces in captures without one")
      ->type_name("NAME");
  command->add_option("--sensor-id", options->sensor_id, "For --profile ars408: the radar's sensor id")
      ->check(CLI::Range(0u, 7u))
      ->type_name("ID")
      ->capture_default_str();
  command->add_option("--mapping", options->mapping, "For --profile mapping: the mapping file")->type_name("FILE");
  runtime::add_vehicle_option(
      *command, options->configuration,
      "Instead of --profile: the radars and ego signals of a vehicle, by its name in the folder "
      "vehicle/ or by its file");
  runtime::add_config_option(*command, options->configuration);
  command->add_flag("--csv", options->csv, "Prints a row of CSV for each detection");
  command->add_flag("--ego", options->ego, "Prints a row of CSV for each ego motion");
  command->add_flag("--check", options->check, "Reports whether the recording is sound or damaged, with the reasons");
  command->add_option("--out", options->out, "File for the rows or the report; \"-\": standard output")
      ->type_name("FILE")
      ->capture_default_str();
  on_call(
      *command, exit_code,
      {"decode --profile ars548 --csv drive.pcap\n"
       "decode --vehicle demo --check radars.pcap ego.candump.log",
       "decoded; with --check: the recording is sound", "with --check: the recording is damaged"},
      [options] { return run_decode(*options); }, &options->configuration);
}

}  // namespace boresight
