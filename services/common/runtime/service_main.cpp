#include "services/common/runtime/service_main.hpp"

#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/exit_codes.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/common/text/printable.hpp"

namespace boresight::runtime {

namespace {

constexpr const char* kStopLimitKey = "BORESIGHT_STOP_LIMIT_MS";

/// The time from SIGTERM to the end at the latest, where the service manager states it.
std::optional<std::chrono::milliseconds> stop_limit_of_environment() {
  const char* const value = std::getenv(kStopLimitKey);
  if (value == nullptr) return std::nullopt;
  constexpr std::int64_t kLeast_ms = 100, kMost_ms = 3'600'000;
  const std::string_view text = value;
  std::int64_t limit_ms = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), limit_ms);
  if (error != std::errc() || end != text.data() + text.size() || limit_ms < kLeast_ms || limit_ms > kMost_ms) {
    throw config::Error(std::string(kStopLimitKey) + "=" + value + ": must be a whole number from 100 to 3600000");
  }
  return std::chrono::milliseconds(limit_ms);
}

}  // namespace

int service_main(catalogue::Service self, int argc, char** argv, const Load& load, const Inspect& inspect) {
  const std::string name = "boresight-" + std::string(catalogue::name_of(self));
  Configuration configuration;
  bool check = false;

  CLI::App app{"Boresight service " + std::string(catalogue::name_of(self)), name};
  add_config_option(app, configuration);
  add_vehicle_option(app, configuration)->envname("BORESIGHT_VEHICLE");
  app.add_flag("--check", check, "Checks the configuration and ends");
  app.footer(
      "Exit codes: 0 stopped by a signal, or the configuration is valid; 1 failure at run time; 2 wrong command line "
      "or configuration; 70 error of the middleware");
  app.set_version_flag("--version", name + " " + BORESIGHT_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_code::kSuccess : exit_code::kUsage;
  }

  log::initialise(name);
  install_stop_signals();
  try {
    if (const auto limit = stop_limit_of_environment()) limit_stop_time(*limit);
    const Run run = load(configuration);
    if (check) {
      if (inspect) inspect(configuration);
      std::cout << name << ": configuration is valid (" << configuration.directory.string() << ")\n";
      return exit_code::kSuccess;
    }
    Node node(self);
    log::info("started");
    const int result = run(node);
    log::info("stopped");
    return result;
  } catch (const config::Error& error) {
    // Also an error that is found only after the start: a restart would not help.
    std::cerr << text::printable(error.what(), text::LineBreaks::kKept) << '\n';
    return exit_code::kUsage;
  } catch (const std::exception& error) {
    if (stop_signalled()) return exit_code::kSuccess;
    log::error("{}", error.what());
    return exit_code::kFinding;
  }
}

}  // namespace boresight::runtime
