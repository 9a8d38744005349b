// `boresight monitor`: the running system on the terminal.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/live_record.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/monitor/accumulator.hpp"
#include "services/boresight/monitor/render.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/node.hpp"
#include "services/common/runtime/stop_signal.hpp"

namespace boresight {

namespace {

constexpr std::int64_t kScreenPeriod_ns = 200'000'000;
constexpr std::int64_t kRecordPeriod_ns = 500'000'000;
constexpr std::int64_t kJsonPeriod_ns = 1'000'000'000;
constexpr std::int64_t kLinePeriod_ns = 3'000'000'000;

struct MonitorOptions {
  runtime::Configuration configuration;
  std::string json;              ///< file, "-" for standard output; empty: text
  std::filesystem::path record;  ///< run folder; empty: none
  double duration_s = 0.0;
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

/// Says once what the monitor waits for if RouDi cannot be reached for a while: log lines are switched off. The node
/// goes on waiting.
void say_if_roudi_is_absent() {
  constexpr std::int64_t kSilent_ns = 2'000'000'000;  // choice: RouDi of `boresight supervise` takes less than a second
  runtime::install_stop_signals();
  const std::int64_t begin_ns = runtime::monotonic_now_ns();
  while (!runtime::Node::roudi_is_reachable()) {
    if (runtime::stop_signalled()) return;
    if (runtime::monotonic_now_ns() - begin_ns >= kSilent_ns) {
      std::fprintf(stderr,
                   "boresight monitor: waiting for RouDi; `boresight supervise` starts RouDi and the services\n");
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

int run_monitor(const MonitorOptions& options) {
  // Log lines would break the screen.
  setenv("BORESIGHT_LOG_LEVEL", "error", 0);
  runtime::log::initialise("boresight-monitor");
  const VehicleConfig vehicle = options.configuration.vehicle();
  monitor::Accumulator accumulator(vehicle);
  std::optional<LiveRecord> record;
  if (!options.record.empty()) record.emplace(options.record, vehicle);
  terminal::OutputFile output(options.json.empty() ? "-" : options.json);

  say_if_roudi_is_absent();
  runtime::Node node(catalogue::Service::kMonitor, "-" + std::to_string(getpid()));
  const auto observe = [&](const auto& message) {
    accumulator.observe(message);
    if (record) record->observe(message);
  };
  // A scan before its results, so that few scans are incomplete at a time.
  node.on<EgoMotion>(observe);
  node.on<RadarScan>([&](const RadarScan& m) {
    accumulator.observe(m, runtime::monotonic_now_ns());
    if (record) record->observe(m);
  });
  node.on<ClassifiedScan>(observe);
  node.on<TrackList>(observe);
  node.on<AlignmentEstimate>(observe);
  node.on<HealthReport>(observe);
  node.on<ServiceStatus>([&](const ServiceStatus& m) { accumulator.observe(m); });

  const std::int64_t begin_ns = runtime::monotonic_now_ns();
  const auto elapsed_s = [begin_ns] { return static_cast<double>(runtime::monotonic_now_ns() - begin_ns) * 1e-9; };
  const auto snapshot = [&accumulator] { return accumulator.snapshot(runtime::monotonic_now_ns()); };
  const bool screen = options.json.empty() && isatty(STDOUT_FILENO) != 0;
  const auto show = [&] {
    if (screen) {
      draw(snapshot(), elapsed_s());
      return;
    }
    output.write(options.json.empty() ? monitor::render_line(snapshot(), elapsed_s()) + "\n"
                                      : monitor::to_json(snapshot()));
    output.flush();
  };
  if (screen) terminal::print("\x1b[2J");
  node.every(!options.json.empty() ? kJsonPeriod_ns : (screen ? kScreenPeriod_ns : kLinePeriod_ns), show);
  if (record) node.every(kRecordPeriod_ns, [&] { record->add(snapshot()); });
  if (options.duration_s > 0.0) {
    node.every(static_cast<std::int64_t>(options.duration_s * 1e9), [&node] { node.stop(); });
  }
  const int result = node.spin();
  if (screen) show();
  output.commit();
  if (record) {
    record->add(snapshot());
    record->finish(options.configuration, vehicle);
  }
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
      ->add_option("--record", options->record,
                   "Run folder for `boresight report` and `boresight score`: every scan with its results, and two "
                   "snapshots a second. A record in it is continued")
      ->type_name("DIR");
  command->add_option("--duration", options->duration_s, "Ends after so many seconds; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  on_call(
      *command, exit_code, {"monitor --vehicle demo --record run", "ended after --duration or by SIGTERM", ""},
      [options] { return run_monitor(*options); }, &options->configuration);
}

}  // namespace boresight
