// The subcommands of `boresight`; each registers itself and sets the process's exit code when it has run.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace boresight {

void add_align_command(CLI::App& app, int& exit_code);
void add_calibrate_command(CLI::App& app, int& exit_code);
void add_catalogue_command(CLI::App& app, int& exit_code);
void add_decode_command(CLI::App& app, int& exit_code);
void add_demo_command(CLI::App& app, int& exit_code);
void add_diagnostics_command(CLI::App& app, int& exit_code);
void add_dtc_command(CLI::App& app, int& exit_code);
void add_fit_classes_command(CLI::App& app, int& exit_code);
void add_fit_evidence_command(CLI::App& app, int& exit_code);
void add_gospa_command(CLI::App& app, int& exit_code);
void add_monitor_command(CLI::App& app, int& exit_code);
void add_record_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_run_command(CLI::App& app, int& exit_code);
void add_score_command(CLI::App& app, int& exit_code);
void add_simulate_command(CLI::App& app, int& exit_code);
void add_supervise_command(CLI::App& app, int& exit_code);
void add_track_command(CLI::App& app, int& exit_code);
void add_vehicle_command(CLI::App& app, int& exit_code);

}  // namespace boresight
