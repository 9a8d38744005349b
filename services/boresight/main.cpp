// `boresight`: the one command-line tool of the product.
#include <cstdlib>

#include "services/boresight/commands/commands.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Boresight, a radar perception pipeline", "boresight"};
  app.set_version_flag("--version", std::string("boresight ") + BORESIGHT_VERSION);
  app.require_subcommand(1);
  int exit_code = EXIT_SUCCESS;
  boresight::add_align_command(app, exit_code);
  boresight::add_calibrate_command(app, exit_code);
  boresight::add_catalogue_command(app, exit_code);
  boresight::add_decode_command(app, exit_code);
  boresight::add_demo_command(app, exit_code);
  boresight::add_diagnostics_command(app, exit_code);
  boresight::add_monitor_command(app, exit_code);
  boresight::add_record_command(app, exit_code);
  boresight::add_report_command(app, exit_code);
  boresight::add_simulate_command(app, exit_code);
  boresight::add_supervise_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    constexpr int kExitUsage = 2;
    return app.exit(error) == 0 ? EXIT_SUCCESS : kExitUsage;
  }
  return exit_code;
}
