// `boresight gospa`: estimates of a simulated scenario beside its truth.
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/boresight/track/estimates.hpp"
#include "services/boresight/track/gospa_score.hpp"

namespace boresight {

namespace {

struct GospaOptions {
  std::string truth, estimates, base;
  bool per_step = false;
};

int run_gospa(const GospaOptions& options, const CLI::App& command) {
  const track::ObjectsByStep truth = track::read_objects(options.truth);
  if (truth.empty()) throw std::runtime_error(options.truth + ": has no object");
  const track::ObjectsByStep estimates = track::read_objects(options.estimates);
  stop_if_interrupted();
  std::vector<track::GospaScore> scores;
  for (const judge::GospaBase base : {judge::GospaBase::kSquared, judge::GospaBase::kRoot}) {
    const std::string name = base == judge::GospaBase::kSquared ? "squared" : "true";
    if (options.base.empty() || options.base == name) scores.push_back(track::score_gospa(truth, estimates, base));
  }
  terminal::print(track::gospa_text(scores, options.per_step));
  const auto steps = static_cast<double>(truth.size());
  terminal::print(fmt::format("{} steps; {:.2f} objects and {:.2f} estimates a step\n", truth.size(),
                              static_cast<double>(track::number_of_objects(truth)) / steps,
                              static_cast<double>(track::number_of_objects(estimates)) / steps));
  int exit_code = exit_code::kSuccess;
  if (estimates.size() > truth.size()) {
    report_problem(command, fmt::format("{}: steps after {}, the last of the truth, are not judged", options.estimates,
                                        truth.size()));
    exit_code = exit_code::kFinding;
  }
  for (const track::GospaScore& score : scores) {
    if (score.not_considered == 0) continue;
    report_problem(command, fmt::format("{} pairs of objects and estimates are not considered: too many lie together",
                                        score.not_considered));
    exit_code = exit_code::kFinding;
  }
  return exit_code;
}

}  // namespace

void add_gospa_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "gospa", "Judges estimates of a simulated scenario by its truth: mean GOSPA a scan (p = 1, c = 20, α = 2).");
  const auto options = std::make_shared<GospaOptions>();
  command->add_option("truth", options->truth, "Table of the true objects: step,id,cx,cy,vx,vy,X11,X12,X22")
      ->type_name("TRUTH")
      ->required();
  command->add_option("estimates", options->estimates, "Table of the estimates, with the same columns; id is optional")
      ->type_name("ESTIMATES")
      ->required();
  command
      ->add_option("--base", options->base,
                   "Base distance: the squared Gaussian-Wasserstein distance or the true one; default: both")
      ->check(CLI::IsMember({"squared", "true"}));
  command->add_flag("--per-step", options->per_step, "A row for each step, too");
  on_call(*command, exit_code,
          {"gospa truth.csv estimates.csv --base squared", "the estimates were judged",
           "some estimates or pairs could not be judged"},
          [options, command] { return run_gospa(*options, *command); });
}

}  // namespace boresight
