// `boresight monitor`: the running system on the terminal.
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/monitor/accumulator.hpp"
#include "services/boresight/monitor/render.hpp"
#include "services/boresight/monitor/scan_record.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/node.hpp"

namespace boresight {

namespace {

constexpr std::int64_t kScreenPeriod_ns = 200'000'000;
constexpr std::int64_t kRecordPeriod_ns = 500'000'000;
constexpr std::int64_t kJsonPeriod_ns = 1'000'000'000;
constexpr std::int64_t kLinePeriod_ns = 3'000'000'000;

struct MonitorOptions {
  runtime::Configuration configuration;
  std::string json;  ///< file, "-" for standard output; empty: text
  std::string record_file;
  std::string scans_file;
  double duration_s = 0.0;
};

/// A record that grows by whole lines. The first error is kept until check(), so that the live view goes on.
class AppendedFile {
 public:
  /// An empty path is no file. Throws OutputError.
  explicit AppendedFile(const std::string& path) : path_(path) {
    if (path.empty()) return;
    errno = 0;
    stream_.open(path, std::ios::app);
    if (!stream_) throw terminal::OutputError(path, errno);
  }
  [[nodiscard]] bool is_open() const { return stream_.is_open(); }
  template <typename Write>
  void append(const Write& write) {
    if (!is_open() || error_ != 0) return;
    errno = 0;
    write(stream_);
    note_error();
  }
  void flush() {
    append([](std::ofstream& stream) { stream.flush(); });
  }
  /// Throws OutputError if anything was lost.
  void check() {
    flush();
    if (error_ != 0) throw terminal::OutputError(path_, error_);
  }

 private:
  void note_error() {
    if (!stream_) error_ = errno != 0 ? errno : EIO;
  }
  std::string path_;
  std::ofstream stream_;
  int error_ = 0;
};

/// Redraws in place: every line is cleared to its end, and the rest of a longer screen below.
void draw(const monitor::Snapshot& snapshot, double elapsed_s) {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  monitor::RenderOptions options{.colour = true, .width = known ? size.ws_col : 110U, .elapsed_s = elapsed_s};
  std::string text = "\x1b[H";
  for (const char c : monitor::render_screen(snapshot, options)) {
    if (c == '\n') text += "\x1b[K";
    text += c;
  }
  terminal::print(text + "\x1b[J");
}

int run_monitor(const MonitorOptions& options) {
  // Log lines would break the screen.
  setenv("BORESIGHT_LOG_LEVEL", "error", 0);
  runtime::log::initialise("boresight-monitor");
  const VehicleConfig vehicle = options.configuration.vehicle();
  monitor::Accumulator accumulator(vehicle);
  AppendedFile record(options.record_file), scans(options.scans_file);
  terminal::OutputFile output(options.json.empty() ? "-" : options.json);

  runtime::Node node(catalogue::Service::kMonitor, "-" + std::to_string(getpid()));
  node.on<AlignmentEstimate>([&](const AlignmentEstimate& m) { accumulator.observe(m); });
  node.on<HealthReport>([&](const HealthReport& m) { accumulator.observe(m); });
  node.on<ServiceStatus>([&](const ServiceStatus& m) { accumulator.observe(m); });
  node.on<EgoMotion>([&](const EgoMotion& m) { accumulator.observe(m); });
  node.on<RadarScan>([&](const RadarScan& m) { accumulator.observe(m, runtime::monotonic_now_ns()); });
  node.on<ClassifiedScan>([&](const ClassifiedScan& m) {
    accumulator.observe(m);
    scans.append([&m](std::ofstream& file) { monitor::write_scan(file, m); });
  });
  node.on<TrackList>([&](const TrackList& m) {
    accumulator.observe(m);
    scans.append([&m](std::ofstream& file) { monitor::write_tracks(file, m); });
  });

  const std::int64_t begin_ns = runtime::monotonic_now_ns();
  const auto elapsed_s = [begin_ns] { return static_cast<double>(runtime::monotonic_now_ns() - begin_ns) * 1e-9; };
  const auto snapshot = [&accumulator] { return accumulator.snapshot(runtime::monotonic_now_ns()); };
  const bool screen = options.json.empty() && isatty(STDOUT_FILENO) != 0;
  const auto show = [&] {
    if (screen) {
      draw(snapshot(), elapsed_s());
      return;
    }
    output.write((options.json.empty() ? monitor::render_line(snapshot(), elapsed_s()) : monitor::to_json(snapshot())) +
                 "\n");
    output.flush();
  };
  if (screen) terminal::print("\x1b[2J");
  node.every(!options.json.empty() ? kJsonPeriod_ns : (screen ? kScreenPeriod_ns : kLinePeriod_ns), show);
  if (record.is_open()) {
    node.every(kRecordPeriod_ns, [&] {
      record.append([&](std::ofstream& file) { monitor::write_record(file, snapshot()); });
      record.flush();
    });
  }
  if (options.duration_s > 0.0) {
    node.every(static_cast<std::int64_t>(options.duration_s * 1e9), [&node] { node.stop(); });
  }
  const int result = node.spin();
  if (screen) show();
  output.commit();
  record.append([&](std::ofstream& file) { monitor::write_record(file, snapshot()); });
  record.check();
  scans.check();
  return exit_code_after_signal(result);
}

}  // namespace

void add_monitor_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("monitor", "Shows the running system live: radars, alignment, health, tracks, latencies.");
  auto options = std::make_shared<MonitorOptions>();
  runtime::add_config_option(*command, options->configuration);
  runtime::add_vehicle_option(*command, options->configuration)->envname("BORESIGHT_VEHICLE");
  add_json_option(*command, options->json,
                  "A line of JSON each second instead of the screen; without FILE, or with \"-\": to standard output");
  command
      ->add_option("--record", options->record_file, "Appends two snapshots a second to FILE, for `boresight report`")
      ->type_name("FILE");
  command
      ->add_option("--record-scans", options->scans_file,
                   "Appends every classified scan and track list to FILE, for `boresight report --scans`; about 20 MB "
                   "a minute")
      ->type_name("FILE");
  command->add_option("--duration", options->duration_s, "Ends after so many seconds; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  on_call(
      *command, exit_code, {"monitor --vehicle demo --record record.txt", "ended after --duration or by SIGTERM", ""},
      [options] { return run_monitor(*options); }, &options->configuration);
}

}  // namespace boresight
