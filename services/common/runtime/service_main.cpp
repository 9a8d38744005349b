#include "services/common/runtime/service_main.hpp"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/stop_signal.hpp"

namespace boresight::runtime {

namespace {

constexpr int kExitFailure = 1;
constexpr int kExitUsage = 2;

}  // namespace

int service_main(catalogue::Service self, int argc, char** argv, const Load& load) {
  const std::string name = "boresight-" + std::string(catalogue::name_of(self));
  Configuration configuration;
  configuration.directory = "/etc/boresight";
  bool check = false;

  CLI::App app{"Boresight service " + std::string(catalogue::name_of(self)), name};
  app.add_option("--config", configuration.directory, "folder with vehicle/ and services/")->capture_default_str();
  app.add_option("--vehicle", configuration.vehicle_name, "vehicle file to use, without .toml")
      ->envname("BORESIGHT_VEHICLE");
  app.add_flag("--check", check, "validate the configuration and exit");
  app.set_version_flag("--version", name + " " + BORESIGHT_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? EXIT_SUCCESS : kExitUsage;
  }

  log::initialise(name);
  install_stop_signals();
  try {
    const Run run = load(configuration);
    if (check) {
      std::cout << name << ": configuration is valid (" << configuration.directory.string() << ")\n";
      return EXIT_SUCCESS;
    }
    Node node(self);
    log::info("started");
    const int exit_code = run(node);
    log::info("stopped");
    return exit_code;
  } catch (const config::Error& error) {
    std::cerr << error.what() << '\n';
    return kExitUsage;
  } catch (const std::exception& error) {
    if (stop_signalled()) return EXIT_SUCCESS;
    log::error("{}", error.what());
    return kExitFailure;
  }
}

}  // namespace boresight::runtime
