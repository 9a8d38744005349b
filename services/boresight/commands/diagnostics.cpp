// `boresight diagnostics`: what the health service says by DDS, from anywhere on the network.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include <CLI/CLI.hpp>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/diagnostics/diagnostics_text.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/health/dds/diagnostics_reader.hpp"

namespace boresight {

namespace {

struct DiagnosticsOptions {
  dds::Config dds;
  bool array = false;
  bool all = false;
  bool json = false;
  std::uint64_t count = 0;
  double seconds = 0.0;
};

/// Lines from two threads of the middleware, one after the other.
class Printer {
 public:
  void print(const std::string& text) {
    const std::lock_guard lock(mutex_);
    std::cout << text << std::endl;  // at once: the reader of a pipe shall not wait
    ++printed_;
  }
  [[nodiscard]] std::uint64_t printed() const { return printed_; }

 private:
  std::mutex mutex_;
  std::atomic<std::uint64_t> printed_ = 0;
};

/// Whether a sample says something new about its radar, beyond numbers that always change.
class Changes {
 public:
  bool observe(const diagnostics::SensorHealth& s) {
    const std::pair verdict(s.data_qualifier(), s.extended_qualifier());
    const auto [known, is_first] = verdicts_.try_emplace({s.vehicle_name(), s.radar_id()}, verdict);
    const bool changed = is_first || known->second != verdict;
    known->second = verdict;
    return changed;
  }

 private:
  using Radar = std::pair<std::string, std::uint32_t>;
  std::map<Radar, std::pair<diagnostics::DataQualifier, diagnostics::ExtendedQualifier>> verdicts_;
};

int run(const DiagnosticsOptions& options) {
  runtime::install_stop_signals();
  Printer printer;
  Changes changes;
  dds::DiagnosticsReader::OnSensorHealth on_sensor_health;
  dds::DiagnosticsReader::OnDiagnosticArray on_array;
  if (options.array) {
    on_array = [&](const diagnostic_msgs::msg::dds_::DiagnosticArray_& array) {
      printer.print(options.json ? diagnostics_text::to_json(array) : diagnostics_text::to_lines(array));
    };
  } else {
    on_sensor_health = [&](const diagnostics::SensorHealth& sensor) {
      if (!changes.observe(sensor) && !options.all) return;
      printer.print(options.json ? diagnostics_text::to_json(sensor) : diagnostics_text::to_line(sensor));
    };
  }
  const dds::DiagnosticsReader reader(options.dds, on_sensor_health, on_array);
  const auto begin = std::chrono::steady_clock::now();
  const auto is_over = [&] {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    return options.seconds > 0.0 && elapsed.count() >= options.seconds;
  };
  const auto is_enough = [&] { return options.count > 0 && printer.printed() >= options.count; };
  while (!runtime::stop_signalled() && !is_over() && !is_enough()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (printer.printed() >= std::max<std::uint64_t>(options.count, 1)) return 0;
  std::cerr << "boresight diagnostics: "
            << (printer.printed() == 0 ? "nothing received" : "fewer lines received than wanted") << " on DDS domain "
            << options.dds.domain << '\n';
  return 1;
}

}  // namespace

void add_diagnostics_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("diagnostics", "what the health service says by DDS; a line when a radar's state changes");
  auto options = std::make_shared<DiagnosticsOptions>();
  constexpr std::uint32_t kHighestDomain = 232;
  command->add_option("--domain", options->dds.domain, "DDS domain")
      ->envname("BORESIGHT_DDS_DOMAIN")
      ->check(CLI::Range(0U, kHighestDomain))
      ->capture_default_str();
  command->add_option("--interface", options->dds.interfaces,
                      "IPv4 address of a network interface to use; default all");
  command->add_flag("--array", options->array,
                    "subscribe to rt/diagnostics (ROS 2) instead of boresight/sensor_health");
  command->add_flag("--all", options->all, "print every sample, not only changed states");
  command->add_flag("--json", options->json, "one line of JSON a sample");
  command->add_option("--count", options->count, "lines after which to stop; 0 is never");
  command->add_option("--seconds", options->seconds, "seconds after which to stop; 0 is never")
      ->check(CLI::NonNegativeNumber);
  command->footer("Exit code 1 if nothing was received, or less than --count.");
  command->callback([options, &exit_code] {
    try {
      exit_code = run(*options);
    } catch (const std::exception& error) {
      std::cerr << "boresight diagnostics: " << error.what() << '\n';
      exit_code = 1;
    }
  });
}

}  // namespace boresight
