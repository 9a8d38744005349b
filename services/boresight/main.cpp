// `boresight`: the one command-line tool of the product.
#include <CLI/CLI.hpp>

#include "services/boresight/bounded/step.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Boresight, a radar perception pipeline: simulates, records, decodes, aligns, runs and watches it.",
               "boresight"};
  app.set_version_flag("--version", std::string("boresight ") + BORESIGHT_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer(
      "'boresight COMMAND --help' describes a command.\n"
      "Exit codes: 0 success; 1 a finding, such as a failed check; 2 wrong command line or configuration;\n"
      "3 an input cannot be read, or an output cannot be written; 130 ended by Ctrl-C.");
  int exit_code = boresight::exit_code::kSuccess;
  boresight::add_align_command(app, exit_code);
  boresight::add_calibrate_command(app, exit_code);
  boresight::add_catalogue_command(app, exit_code);
  boresight::add_decode_command(app, exit_code);
  boresight::add_demo_command(app, exit_code);
  boresight::add_diagnostics_command(app, exit_code);
  boresight::add_dtc_command(app, exit_code);
  boresight::add_fit_classes_command(app, exit_code);
  boresight::add_fit_evidence_command(app, exit_code);
  boresight::add_gospa_command(app, exit_code);
  boresight::add_monitor_command(app, exit_code);
  boresight::add_record_command(app, exit_code);
  boresight::add_report_command(app, exit_code);
  boresight::add_run_command(app, exit_code);
  boresight::add_score_command(app, exit_code);
  boresight::add_simulate_command(app, exit_code);
  boresight::add_supervise_command(app, exit_code);
  boresight::add_track_command(app, exit_code);
  boresight::add_vehicle_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return boresight::report_parse_error(app, error);
  }
  boresight::bounded::end_process_of_steps(exit_code);
  return exit_code;
}
