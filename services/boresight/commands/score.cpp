// `boresight score`: figures of a run beside the truth.
#include "services/boresight/score/score.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/score/report_text.hpp"
#include "services/boresight/score/run_folder.hpp"
#include "services/boresight/terminal/output_file.hpp"

namespace boresight {

namespace {

struct ScoreOptions {
  std::vector<std::string> runs;
  std::string truth, json, junit;
  std::vector<std::string> limits;
  runtime::Configuration configuration;
};

/// The vehicle of --vehicle, else the one that the run names, if its file is there.
std::optional<VehicleConfig> vehicle_of(const ScoreOptions& options) {
  runtime::Configuration configuration = options.configuration;
  if (!configuration.vehicle_name.empty()) return configuration.vehicle(config::VehicleUse::kOffline);
  const std::filesystem::path run = options.runs.front();
  if (!std::filesystem::exists(run / "run.json")) return std::nullopt;
  configuration.vehicle_name = score::read_run_summary(run).vehicle;
  if (configuration.vehicle_name.empty()) return std::nullopt;
  return configuration.vehicle(config::VehicleUse::kOffline);
}

int run_score(const ScoreOptions& options, const CLI::App& command) {
  if (options.json == "-" && options.junit == "-") throw UsageError("only one result can go to standard output");
  if (!options.limits.empty() && options.junit.empty()) throw UsageError("--limit needs --junit");
  std::vector<score::Limit> limits;
  for (const std::string& text : options.limits) limits.push_back(score::limit_of(text));
  for (const std::string& run : options.runs) {
    if (std::filesystem::is_directory(run)) continue;
    throw std::runtime_error(
        run + (std::filesystem::exists(run) ? ": is no folder of a run" : ": No such file or directory"));
  }
  const score::TruthSource truth = score::find_truth(options.truth);
  const std::optional<VehicleConfig> vehicle = vehicle_of(options);

  int exit_code = exit_code::kSuccess;
  std::vector<score::NamedScore> scores;
  for (const std::string& run : options.runs) {
    score::Input input{run, truth, vehicle ? &*vehicle : nullptr, [](double) { stop_if_interrupted(); }};
    scores.push_back({run, score::score(input)});
    stop_if_interrupted();
    if (const std::string& finding = scores.back().score.finding; !finding.empty()) {
      report_problem(command, run + ": " + finding);
      exit_code = exit_code::kFinding;
    }
  }
  for (const score::Limit& limit : limits) {
    for (const score::NamedScore& each : scores) {
      if (each.score.figures.find(limit.figure) == nullptr && each.score.finding.empty()) {
        throw UsageError(fmt::format("--limit: there is no figure {}; --json lists them", limit.figure));
      }
      if (!score::is_kept(limit, each.score)) exit_code = exit_code::kFinding;
    }
  }
  if (!options.json.empty()) {
    terminal::write_file(options.json, score::to_json(scores, options.truth, BORESIGHT_VERSION));
  }
  if (!options.junit.empty()) terminal::write_file(options.junit, score::to_junit(scores, limits));
  // Standard output is for one result.
  if (options.json != "-" && options.junit != "-") {
    terminal::print(scores.size() == 1 ? score::to_text(scores.front()) : score::to_comparison(scores));
  }
  return exit_code;
}

}  // namespace

void add_score_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "score", "Judges a run of `boresight run` by the truth: detections, tracks, alignment, health.");
  const auto options = std::make_shared<ScoreOptions>();
  command->add_option("run", options->runs, "Folder of a run; several are shown side by side")
      ->type_name("RUN")
      ->required();
  command
      ->add_option("--truth", options->truth,
                   "Folder of a simulated drive or of tables (boxes.csv, labels.csv), or one table of objects")
      ->type_name("DIR|TABLE")
      ->required();
  runtime::add_vehicle_option(*command, options->configuration,
                              "Vehicle with nominal mountings and tolerances; default: the one that the run names");
  runtime::add_config_option(*command, options->configuration);
  add_json_option(*command, options->json, "Every figure as JSON; without FILE, or with \"-\": to standard output");
  command->add_option("--junit", options->junit, "Test cases of the limits as JUnit XML")->type_name("FILE");
  command
      ->add_option("--limit", options->limits,
                   "Largest allowed value of a figure, by its name in the JSON; a test case of --junit; repeatable")
      ->type_name("NAME=MAX")
      ->allow_extra_args(false);
  on_call(
      *command, exit_code,
      {"score run --truth drive\n"
       "score run --truth boxes.csv --vehicle my_car --json score.json\n"
       "score run --truth drive --junit score.xml --limit tracks.false.all_ranges.at_least_0.5_s=3",
       "the run was judged", "run and truth have no time in common, the run is empty, or a figure exceeds its limit"},
      [options, command] { return run_score(*options, *command); }, &options->configuration);
}

}  // namespace boresight
