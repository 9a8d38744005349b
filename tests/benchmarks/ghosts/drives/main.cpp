// boresight-bench-ghosts_drives: probabilities of the ghost filter on simulated drives of fresh seeds. See README.md.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/ghost_filter/weights_file.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/ghosts/drives/figures.hpp"

namespace {

using namespace boresight;
using namespace boresight::bench;
using namespace boresight::bench::ghosts_drives;

constexpr int kError = 1;

struct Arguments {
  std::vector<std::string> scenarios = simulator::scenario_names();
  std::vector<std::string> profiles = {"series_77ghz", "can_cluster", "ideal"};
  std::size_t seeds = 3, jobs = 2;
  std::uint64_t first_seed = 0;
  double longest_s = 25.0;
  bool fits_others = false;
  std::string fit, json;
};

struct Bar {
  const char* what;
  Figure figure;
  double limit;
  bool is_at_most;
};

std::vector<Bar> bars(bool is_of_other_scenarios) {
  const double calibration = is_of_other_scenarios ? 0.08 : 0.05;
  return {{"Brier / base rate, without tracks", brier_ratio(Lane::kWithout), 0.6, true},
          {"log loss / base rate, without tracks", log_loss_ratio(Lane::kWithout), 0.7, true},
          {"calibration error, without tracks", calibration_error(Lane::kWithout), calibration, true},
          {"false ones recognised at 90 % of real ones kept, without tracks", recognised_at_90(Lane::kWithout), 0.75,
           false},
          {"Brier / base rate, perfect tracks", brier_ratio(Lane::kPerfect), 0.25, true},
          {"log loss / base rate, perfect tracks", log_loss_ratio(Lane::kPerfect), 0.3, true},
          {"calibration error, perfect tracks", calibration_error(Lane::kPerfect), calibration, true},
          {"real ones of objects known over 1 s lost, perfect tracks", known_lost(Lane::kPerfect), 0.03, true},
          {"Doppler-ambiguous ones of known objects kept, perfect tracks", ambiguous_kept(Lane::kPerfect), 0.85, false},
          {"Brier / base rate, in the chain", brier_ratio(Lane::kChain), 0.4, true},
          {"log loss / base rate, in the chain", log_loss_ratio(Lane::kChain), NAN, true},
          {"calibration error, in the chain", calibration_error(Lane::kChain), calibration, true},
          {"Brier / base rate, published method", brier_ratio(Lane::kPublished), NAN, true}};
}

/// Figures of all drives of a profile together, with 95 % intervals over the drives, and the median over the drives.
void print(const std::string& profile, const Drives& drives, bool is_of_other_scenarios) {
  fmt::print("\n{}, {} drives{}\n", profile, drives.size(),
             is_of_other_scenarios ? ", weights fitted on other scenarios" : "");
  fmt::print("{:<66} {:>8} {:>17} {:>8} {:>8}\n", "", "all", "95 % interval", "median", "bar");
  for (const Bar& bar : bars(is_of_other_scenarios)) {
    const auto of = [&](const std::vector<std::size_t>& picks) {
      Drives picked;
      for (const std::size_t pick : picks) picked.push_back(drives[pick]);
      return bar.figure(picked);
    };
    const double figure = bar.figure(drives);
    const Interval interval = bootstrap(drives.size(), of);
    std::vector<double> each;
    for (const DriveResult* drive : drives) each.push_back(bar.figure({drive}));
    std::erase_if(each, [](double value) { return std::isnan(value); });
    const bool has_bar = std::isfinite(bar.limit), is_met = bar.is_at_most ? interval.low <= bar.limit : interval.high >= bar.limit;
    fmt::print("{:<66} {:>8.3f}   [{:>5.3f}, {:>5.3f}] {:>8.3f} {:>8} {}\n", bar.what, figure, interval.low,
               interval.high, median(each), has_bar ? fmt::format("{} {}", bar.is_at_most ? "≤" : "≥", bar.limit) : "",
               !has_bar ? "" : is_met ? "met" : "missed");
  }
}

std::vector<DriveResult> run_drives(const Arguments& arguments, const std::string& profile, std::uint64_t first_seed,
                                    const std::map<std::string, ghosts::EvidenceWeights>& weights) {
  std::vector<DriveSpec> specs;
  for (const std::string& scenario : arguments.scenarios) {
    for (std::uint64_t seed = first_seed; seed < first_seed + arguments.seeds; ++seed) {
      specs.push_back({scenario, profile, seed, arguments.longest_s});
    }
  }
  std::vector<DriveResult> results(specs.size());
  parallel_for(specs.size(), arguments.jobs, [&](std::size_t i) {
    ghosts::Config config;
    config.evidence.weights = weights.at(specs[i].scenario);
    results[i] = run_drive(specs[i], config);
  });
  return results;
}

/// Weights for each scenario, fitted on drives of the others. The closed loop needs weights to begin with: those of the
/// profile.
std::map<std::string, ghosts::EvidenceWeights> fitted_on_others(const Arguments& arguments, const std::string& profile,
                                                                std::uint64_t first_seed,
                                                                const std::map<std::string, ghosts::EvidenceWeights>& begin) {
  const std::vector<DriveResult> drives = run_drives(arguments, profile, first_seed, begin);
  std::map<std::string, ghosts::EvidenceWeights> weights;
  for (std::size_t s = 0; s < arguments.scenarios.size(); ++s) {
    std::vector<ghosts::LabelledEvidence> evidence;
    for (std::size_t d = 0; d < drives.size(); ++d) {
      if (d / arguments.seeds == s) continue;
      evidence.insert(evidence.end(), drives[d].evidence.begin(), drives[d].evidence.end());
    }
    weights[arguments.scenarios[s]] = ghosts::fit_weights(evidence, {});
  }
  return weights;
}

int run(const Arguments& arguments) {
  const std::uint64_t first_seed = arguments.first_seed != 0
                                       ? arguments.first_seed
                                       : 1'000'000 + 1'000 * (std::random_device{}() % 1'000'000);
  fmt::print("scenarios: {}; seeds {} … {}; at most {} s\n", fmt::join(arguments.scenarios, " "), first_seed,
             first_seed + arguments.seeds - 1, arguments.longest_s);
  for (const std::string& profile : arguments.profiles) {
    const std::string file =
        profile.find('/') != std::string::npos ? profile : BORESIGHT_SOURCE_DIR "/config/radar_profiles/" + profile + ".toml";
    std::map<std::string, ghosts::EvidenceWeights> weights;
    const ghosts::EvidenceWeights of_profile =
        arguments.fit == "zero" ? ghosts::EvidenceWeights{} : ghosts::read_weights(std::filesystem::path(file));
    for (const std::string& scenario : arguments.scenarios) weights[scenario] = of_profile;
    if (arguments.fits_others) {
      // Other seeds than those that judge.
      weights = fitted_on_others(arguments, profile, first_seed + arguments.seeds, weights);
    }
    const std::vector<DriveResult> results = run_drives(arguments, profile, first_seed, weights);
    Drives drives;
    for (const DriveResult& each : results) drives.push_back(&each);
    print(profile, drives, arguments.fits_others);
    std::fflush(stdout);
    if (!arguments.fit.empty()) {
      std::vector<ghosts::LabelledEvidence> evidence;
      for (const DriveResult& each : results) evidence.insert(evidence.end(), each.evidence.begin(), each.evidence.end());
      std::ofstream("/tmp/w_" + profile + ".toml") << ghosts::weights_text(
          ghosts::fit_weights(evidence, {}),
          fmt::format("{} drives, seeds {} … {}, {} s", results.size(), first_seed, first_seed + arguments.seeds - 1, arguments.longest_s));
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Judges the ghost filter's probabilities on simulated drives");
  app.add_option("--scenarios", arguments.scenarios, "Names or files");
  app.add_option("--profiles", arguments.profiles, "Names or files of radar profiles, with weights of evidence");
  app.add_option("--seeds", arguments.seeds, "Drives of each scenario and profile")->check(CLI::Range(1, 1000));
  app.add_option("--seed", arguments.first_seed, "First seed; without: a fresh one");
  app.add_option("--duration", arguments.longest_s, "Longest drive, s");
  app.add_option("--jobs", arguments.jobs, "Threads")->check(CLI::Range(1, 64));
  app.add_flag("--fit-others", arguments.fits_others, "Fits the weights of each scenario on drives of the others");
  app.add_option("--fit", arguments.fit, "");
  try {
    app.parse(argc, argv);
    return run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kError;
  }
}
