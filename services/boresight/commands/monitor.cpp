// `boresight monitor`: the running system on the terminal.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/monitor/accumulator.hpp"
#include "services/boresight/monitor/render.hpp"
#include "services/boresight/monitor/scan_record.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/node.hpp"
#include "services/common/runtime/options.hpp"

namespace boresight {

namespace {

constexpr std::int64_t kScreenPeriod_ns = 200'000'000;
constexpr std::int64_t kRecordPeriod_ns = 500'000'000;
constexpr std::int64_t kJsonPeriod_ns = 1'000'000'000;
constexpr std::int64_t kLinePeriod_ns = 3'000'000'000;

struct MonitorOptions {
  runtime::Configuration configuration{.directory = "/etc/boresight", .vehicle_name = {}};
  bool json = false;
  std::string record_file;
  std::string scans_file;
  double duration_s = 0.0;
};

void write_out(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

/// Redraws in place: every line is cleared to its end, and what is left of a longer picture below.
void draw(const monitor::Snapshot& snapshot, double elapsed_s) {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  monitor::RenderOptions options{.colour = true, .width = known ? size.ws_col : 110U, .elapsed_s = elapsed_s};
  std::string text = "\x1b[H";
  for (const char c : monitor::render_screen(snapshot, options)) {
    if (c == '\n') text += "\x1b[K";
    text += c;
  }
  write_out(text + "\x1b[J");
}

int run(const MonitorOptions& options) {
  // Log lines would tear the picture, and an onlooker may allocate as it likes.
  setenv("BORESIGHT_LOG_LEVEL", "error", 0);
  runtime::log::initialise("boresight-monitor");
  const VehicleConfig vehicle = options.configuration.vehicle();
  monitor::Accumulator accumulator(vehicle);
  std::ofstream record, scans;
  const auto open = [](std::ofstream& file, const std::string& path) {
    if (path.empty()) return;
    file.open(path, std::ios::app);
    if (!file) throw std::runtime_error("cannot write " + path);
  };
  open(record, options.record_file);
  open(scans, options.scans_file);

  runtime::Node node(catalogue::Service::kMonitor, "-" + std::to_string(getpid()));
  node.on<AlignmentEstimate>([&](const AlignmentEstimate& m) { accumulator.observe(m); });
  node.on<HealthReport>([&](const HealthReport& m) { accumulator.observe(m); });
  node.on<ServiceStatus>([&](const ServiceStatus& m) { accumulator.observe(m); });
  node.on<EgoMotion>([&](const EgoMotion& m) { accumulator.observe(m); });
  node.on<RadarScan>([&](const RadarScan& m) { accumulator.observe(m, runtime::monotonic_now_ns()); });
  node.on<ClassifiedScan>([&](const ClassifiedScan& m) {
    accumulator.observe(m);
    if (scans.is_open()) monitor::write_scan(scans, m);
  });
  node.on<TrackList>([&](const TrackList& m) {
    accumulator.observe(m);
    if (scans.is_open()) monitor::write_tracks(scans, m);
  });

  const std::int64_t begin_ns = runtime::monotonic_now_ns();
  const auto elapsed_s = [begin_ns] { return static_cast<double>(runtime::monotonic_now_ns() - begin_ns) * 1e-9; };
  const auto snapshot = [&accumulator] { return accumulator.snapshot(runtime::monotonic_now_ns()); };
  const bool screen = !options.json && isatty(STDOUT_FILENO) != 0;
  const auto show = [&] {
    if (options.json) {
      write_out(monitor::to_json(snapshot()) + "\n");
    } else if (screen) {
      draw(snapshot(), elapsed_s());
    } else {
      write_out(monitor::render_line(snapshot(), elapsed_s()) + "\n");
    }
  };
  if (screen) write_out("\x1b[2J");
  node.every(options.json ? kJsonPeriod_ns : (screen ? kScreenPeriod_ns : kLinePeriod_ns), show);
  if (record.is_open()) {
    node.every(kRecordPeriod_ns, [&] {
      monitor::write_record(record, snapshot());
      record.flush();
    });
  }
  if (options.duration_s > 0.0) {
    node.every(static_cast<std::int64_t>(options.duration_s * 1e9), [&node] { node.stop(); });
  }
  const int exit_code = node.spin();
  if (screen) show();
  if (record.is_open()) monitor::write_record(record, snapshot());
  const auto check_written = [](std::ofstream& file, const std::string& path) {
    if (file.is_open() && !file.flush())
      throw std::runtime_error("cannot write " + path + ": what it holds is not whole");
  };
  check_written(record, options.record_file);
  check_written(scans, options.scans_file);
  return exit_code;
}

}  // namespace

void add_monitor_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("monitor", "live view of the running system: radars, alignment, health, tracks, latencies");
  auto options = std::make_shared<MonitorOptions>();
  command->add_option("--config", options->configuration.directory, "folder with vehicle/ and services/")
      ->capture_default_str();
  command->add_option("--vehicle", options->configuration.vehicle_name, "vehicle file to use, without .toml")
      ->envname("BORESIGHT_VEHICLE");
  command->add_flag("--json", options->json, "one line of JSON a second instead of a picture");
  command->add_option("--record", options->record_file, "append what is seen to this file, for `boresight report`");
  command->add_option(
      "--record-scans", options->scans_file,
      "append every classified scan and track list to this file, for `boresight report --scans`; some 20 "
      "MB a minute");
  command->add_option("--duration", options->duration_s, "seconds after which to stop; 0 is never")
      ->check(CLI::NonNegativeNumber);
  command->callback([options, &exit_code] {
    try {
      exit_code = run(*options);
    } catch (const config::Error& error) {
      std::cerr << error.what() << '\n';
      exit_code = 2;
    } catch (const std::exception& error) {
      std::cerr << "boresight monitor: " << error.what() << '\n';
      exit_code = 1;
    }
  });
}

}  // namespace boresight
