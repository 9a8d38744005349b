// `boresight supervise`: RouDi and every service, kept running in the foreground without systemd.
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "deploy/roudi/pools.hpp"
#include "deploy/supervisor/domain.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/stop_signal.hpp"

namespace boresight {

namespace {

constexpr double kMinLogSize_mb = 0.01;
constexpr double kMaxLogSize_mb = 10000.0;
constexpr std::size_t kMaxLogFiles = 100;

struct SuperviseOptions {
  supervisor::DomainOptions domain{.binaries = {},
                                   .config_directory = {},
                                   .vehicle = {},
                                   .run_directory = {},
                                   .log_directory = "logs",
                                   .environment = {}};
  runtime::Configuration configuration;
  double log_size_mb = 10.0;
  std::size_t log_files = 3;
  bool replay = false;
};

/// Why a service cannot run, in its own words.
std::string refusal_of(const std::string& service, const std::filesystem::path& logs) {
  constexpr std::size_t kLines = 5;
  const std::filesystem::path log = logs / (service + ".log");
  return service + " refuses its configuration; the end of " + log.string() + ":\n" +
         supervisor::last_lines(log, kLines);
}

/// Without room for its own output, too, the domain runs on.
void print_if_possible(const std::string& line) {
  try {
    terminal::print(line);
  } catch (const terminal::OutputError&) {
    // There is no other place to report it.
  }
}

int run_supervise(SuperviseOptions options) {
  static_cast<void>(options.configuration.vehicle());  // a wrong configuration is reported before anything starts
  options.domain.config_directory = options.configuration.directory;
  options.domain.vehicle = std::filesystem::absolute(options.configuration.vehicle_file()).string();
  if (options.domain.binaries.empty()) options.domain.binaries = supervisor::binaries_folder();
  if (options.domain.run_directory.empty()) options.domain.run_directory = supervisor::unused_run_directory();
  if (options.replay) options.domain.environment.emplace_back("BORESIGHT_INPUT", "replay");
  std::error_code error;
  std::filesystem::create_directories(options.domain.log_directory, error);
  if (error) throw terminal::OutputError(options.domain.log_directory.string(), error.value());
  const std::filesystem::path pools = options.domain.log_directory / "roudi.toml";
  if (const auto shortage =
          supervisor::shared_memory_shortage(roudi::total_bytes(roudi::single_segment()), "/dev/shm")) {
    throw std::runtime_error(*shortage);
  }
  terminal::write_file(pools, roudi::to_toml(roudi::single_segment()));

  supervisor::DomainConfig config = supervisor::domain_of_catalogue(options.domain, pools);
  constexpr double kBytesPerMegabyte = 1e6;
  config.logs = {.max_bytes = static_cast<std::uintmax_t>(options.log_size_mb * kBytesPerMegabyte),
                 .kept_files = options.log_files};
  supervisor::Supervisor domain(config);
  std::size_t printed = 0;
  const auto print_new_events = [&domain, &printed] {
    for (; printed < domain.events().size(); ++printed) {
      const supervisor::Event& event = domain.events()[printed];
      print_if_possible(fmt::format("{:.3f} {} {} {} {}\n", static_cast<double>(event.time_ns) * 1e-9,
                                    name_of(event.kind), event.process.empty() ? "domain" : event.process, event.pid,
                                    event.detail));
    }
  };
  try {
    domain.start([] { return runtime::stop_signalled(); });
  } catch (const std::runtime_error&) {
    if (!runtime::stop_signalled()) throw;
  }
  while (!runtime::stop_signalled() && domain.refused_by().empty()) {
    print_new_events();
    domain.poll(50'000'000);
  }
  domain.stop();
  print_new_events();
  if (!domain.refused_by().empty()) {
    throw config::Error(refusal_of(domain.refused_by(), options.domain.log_directory));
  }
  return exit_code_after_signal(exit_code::kSuccess);
}

}  // namespace

void add_supervise_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "supervise", "Starts RouDi and every service in the foreground and restarts them until SIGTERM or Ctrl-C.");
  auto options = std::make_shared<SuperviseOptions>();
  runtime::add_config_option(*command, options->configuration);
  runtime::add_vehicle_option(*command, options->configuration)->envname("BORESIGHT_VEHICLE");
  command->add_option("--logs", options->domain.log_directory, "Folder for the output of each process")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_option("--run-dir", options->domain.run_directory, "Folder for sockets; default: a new one in /tmp")
      ->type_name("DIR");
  command->add_option("--log-size", options->log_size_mb, "A longer log is moved to <name>.log.1")
      ->type_name("MB")
      ->check(CLI::Range(kMinLogSize_mb, kMaxLogSize_mb))
      ->capture_default_str();
  command->add_option("--log-files", options->log_files, "Number of older logs that are kept of each process")
      ->type_name("N")
      ->check(CLI::Range(std::size_t{0}, kMaxLogFiles))
      ->capture_default_str();
  command->add_flag("--replay", options->replay, "The gateway takes its input from boresight-replay");
  on_call(
      *command, exit_code, {"supervise --vehicle demo --replay", "stopped by SIGTERM", ""},
      [options] { return run_supervise(*options); }, &options->configuration);
}

}  // namespace boresight
