// boresight-bench-ghosts_drives: probabilities of the ghost filter on simulated drives of fresh seeds. See README.md.
#include <cstdio>
#include <exception>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/ghosts/drives/groups/groups.hpp"

namespace {

using namespace boresight;
using namespace boresight::bench::ghosts_drives;

constexpr int kError = 1;

/// Far from every seed that a person types.
std::uint64_t draw_seed() {
  return 1'000'000 + 1'000 * (std::random_device{}() % 1'000'000);
}

}  // namespace

int main(int argc, char** argv) {
  Setup setup;
  setup.scenarios = simulator::scenario_names();
  setup.first_seed = 0;
  std::vector<std::string> names = {"series_77ghz", "can_cluster", "ideal"};
  std::string only, start = "profile", json, markdown;
  CLI::App app(
      "Judges the ghost filter's probabilities on simulated drives. Exit code 0 also if bars are missed, 1 on an "
      "error.");
  app.add_option("--only", only, "One group")->check(CLI::IsMember({"probabilities", "highway", "ablation"}));
  app.add_option("--scenarios", setup.scenarios, "Names or files");
  app.add_option("--profiles", names, "Names or files of radar profiles, with weights of evidence");
  app.add_option("--seeds", setup.seeds, "Drives of each scenario and profile")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--highway-seeds", setup.highway_seeds, "Drives of the group highway")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seed", setup.first_seed, "First seed; without: a fresh one. Not one that the weights come from");
  app.add_option("--duration", setup.longest_s, "Longest drive, s")->capture_default_str();
  app.add_option("--jobs", setup.jobs, "Threads")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--start", start, "Weights of the filter: 0, or those of the profile")
      ->check(CLI::IsMember({"zero", "profile"}))
      ->capture_default_str();
  CLI::Option* const others = app.add_flag("--fit-others", setup.fits_others,
                                           "Group probabilities: fits the weights of each scenario on the others");
  app.add_option("--weights-out", setup.weights_folder,
                 "Fits weights on the judged drives of the group probabilities, one file a profile in this folder")
      ->excludes(others);
  app.add_option("--json", json, "Writes tables and curves to this file");
  app.add_option("--markdown", markdown, "Writes the tables to this file, between the marks of docs/ghosts.md");
  try {
    app.parse(argc, argv);
    setup.starts_at_zero = start == "zero";
    if (setup.first_seed == 0) setup.first_seed = draw_seed();
    fmt::print("scenarios: {}; seeds {} … {}; at most {} s\n", fmt::join(setup.scenarios, " "), setup.first_seed,
               setup.last_seed(), setup.longest_s);
    std::vector<ProfileDrives> profiles;
    for (const std::string& name : names) profiles.emplace_back(setup, name);
    bench::Findings findings;
    const auto wants = [&](const char* group) { return only.empty() || only == group; };
    if (wants("probabilities")) probabilities(setup, profiles, findings);
    if (wants("highway")) highway(setup, findings);
    if (wants("ablation")) ablation(setup, profiles, findings);
    findings.finish(json, markdown);
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kError;
  }
}
