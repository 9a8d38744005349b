// `boresight diagnostics`: what the health service says by DDS, and when it falls silent.
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
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/bounded/joined.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/diagnostics_topics.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/diagnostics/diagnostics_text.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/config/network_values.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/health/config.hpp"
#include "services/health/dds/diagnostics_reader.hpp"
#include "services/health/dds/topics.hpp"

namespace boresight {

namespace {

struct DiagnosticsOptions {
  runtime::Configuration configuration;
  std::optional<std::uint32_t> domain;
  std::vector<std::string> interfaces;
  std::string security;  ///< folder; empty: an open domain
  bool array = false;
  TopicChoice topics;
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
  /// Ends the output: later lines are dropped. Throws OutputError if a line could not be written.
  void commit() {
    const std::lock_guard lock(mutex_);
    failed_ = true;
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

/// A hostile sender could invent names without end. If all are known, some lines appear twice.
constexpr std::size_t kMostVerdicts = std::size_t{kMaxRadars} * dds::kMostVehicles + 1;

/// Whether the state of a radar differs from the one before; numbers that always change do not count.
class StateChanges {
 public:
  bool observe(const diagnostics::SensorHealth& s) {
    const Verdict verdict(s.data_qualifier(), s.extended_qualifier(), s.finding(), s.drift().since_ns() != 0,
                          s.load_change().time_ns(), s.speed_change().time_ns());
    if (verdicts_.size() >= kMostVerdicts) verdicts_.clear();
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
    if (verdicts_.size() >= kMostVerdicts) verdicts_.clear();
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

/// The options take precedence over the environment, and the environment over the file.
dds::Config dds_of(const DiagnosticsOptions& options) {
  dds::Config config = health::read_config(config::Reader::open(options.configuration.service_file("health"))).dds;
  if (options.domain) config.domain = *options.domain;
  if (!options.security.empty()) config.security = dds::secured_by(options.security);
  if (options.interfaces.empty()) return config;
  if (const auto problem = config::problem_of_interfaces(options.interfaces)) {
    throw UsageError("--interface: " + *problem);
  }
  config.interfaces = options.interfaces;
  return config;
}

/// What the callbacks of the middleware use; they may come as long as the process runs.
struct Printed {
  explicit Printed(const std::string& file) : printer(file) {}
  LinePrinter printer;
  StateChanges changes;
  SystemChanges system_changes;
};

dds::DiagnosticsCallbacks callbacks_of(const DiagnosticsOptions& options, const std::shared_ptr<Printed>& printed) {
  dds::DiagnosticsCallbacks callbacks;
  const bool is_json = !options.json.empty(), all = options.all;
  if (options.topics.any()) {
    // Health is not read.
  } else if (options.array) {
    callbacks.on_diagnostic_array = [is_json, printed](const diagnostic_msgs::msg::dds_::DiagnosticArray_& array) {
      printed->printer.print(is_json ? diagnostics_text::to_json(array) : diagnostics_text::to_lines(array) + "\n");
    };
  } else {
    callbacks.on_sensor_health = [is_json, all, printed](const diagnostics::SensorHealth& sensor) {
      if (!printed->changes.observe(sensor) && !all) return;
      printed->printer.print(is_json ? diagnostics_text::to_json(sensor) : diagnostics_text::to_line(sensor) + "\n");
    };
    callbacks.on_system_health = [is_json, all, printed](const diagnostics::SystemHealth& system) {
      if (!printed->system_changes.observe(system) && !all) return;
      printed->printer.print(is_json ? diagnostics_text::to_json(system) : diagnostics_text::to_line(system) + "\n");
    };
  }
  callbacks.on_presence = [is_json, printed](const dds::Presence& presence) {
    const std::int64_t now_ns = runtime::realtime_now_ns();
    printed->printer.print(is_json ? diagnostics_text::to_json(presence, now_ns)
                                   : diagnostics_text::to_line(presence, now_ns) + "\n");
  };
  return callbacks;
}

struct Readers {
  Readers(const dds::Config& config, const DiagnosticsOptions& options, const std::shared_ptr<Printed>& printed)
      : health(config, callbacks_of(options, printed)) {
    if (!options.topics.any()) return;
    const auto print = [printed](const std::string& text) { printed->printer.print(text); };
    topics.emplace(config, printing(options.topics, !options.json.empty(), print));
  }
  dds::DiagnosticsReader health;
  std::optional<dds::TopicReader> topics;
};

int run_diagnostics(const DiagnosticsOptions& options, const CLI::App& command) {
  const auto printed = std::make_shared<Printed>(options.json.empty() ? "-" : options.json);
  LinePrinter& printer = printed->printer;
  const dds::Config config = dds_of(options);
  bounded::Joined<Readers> readers(
      fmt::format("DDS domain {}", config.domain),
      [config, options, printed] { return std::make_unique<Readers>(config, options, printed); },
      [] { return runtime::stop_signalled(); });
  const auto begin = std::chrono::steady_clock::now();
  const auto is_over = [&] {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    return options.seconds > 0.0 && elapsed.count() >= options.seconds;
  };
  const auto is_enough = [&] { return options.count > 0 && printer.printed() >= options.count; };
  while (!runtime::stop_signalled() && !is_over() && !is_enough() && !printer.failed()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  readers.leave();  // no further lines
  printer.commit();
  int result = exit_code::kSuccess;
  if (printer.printed() < std::max<std::uint64_t>(options.count, 1)) {
    report_problem(
        command, fmt::format("{} on DDS domain {}",
                             printer.printed() == 0 ? "nothing was received" : "fewer lines were received than --count",
                             config.domain));
    result = exit_code::kFinding;
  }
  return exit_code_after_signal(result);
}

}  // namespace

void add_diagnostics_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand("diagnostics",
                                               "Prints what the health service publishes over DDS: a line when the "
                                               "state of a radar or of the system changes, and "
                                               "when a source becomes stale or is received again.");
  auto options = std::make_shared<DiagnosticsOptions>();
  constexpr std::uint32_t kHighestDomain = 232;
  runtime::add_config_option(*command, options->configuration);
  command
      ->add_option("--domain", options->domain,
                   "DDS domain; default: BORESIGHT_DDS_DOMAIN of the environment, else dds.domain of health.toml")
      ->check(CLI::Range(0U, kHighestDomain))
      ->type_name("N");
  command
      ->add_option(
          "--interface", options->interfaces,
          "Name or IPv4 address of a network interface to use, or \"all\"; repeatable; default: dds.interfaces "
          "of health.toml")
      ->type_name("NAME|ADDRESS");
  add_security_option(*command, options->security);
  auto* const array = command->add_flag(
      "--array", options->array,
      "Subscribes to rt/diagnostics (ROS 2) instead of boresight/sensor_health and boresight/system_health");
  add_topic_options(*command, options->topics, array);
  command->add_flag("--all", options->all, "Prints every sample, not only changed states");
  add_json_option(*command, options->json,
                  "A line of JSON for each sample; without FILE, or with \"-\": to standard output");
  command->add_option("--count", options->count, "Ends after so many lines; 0: never")->type_name("N");
  command->add_option("--seconds", options->seconds, "Ends after so many seconds; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  on_call(
      *command, exit_code,
      {"diagnostics --all --count 10", "as many lines as wanted were received",
       "nothing was received, or fewer lines than --count"},
      [options, command] { return run_diagnostics(*options, *command); }, &options->configuration);
}

}  // namespace boresight
