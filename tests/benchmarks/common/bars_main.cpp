#include "tests/benchmarks/common/bars_main.hpp"

#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace boresight::bench {

namespace {

bool write(const std::string& path, const Report& report, void (Report::*writer)(std::ostream&) const) {
  if (path.empty()) return true;
  std::ofstream out(path);
  (report.*writer)(out);
  out.flush();
  if (!out) std::fprintf(stderr, "cannot write %s\n", path.c_str());
  return static_cast<bool>(out);
}

/// 1,000,000 or more, with six zeros at the end: far from every fixed seed, and easy to copy.
std::uint64_t draw_fresh_seed() {
  constexpr std::uint64_t kStep = 1'000'000, kSteps = 1'000'000;
  return kStep * (1 + std::random_device{}() % kSteps);
}

int run(int argc, char** argv, const BarsProgram& program, std::span<const BarGroup> groups) {
  Options options;
  std::string json, markdown;
  CLI::App app{std::string(program.about) + " Exit code 0 also if bars fail, 1 on an error."};
  std::vector<std::string> names;
  for (const BarGroup& group : groups) names.emplace_back(group.name);
  app.add_flag("--quick", options.quick, "two seeds and short drives: a check that it runs, not a measurement");
  app.add_option("--most-seeds", options.most_seeds, "upper limit of the number of seeds, for a quick look");
  app.add_option("--only", options.only, "run one group of bars only")->check(CLI::IsMember(names));
  app.add_option("--profile", options.profile,
                 "radar profile of the simulated radars, by name or file; groups that it does not concern are skipped, "
                 "and bars are judged with " +
                     std::string(kJudgedProfile) + " only")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  if (program.has_real_car) {
    app.add_flag(
        "--real-car", options.real_car,
        "the simulated vehicle has all effects of a real car; as with another profile, bars are not judged and "
        "groups that it does not concern are skipped");
  }
  app.add_option("--jobs", options.jobs, "threads")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--json", json, "write bars, tables and curves to this file");
  app.add_option("--markdown", markdown,
                 "write the tables to this file, between the marks of " + std::string(program.document));
  if (program.data_option != nullptr) {
    app.add_option(program.data_option, options.data_folder, program.data_about)->check(CLI::ExistingDirectory);
  }
  if (program.first_seed_about != nullptr) {
    app.add_option("--first-seed", options.first_seed, program.first_seed_about)->capture_default_str();
  }
  options.fresh_seed = 0;
  if (program.fresh_seed_about != nullptr) {
    app.add_option("--fresh-seed", options.fresh_seed, program.fresh_seed_about);
  }
  if (!program.methods.empty()) {
    app.add_option("--method", options.method, "judge this method as the product's own; default: that of the product")
        ->check(CLI::IsMember(program.methods));
  }
  CLI11_PARSE(app, argc, argv);
  if (options.fresh_seed == 0) options.fresh_seed = draw_fresh_seed();

  if (!options.judges()) std::printf("radar profile %s: no bar is judged\n", options.drives().c_str());
  if (program.fresh_seed_about != nullptr) {
    std::printf("fresh seeds from %llu on\n", static_cast<unsigned long long>(options.fresh_seed));
  }
  Report report(options.drives(), options.judges());
  for (const BarGroup& group : groups) {
    if (!options.wants(group.name)) continue;
    if (!options.judges() && !group.has_profile) {
      std::fprintf(stderr, "%s: skipped, it does not depend on the radar profile or the car\n", group.name);
      continue;
    }
    std::fprintf(stderr, "%s\n", group.name);
    group.run(options, report);
  }
  report.print(std::cout);
  return write(json, report, &Report::write_json) && write(markdown, report, &Report::write_markdown) ? 0 : 1;
}

}  // namespace

int bars_main(int argc, char** argv, const BarsProgram& program, std::span<const BarGroup> groups) {
  try {
    return run(argc, argv, program, groups);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace boresight::bench
