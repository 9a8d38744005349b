// `boresight record`: live input into recordings.
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/record/capture_error.hpp"
#include "services/boresight/record/recorder.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/options.hpp"
#include "services/common/runtime/stop_signal.hpp"

namespace boresight {

namespace {

constexpr int kExitLost = 1, kExitUsage = 2;

struct Options {
  std::vector<std::string> can;
  std::vector<std::string> interfaces;
  std::string filter;
  runtime::Configuration configuration{.directory = "/etc/boresight", .vehicle_name = {}};
  std::string out;
  double duration_s = std::numeric_limits<double>::infinity();
  double max_size_mb = std::numeric_limits<double>::infinity();
};

record::CapturePlan plan_of(const Options& options) {
  if (options.can.empty() && options.interfaces.empty() && options.configuration.vehicle_name.empty()) {
    throw record::CaptureError("nothing to record: give --can, --interface or --vehicle");
  }
  if (!options.filter.empty() && options.interfaces.empty()) {
    throw record::CaptureError("--filter is for --interface");
  }
  record::CapturePlan plan;
  if (!options.configuration.vehicle_name.empty()) plan = record::plan_of(options.configuration.vehicle());
  for (const std::string& can : options.can) {
    if (std::find(plan.can.begin(), plan.can.end(), can) == plan.can.end()) plan.can.push_back(can);
  }
  for (const std::string& interface : options.interfaces) {
    // What the command line says of an interface replaces what the vehicle file says.
    std::erase_if(plan.packets, [&](const record::PacketSource& source) { return source.interface == interface; });
    plan.packets.push_back({interface, options.filter, {}});
  }
  return plan;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 20> text{};
  std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%SZ", &parts);
  return text.data();
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string rates(const record::Totals& now, const record::Totals& before, double took_s) {
  return fmt::format("{} frames, {:.1f} MB; {:.0f} frames/s, {:.3f} MB/s{}", now.frames,
                     static_cast<double>(now.bytes) * 1e-6, static_cast<double>(now.frames - before.frames) / took_s,
                     static_cast<double>(now.bytes - before.bytes) * 1e-6 / took_s,
                     now.dropped > 0 ? fmt::format("; {} DROPPED", now.dropped) : "");
}

int run(const Options& options) {
  runtime::install_stop_signals();
  const record::CapturePlan plan = plan_of(options);
  terminal::ProgressBar bar("recording");
  record::Recorder recorder(plan, options.out, utc_now(), [&bar](const std::string& problem) {
    bar.wipe();
    std::fprintf(stderr, "boresight record: %s\n", problem.c_str());
  });
  const auto begin = std::chrono::steady_clock::now();
  for (const record::FileSummary& file : recorder.summaries()) {
    std::fprintf(stderr, "recording %s into %s; Ctrl-C ends\n", file.what.c_str(), file.file.c_str());
  }
  constexpr int kTurn_ms = 50;
  record::Totals last;
  double last_s = 0.0;
  std::string why = "Ctrl-C";
  while (!runtime::stop_signalled()) {
    const double left_s = options.duration_s - seconds_since(begin);
    if (left_s <= 0.0) {
      why = "duration reached";
      break;
    }
    if (static_cast<double>(recorder.totals().bytes) >= options.max_size_mb * 1e6) {
      why = "size reached";
      break;
    }
    recorder.turn(std::min(kTurn_ms, static_cast<int>(std::min(left_s, 1.0) * 1000.0) + 1));
    const double now_s = seconds_since(begin);
    if (now_s - last_s < 1.0) continue;
    recorder.each_second();
    const record::Totals totals = recorder.totals();
    bar.show(-1.0, rates(totals, last, now_s - last_s));
    last = totals;
    last_s = now_s;
  }
  // What libpcap still holds back in its buffer comes within its timeout.
  constexpr int kDrainTurns = 3;
  for (int i = 0; i < kDrainTurns; ++i) recorder.turn(kTurn_ms);
  recorder.each_second();
  bar.wipe();
  for (const record::FileSummary& file : recorder.summaries()) {
    fmt::print("{}: {} frames of {}, {} bytes, {} dropped by the kernel\n", file.file, file.totals.frames, file.what,
               file.totals.bytes, file.totals.dropped);
  }
  const record::Totals totals = recorder.totals();
  fmt::print("{} after {:.1f} s: {}\n", why, seconds_since(begin), rates(totals, {}, seconds_since(begin)));
  return totals.dropped > 0 || recorder.interruptions() > 0 ? kExitLost : EXIT_SUCCESS;
}

}  // namespace

void add_record_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "record", "record live CAN and network input into files that decode, demo, can-utils and tshark read");
  const auto options = std::make_shared<Options>();
  command->add_option("--can", options->can, "CAN interfaces, into a candump log");
  command->add_option("--interface", options->interfaces, "network interfaces (or \"any\"), each into a pcap file");
  command->add_option("--filter", options->filter,
                      "what to record of --interface, in tcpdump's language; beware: only first fragments have ports");
  command->add_option("--vehicle", options->configuration.vehicle_name,
                      "record what this vehicle's radars and ego signals come from");
  command->add_option("--config", options->configuration.directory, "folder with vehicle/ and services/")
      ->capture_default_str();
  command->add_option("--out", options->out, "folder, or one file (.log for CAN, .pcap for packets)")->required();
  command->add_option("--duration", options->duration_s, "seconds; else until Ctrl-C")->check(CLI::PositiveNumber);
  command->add_option("--max-size", options->max_size_mb, "end at that many MB in all")->check(CLI::PositiveNumber);
  command->footer(
      "Exit codes: 0 all was recorded, 1 frames were dropped or an interface was lost for a while,\n"
      "2 nothing could be recorded.");
  command->callback([options, &exit_code] {
    try {
      exit_code = run(*options);
    } catch (const recording::WriteError& error) {
      std::fprintf(stderr, "boresight record: %s\n", error.what());
      exit_code = kExitLost;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "boresight record: %s\n", error.what());
      exit_code = kExitUsage;
    }
  });
}

}  // namespace boresight
