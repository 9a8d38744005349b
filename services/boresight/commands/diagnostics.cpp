// `boresight diagnostics`: what the health service says by DDS, from anywhere on the network.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/diagnostics/diagnostics_text.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/health/dds/diagnostics_reader.hpp"

namespace boresight {

namespace {

struct DiagnosticsOptions {
  dds::Config dds;
  std::string security;  ///< folder; empty: an open domain
  bool array = false;
  bool all = false;
  std::string json;  ///< file, "-" for standard output; empty: text
  std::uint64_t count = 0;
  double seconds = 0.0;
};

/// Writes lines from the threads of the middleware, one after the other. An error is kept for the main thread.
class LinePrinter {
 public:
  explicit LinePrinter(const std::string& file) : output_(file) {}
  /// `text` ends with a line feed.
  void print(const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (failed_) return;
    try {
      output_.write(text);
      output_.flush();  // the reader of a pipe shall not wait
      ++printed_;
    } catch (const terminal::OutputError&) {
      error_ = std::current_exception();
      failed_ = true;
    }
  }
  [[nodiscard]] std::uint64_t printed() const { return printed_; }
  [[nodiscard]] bool failed() const { return failed_; }
  /// Throws OutputError if a line could not be written.
  void commit() {
    const std::lock_guard lock(mutex_);
    if (error_) std::rethrow_exception(error_);
    output_.commit();
  }

 private:
  std::mutex mutex_;
  terminal::OutputFile output_;
  std::exception_ptr error_;
  std::atomic<std::uint64_t> printed_ = 0;
  std::atomic<bool> failed_ = false;
};

/// Whether the state of a radar differs from the one before; numbers that always change do not count.
class StateChanges {
 public:
  bool observe(const diagnostics::SensorHealth& s) {
    const Verdict verdict(s.data_qualifier(), s.extended_qualifier(), s.finding(), s.drift().since_ns() != 0,
                          s.load_change().time_ns(), s.speed_change().time_ns());
    const auto [known, is_first] = verdicts_.try_emplace({s.vehicle_name(), s.radar_id()}, verdict);
    const bool changed = is_first || known->second != verdict;
    known->second = verdict;
    return changed;
  }

 private:
  using Radar = std::pair<std::string, std::uint32_t>;
  /// Qualifiers, wrong input, whether the mounting drifts, times of the vehicle's changes.
  using Verdict = std::tuple<diagnostics::DataQualifier, diagnostics::ExtendedQualifier, std::string, bool,
                             std::int64_t, std::int64_t>;
  std::map<Radar, Verdict> verdicts_;
};

/// The same for the whole system of each vehicle.
class SystemChanges {
 public:
  bool observe(const diagnostics::SystemHealth& s) {
    const Verdict verdict(s.overall(), s.pipeline().data_qualifier(), s.pipeline().trouble_codes(), s.services());
    const auto [known, is_first] = verdicts_.try_emplace(s.vehicle_name(), verdict);
    const bool changed = is_first || known->second != verdict;
    known->second = verdict;
    return changed;
  }

 private:
  /// Overall, qualifier and trouble codes of the pipeline, conditions of the services.
  using Verdict = std::tuple<diagnostics::DataQualifier, diagnostics::DataQualifier, std::string, std::string>;
  std::map<std::string, Verdict> verdicts_;
};

int run_diagnostics(const DiagnosticsOptions& options, const CLI::App& command) {
  const bool is_json = !options.json.empty();
  LinePrinter printer(is_json ? options.json : "-");
  StateChanges changes;
  SystemChanges system_changes;
  dds::DiagnosticsReader::OnSensorHealth on_sensor_health;
  dds::DiagnosticsReader::OnSystemHealth on_system_health;
  dds::DiagnosticsReader::OnDiagnosticArray on_array;
  if (options.array) {
    on_array = [&](const diagnostic_msgs::msg::dds_::DiagnosticArray_& array) {
      printer.print(is_json ? diagnostics_text::to_json(array) : diagnostics_text::to_lines(array) + "\n");
    };
  } else {
    on_sensor_health = [&](const diagnostics::SensorHealth& sensor) {
      if (!changes.observe(sensor) && !options.all) return;
      printer.print(is_json ? diagnostics_text::to_json(sensor) : diagnostics_text::to_line(sensor) + "\n");
    };
    on_system_health = [&](const diagnostics::SystemHealth& system) {
      if (!system_changes.observe(system) && !options.all) return;
      printer.print(is_json ? diagnostics_text::to_json(system) : diagnostics_text::to_line(system) + "\n");
    };
  }
  std::optional<dds::DiagnosticsReader> reader(std::in_place, options.dds, on_sensor_health, on_array,
                                               on_system_health);
  const auto begin = std::chrono::steady_clock::now();
  const auto is_over = [&] {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    return options.seconds > 0.0 && elapsed.count() >= options.seconds;
  };
  const auto is_enough = [&] { return options.count > 0 && printer.printed() >= options.count; };
  while (!runtime::stop_signalled() && !is_over() && !is_enough() && !printer.failed()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  reader.reset();  // no further lines
  printer.commit();
  int result = exit_code::kSuccess;
  if (printer.printed() < std::max<std::uint64_t>(options.count, 1)) {
    report_problem(
        command, fmt::format("{} on DDS domain {}",
                             printer.printed() == 0 ? "nothing was received" : "fewer lines were received than --count",
                             options.dds.domain));
    result = exit_code::kFinding;
  }
  return exit_code_after_signal(result);
}

}  // namespace

void add_diagnostics_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "diagnostics",
      "Prints what the health service publishes over DDS: a line when the state of a radar or of the system changes.");
  auto options = std::make_shared<DiagnosticsOptions>();
  constexpr std::uint32_t kHighestDomain = 232;
  command->add_option("--domain", options->dds.domain, "DDS domain")
      ->envname("BORESIGHT_DDS_DOMAIN")
      ->check(CLI::Range(0U, kHighestDomain))
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--interface", options->dds.interfaces,
                   "IPv4 address of a network interface to use; repeatable; all interfaces if not given")
      ->type_name("ADDRESS");
  add_security_option(*command, options->security);
  command->add_flag(
      "--array", options->array,
      "Subscribes to rt/diagnostics (ROS 2) instead of boresight/sensor_health and boresight/system_health");
  command->add_flag("--all", options->all, "Prints every sample, not only changed states");
  add_json_option(*command, options->json,
                  "A line of JSON for each sample; without FILE, or with \"-\": to standard output");
  command->add_option("--count", options->count, "Ends after so many lines; 0: never")->type_name("N");
  command->add_option("--seconds", options->seconds, "Ends after so many seconds; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  on_call(*command, exit_code,
          {"diagnostics --all --count 10", "as many lines as wanted were received",
           "nothing was received, or fewer lines than --count"},
          [options, command] {
            if (!options->security.empty()) options->dds.security = dds::secured_by(options->security);
            return run_diagnostics(*options, *command);
          });
}

}  // namespace boresight
