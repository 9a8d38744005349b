// `boresight decode`: what the gateway understands of recordings, as a table or as a verdict.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/decode/csv.hpp"
#include "services/boresight/decode/decode_sink.hpp"
#include "services/boresight/decode/made_up_vehicle.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/options.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"

namespace boresight {

namespace {

constexpr int kExitUsage = 2, kExitDamaged = 3;
constexpr std::uint64_t kProblemsShown = 20;

struct Options {
  std::vector<std::filesystem::path> files;
  std::string profile;
  std::string interface;
  std::uint32_t sensor_id = 0;
  std::string mapping;
  runtime::Configuration configuration{.directory = "/etc/boresight", .vehicle_name = {}};
  bool csv = false, ego = false, check = false;
  std::string out = "-";
};

/// A command line that contradicts itself.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

recording::ReadOptions read_options(const Options& options) {
  return {.can_interface = options.interface.empty() ? "can0" : options.interface};
}

VehicleConfig vehicle_of(const Options& options) {
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
        options.files, [](const std::string&) {}, read_options(options));
    made_up.senders = decode::find_senders(*reader, made_up.profile);
  }
  if (made_up.profile == RadarProfile::kBoresight && made_up.senders.radars.empty()) {
    throw UsageError(can_be_read_twice ? "no detection list of a Boresight service among the first datagrams"
                                       : "--profile boresight looks for the service first: give a file, or --vehicle");
  }
  return decode::made_up_vehicle(made_up);
}

/// Text to a file or to standard output; every failure to write is an error.
class Output {
 public:
  explicit Output(const std::string& file)
      : name_(file == "-" ? "standard output" : file),
        stream_(file == "-" ? stdout : std::fopen(file.c_str(), "we")),
        owned_(file != "-") {
    if (stream_ == nullptr) fail();
  }
  ~Output() {
    if (owned_) std::fclose(stream_);
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  void write(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stream_) != text.size()) fail();
  }
  void flush() {
    if (std::fflush(stream_) != 0) fail();
  }

 private:
  [[noreturn]] void fail() const { throw std::runtime_error(name_ + ": " + std::strerror(errno)); }
  std::string name_;
  std::FILE* stream_;
  bool owned_;
};

void show_progress(terminal::ProgressBar& bar, const recording::Reader& reader, double took_s) {
  const recording::Progress progress = reader.progress();
  const double position = static_cast<double>(progress.position_bytes);
  const double share = progress.total_bytes == 0 ? -1.0 : position / static_cast<double>(progress.total_bytes);
  const double left_s = share > 0.0 ? took_s * (1.0 - share) / share : 0.0;
  bar.show(share, fmt::format("{:.0f} MB, {:.0f} MB/s{}", position * 1e-6, position * 1e-6 / took_s,
                              share > 0.0 ? fmt::format(", {:.0f} s left", left_s) : ""));
}

int run(const Options& options) {
  if (int{options.csv} + int{options.ego} + int{options.check} != 1) {
    throw UsageError("give one of --csv, --ego and --check");
  }
  const VehicleConfig vehicle = vehicle_of(options);
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
  const auto reader = recording::open_recordings(options.files, tell, read_options(options));
  Output output(options.out);
  std::string& rows = sink.rows();
  if (options.csv) rows += decode::detection_header();
  if (options.ego) rows += decode::ego_header();

  constexpr std::size_t kEnoughText = 1 << 20;
  constexpr std::uint64_t kFramesBetweenLooks = 256;
  const auto begin = std::chrono::steady_clock::now();
  recording::Frame frame;
  for (std::uint64_t frames = 1; reader->next(frame); ++frames) {
    // The recording's own clock is the only one, so that the result depends on nothing else.
    gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
    if (rows.size() > kEnoughText) {
      output.write(rows);
      rows.clear();
    }
    if (frames % kFramesBetweenLooks == 0 && bar.is_due()) {
      show_progress(bar, *reader, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
  }
  gateway.finish();
  bar.wipe();
  if (problems > kProblemsShown) {
    std::fprintf(stderr, "… and %llu more problems\n", static_cast<unsigned long long>(problems - kProblemsShown));
  }
  bool damaged = false;
  const std::string report = sink.check().report(sink.all_statistics(), reader->counts(), damaged);
  output.write(options.check ? report : rows);
  output.flush();
  if (!options.check) std::fputs(report.c_str(), stderr);
  return options.check && damaged ? kExitDamaged : EXIT_SUCCESS;
}

}  // namespace

void add_decode_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("decode", "decode recordings (candump logs, pcap, pcapng) as the ingest gateway does");
  const auto options = std::make_shared<Options>();
  std::vector<std::string> names;
  for (const auto& [name, profile] : decode::profiles()) names.push_back(name);
  command->add_option("files", options->files, "recordings, merged by time; \"-\" is standard input")->required();
  command->add_option("--profile", options->profile, "radars of that protocol, from any sender, without a vehicle file")
      ->check(CLI::IsMember(names));
  command->add_option(
      "--interface", options->interface,
      "CAN interface to listen to with --profile (else any); also the one that captures lack a name of");
  command->add_option("--sensor-id", options->sensor_id, "of an ARS408 with --profile")
      ->check(CLI::Range(0u, 7u))
      ->capture_default_str();
  command->add_option("--mapping", options->mapping, "mapping file of --profile mapping");
  command->add_option("--vehicle", options->configuration.vehicle_name, "the radars and ego signals of a vehicle file");
  command->add_option("--config", options->configuration.directory, "folder with vehicle/ and services/")
      ->capture_default_str();
  command->add_flag("--csv", options->csv, "a row for each detection");
  command->add_flag("--ego", options->ego, "a row for each ego motion");
  command->add_flag("--check", options->check, "tell whether the recording is sound or damaged, and why");
  command->add_option("--out", options->out, "file to write; \"-\" is standard output")->capture_default_str();
  command->footer(
      "Exit codes: 0 decoded (--check: sound), 1 could not be read or written, 2 wrong command line,\n"
      "3 --check: damaged.");
  command->callback([options, &exit_code] {
    try {
      exit_code = run(*options);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "boresight decode: %s\n", error.what());
      const bool usage =
          dynamic_cast<const UsageError*>(&error) != nullptr || dynamic_cast<const config::Error*>(&error) != nullptr;
      exit_code = usage ? kExitUsage : EXIT_FAILURE;
    }
  });
}

}  // namespace boresight
