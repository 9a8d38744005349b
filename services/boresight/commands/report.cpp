// `boresight report`: a run folder as a page and a judgement.
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/report_input.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/report/html_report.hpp"
#include "services/boresight/report/truth_table.hpp"
#include "services/boresight/terminal/output_file.hpp"

namespace boresight {

namespace {

struct ReportOptions {
  runtime::Configuration configuration;
  std::string folder;
  std::string truth;
  std::string output = "report.html";
};

int run_report(const ReportOptions& options) {
  report::ReportInput input;
  input.title = options.folder;
  input.vehicle = options.configuration.vehicle();
  if (!options.truth.empty()) {
    InputFile truth(options.truth);
    input.truth = report::truth_of(read_drive_truth(truth), input.vehicle);
    if (!input.truth.known()) throw std::runtime_error("no truth in " + options.truth);
  }
  read_run_folder(options.folder, options.truth, input);
  const std::string page = report::render_html(input);
  stop_if_interrupted();
  terminal::write_file(options.output, page);
  report::Summary summary = report::summarise(input.snapshots, input.truth);
  summary.checks.insert(summary.checks.end(), input.more_checks.begin(), input.more_checks.end());
  if (options.output != "-") terminal::print(report::render_summary(summary) + "\nreport: " + options.output + "\n");
  return summary.all_passed() ? exit_code::kSuccess : exit_code::kFinding;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "report",
      "Judges a run folder of `boresight run` or `boresight monitor --record`, and draws it as an HTML page.");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("folder", options->folder, "Run folder")->type_name("DIR")->required();
  runtime::add_config_option(*command, options->configuration);
  runtime::add_vehicle_option(*command, options->configuration)->envname("BORESIGHT_VEHICLE");
  command
      ->add_option("--truth", options->truth,
                   "truth.csv of a simulated drive; the tables beside it are the truth of scans and tracks")
      ->type_name("FILE");
  command->add_option("--out", options->output, "HTML page to write; \"-\": standard output, without the summary")
      ->type_name("FILE")
      ->capture_default_str();
  on_call(
      *command, exit_code,
      {"report run --vehicle demo --truth drive/truth.csv --out report.html", "every check passed", "a check failed"},
      [options] { return run_report(*options); }, &options->configuration);
}

}  // namespace boresight
