// `boresight supervise`: RouDi and every service, kept running in the foreground without systemd.
#include <fstream>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "deploy/roudi/pools.hpp"
#include "deploy/supervisor/domain.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/common/runtime/stop_signal.hpp"

namespace boresight {

namespace {

struct SuperviseOptions {
  supervisor::DomainOptions domain{.binaries = {},
                                   .config_directory = "/etc/boresight",
                                   .vehicle = {},
                                   .run_directory = {},
                                   .log_directory = "logs",
                                   .environment = {}};
  bool replay = false;
};

int run(SuperviseOptions options) {
  runtime::install_stop_signals();
  if (options.domain.binaries.empty()) options.domain.binaries = supervisor::binaries_folder();
  if (options.domain.run_directory.empty()) options.domain.run_directory = supervisor::unused_run_directory();
  if (options.replay) options.domain.environment.emplace_back("BORESIGHT_INPUT", "replay");
  std::filesystem::create_directories(options.domain.log_directory);
  const std::filesystem::path pools = options.domain.log_directory / "roudi.toml";
  if (const auto shortage =
          supervisor::shared_memory_shortage(roudi::total_bytes(roudi::single_segment()), "/dev/shm")) {
    throw std::runtime_error(*shortage);
  }
  std::ofstream(pools) << roudi::to_toml(roudi::single_segment());

  supervisor::Supervisor domain(supervisor::domain_of_catalogue(options.domain, pools));
  std::size_t told = 0;
  const auto tell = [&domain, &told] {
    for (; told < domain.events().size(); ++told) {
      const supervisor::Event& event = domain.events()[told];
      std::cout << fmt::format("{:.3f} {} {} {} {}", static_cast<double>(event.time_ns) * 1e-9, name_of(event.kind),
                               event.process.empty() ? "domain" : event.process, event.pid, event.detail)
                << std::endl;
    }
  };
  domain.start([] { return runtime::stop_signalled(); });
  while (!runtime::stop_signalled()) {
    tell();
    domain.poll(50'000'000);
  }
  domain.stop();
  tell();
  return 0;
}

}  // namespace

void add_supervise_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("supervise", "start RouDi and every service and keep them running until SIGTERM or Ctrl-C");
  auto options = std::make_shared<SuperviseOptions>();
  command->add_option("--config", options->domain.config_directory, "folder with vehicle/ and services/")
      ->capture_default_str();
  command->add_option("--vehicle", options->domain.vehicle, "vehicle file to use, without .toml")
      ->envname("BORESIGHT_VEHICLE");
  command->add_option("--logs", options->domain.log_directory, "folder for each process's output")
      ->capture_default_str();
  command->add_option("--run-dir", options->domain.run_directory,
                      "folder for sockets; a new one under /tmp if not given");
  command->add_flag("--replay", options->replay, "the gateway listens to boresight-replay instead of the wires");
  command->callback([options, &exit_code] {
    try {
      exit_code = run(*options);
    } catch (const std::exception& error) {
      std::cerr << "boresight supervise: " << error.what() << '\n';
      exit_code = runtime::stop_signalled() ? 130 : 1;
    }
  });
}

}  // namespace boresight
