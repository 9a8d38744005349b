// `boresight record`: live input into recordings.
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/record/capture_error.hpp"
#include "services/boresight/record/recorder.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/common/runtime/stop_signal.hpp"

namespace boresight {

namespace {

struct RecordOptions {
  std::vector<std::string> can;
  std::vector<std::string> interfaces;
  std::string filter;
  runtime::Configuration configuration;
  std::string out;
  double duration_s = std::numeric_limits<double>::infinity();
  double max_size_mb = std::numeric_limits<double>::infinity();
};

record::CapturePlan capture_plan(const RecordOptions& options) {
  if (options.can.empty() && options.interfaces.empty() && options.configuration.vehicle_name.empty()) {
    throw UsageError("nothing to record: give --can, --interface or --vehicle");
  }
  if (!options.filter.empty() && options.interfaces.empty()) {
    throw UsageError("--filter is for --interface");
  }
  record::CapturePlan plan;
  if (!options.configuration.vehicle_name.empty()) plan = record::plan_of(options.configuration.vehicle());
  for (const std::string& can : options.can) {
    if (std::find(plan.can.begin(), plan.can.end(), can) == plan.can.end()) plan.can.push_back(can);
  }
  for (const std::string& interface : options.interfaces) {
    // The command line overrides the vehicle file.
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

double record_seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string record_rates(const record::Totals& now, const record::Totals& before, double took_s) {
  return fmt::format("{} frames, {:.1f} MB; {:.0f} frames/s, {:.3f} MB/s{}", now.frames,
                     static_cast<double>(now.bytes) * 1e-6, static_cast<double>(now.frames - before.frames) / took_s,
                     static_cast<double>(now.bytes - before.bytes) * 1e-6 / took_s,
                     now.dropped > 0 ? fmt::format("; {} DROPPED", now.dropped) : "");
}

/// Gives the files of a failed recording a name that does not look complete.
void mark_as_partial(const std::vector<record::FileSummary>& files) {
  for (const record::FileSummary& file : files) {
    std::error_code ignored;
    std::filesystem::rename(file.file, file.file + ".partial", ignored);
    if (!ignored)
      std::fprintf(stderr, "boresight record: %s.partial holds what was recorded until then\n", file.file.c_str());
  }
}

/// Records until the duration or the size is reached or a signal comes; returns which.
std::string record_until_end(record::Recorder& recorder, const RecordOptions& options, terminal::ProgressBar& bar,
                             std::chrono::steady_clock::time_point begin) {
  constexpr int kTurn_ms = 50;
  record::Totals last;
  double last_s = 0.0;
  while (!runtime::stop_signalled()) {
    const double left_s = options.duration_s - record_seconds_since(begin);
    if (left_s <= 0.0) return "duration reached";
    if (static_cast<double>(recorder.totals().bytes) >= options.max_size_mb * 1e6) return "size reached";
    recorder.turn(std::min(kTurn_ms, static_cast<int>(std::min(left_s, 1.0) * 1000.0) + 1));
    const double now_s = record_seconds_since(begin);
    if (now_s - last_s < 1.0) continue;
    recorder.each_second();
    const record::Totals totals = recorder.totals();
    bar.show(-1.0, record_rates(totals, last, now_s - last_s));
    last = totals;
    last_s = now_s;
  }
  return runtime::stop_signal() == SIGINT ? "Ctrl-C" : "SIGTERM";
}

int run_record(const RecordOptions& options) {
  const record::CapturePlan plan = capture_plan(options);
  terminal::ProgressBar bar("recording");
  record::Recorder recorder(plan, options.out, utc_now(), [&bar](const std::string& problem) {
    bar.wipe();
    std::fprintf(stderr, "boresight record: %s\n", problem.c_str());
  });
  const auto begin = std::chrono::steady_clock::now();
  for (const record::FileSummary& file : recorder.summaries()) {
    std::fprintf(stderr, "recording %s into %s; Ctrl-C ends\n", file.what.c_str(), file.file.c_str());
  }
  std::string why;
  try {
    why = record_until_end(recorder, options, bar, begin);
    // What libpcap still holds back in its buffer comes within its timeout.
    constexpr int kDrainTurns = 3, kDrain_ms = 50;
    for (int i = 0; i < kDrainTurns; ++i) recorder.turn(kDrain_ms);
    recorder.each_second();
  } catch (const recording::WriteError&) {
    bar.wipe();
    mark_as_partial(recorder.summaries());
    throw;
  }
  bar.wipe();
  std::string text;
  for (const record::FileSummary& file : recorder.summaries()) {
    text += fmt::format("{}: {} frames of {}, {} bytes, {} dropped by the kernel\n", file.file, file.totals.frames,
                        file.what, file.totals.bytes, file.totals.dropped);
  }
  const record::Totals totals = recorder.totals();
  text += fmt::format("{} after {:.1f} s: {}\n", why, record_seconds_since(begin),
                      record_rates(totals, {}, record_seconds_since(begin)));
  terminal::print(text);
  const bool has_loss = totals.dropped > 0 || recorder.interruptions() > 0;
  return exit_code_after_signal(has_loss ? exit_code::kFinding : exit_code::kSuccess);
}

}  // namespace

void add_record_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "record", "Records live CAN and network input into files that decode, demo, can-utils and tshark read.");
  const auto options = std::make_shared<RecordOptions>();
  command->add_option("--can", options->can, "CAN interface, recorded into a candump log; repeatable")
      ->type_name("NAME");
  command
      ->add_option("--interface", options->interfaces,
                   "Network interface, or \"any\", recorded into a pcap file; repeatable")
      ->type_name("NAME");
  command
      ->add_option("--filter", options->filter,
                   "Filter of --interface in the language of tcpdump; only first fragments have ports")
      ->type_name("TEXT");
  runtime::add_vehicle_option(*command, options->configuration,
                              "Records the sources of this vehicle's radars and ego signals: a name in the folder "
                              "vehicle/, or a file");
  runtime::add_config_option(*command, options->configuration);
  command->add_option("--out", options->out, "Folder, or one file: .log for CAN, .pcap for packets")
      ->type_name("FILE|DIR")
      ->required();
  command->add_option("--duration", options->duration_s, "Ends after so many seconds; otherwise Ctrl-C ends")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  command->add_option("--max-size", options->max_size_mb, "Ends at so many MB in all files together")
      ->check(CLI::PositiveNumber)
      ->type_name("MB");
  on_call(
      *command, exit_code,
      {"record --vehicle demo --out drive\n"
       "record --can can0 --out drive.log --duration 60",
       "everything was recorded", "the kernel dropped frames, or an interface was lost for a while"},
      [options] { return run_record(*options); }, &options->configuration);
}

}  // namespace boresight
