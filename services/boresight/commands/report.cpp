// `boresight report`: a monitor's record as a page and a judgement.
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/detection_truths.hpp"
#include "services/boresight/report/html_report.hpp"
#include "services/boresight/report/truth_table.hpp"
#include "services/common/runtime/options.hpp"

namespace boresight {

namespace {

struct ReportOptions {
  runtime::Configuration configuration{.directory = "/etc/boresight", .vehicle_name = {}};
  std::string record;
  std::string truth;
  std::string scans;
  std::string output = "report.html";
};

int run(const ReportOptions& options) {
  std::ifstream record(options.record);
  if (!record) throw std::runtime_error("cannot read " + options.record);
  report::ReportInput input;
  input.title = options.record;
  monitor::DamagedLines damaged;
  input.snapshots = monitor::read_record(record, options.record, damaged);
  input.more_checks.push_back(report::record_check("record", damaged));
  input.vehicle = options.configuration.vehicle();
  if (!options.truth.empty()) {
    std::ifstream truth(options.truth);
    input.truth = report::truth_of(read_drive_truth(truth), input.vehicle);
    if (!input.truth.known()) throw std::runtime_error("no truth in " + options.truth);
  }
  if (!options.scans.empty()) {
    std::ifstream scans(options.scans);
    if (!scans) throw std::runtime_error("cannot read " + options.scans);
    const auto truths = options.truth.empty() ? std::nullopt : detection_truths_beside(options.truth);
    input.ghosts = report::find_ghosts(scans, options.scans, truths ? &*truths : nullptr);
    const std::vector<report::Check> checks = report::ghost_checks(input.ghosts);
    input.more_checks.insert(input.more_checks.end(), checks.begin(), checks.end());
  }
  std::ofstream output(options.output);
  output << report::render_html(input);
  if (!output.flush()) throw std::runtime_error("cannot write " + options.output);
  report::Summary summary = report::summarise(input.snapshots, input.truth);
  summary.checks.insert(summary.checks.end(), input.more_checks.begin(), input.more_checks.end());
  std::cout << report::render_summary(summary) << "\nreport: " << options.output << '\n';
  return summary.all_passed() ? 0 : 1;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("report", "judge what `boresight monitor --record` has recorded, and draw it as an HTML page");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("record", options->record, "the monitor's record")->required();
  command->add_option("--config", options->configuration.directory, "folder with vehicle/ and services/")
      ->capture_default_str();
  command->add_option("--vehicle", options->configuration.vehicle_name, "vehicle file to use, without .toml")
      ->envname("BORESIGHT_VEHICLE");
  command->add_option("--truth", options->truth,
                      "truth.csv of a simulated drive; the tables beside it are the truth of scans and tracks");
  command->add_option("--scans", options->scans, "what `boresight monitor --record-scans` has recorded beside it");
  command->add_option("--out", options->output, "page to write")->capture_default_str();
  command->callback([options, &exit_code] {
    try {
      exit_code = run(*options);
    } catch (const std::exception& error) {
      std::cerr << "boresight report: " << error.what() << '\n';
      exit_code = 2;
    }
  });
}

}  // namespace boresight
