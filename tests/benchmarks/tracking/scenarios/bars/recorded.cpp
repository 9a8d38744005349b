// The three recorded scenarios of the shared data, beside the oracle and the reference code.
#include "tests/benchmarks/tracking/scenarios/bars/bars.hpp"
#include "tests/benchmarks/tracking/scenarios/common/outcome.hpp"

namespace boresight::bench::scenarios {

namespace {

struct RecordedBar {
  const char* name;
  double ratio_to_oracle;
};
constexpr RecordedBar kRecorded[] = {{"xia_c30_s2", 1.02}, {"xia_c60_s1", 1.02}, {"hwy_c15_s11", 1.10}};

void judge_pmbm(const RecordedBar& bar, const RecordedScenario& shared, const Runs& pmbm, Report& report) {
  constexpr double kOfReference = 0.95;
  judge_ratio("recorded", pmbm, bar.ratio_to_oracle, "one recording", report);
  report.at_most("recorded", pmbm.scenario + ", pmbm: ratio to the reference PMBM, squared",
                 pmbm.mean().squared / shared.reference_pmbm.squared, kOfReference, "", "one recording");
}

void judge_phd(const RecordedScenario& shared, const Runs& phd, const Runs& pmbm, Report& report) {
  constexpr double kOfPhd = 0.5;
  const std::string how = "one recording";
  report.at_most("recorded", phd.scenario + ", phd: GOSPA, squared", phd.mean().squared, shared.reference_phd.squared,
                 "", "one recording; bar: the reference PHD");
  report.at_most("recorded", phd.scenario + ", phd: GOSPA, true", phd.mean().root, shared.reference_phd.root, "",
                 "one recording; bar: the reference PHD");
  // Of the reference, because a better comparison filter must not make this bar fail.
  report.at_most("recorded", phd.scenario + ": pmbm over the reference PHD, squared",
                 pmbm.mean().squared / shared.reference_phd.squared, kOfPhd, "", how);
  report.beside("recorded", phd.scenario + ": pmbm over phd, squared", pmbm.mean().squared / phd.mean().squared, "",
                how);
}

}  // namespace

void recorded(const Options& options, Report& report) {
  if (!has_shared_data(options.data_folder, "recorded")) return;
  constexpr double kMeanCpu_ms = 0.15, kWorstCpu_ms = 0.5;
  const std::size_t repeats = passes(options, 10);
  Table table{"recorded",
              "recorded scenarios: mean GOSPA a scan. Reference: the reference code's filter of the same kind.",
              outcome_header(),
              {}};
  for (const RecordedBar& bar : kRecorded) {
    const RecordedScenario shared = read_recorded_scenario(options.data_folder, bar.name);
    const Outcome oracle = run_oracle(shared.scenario, shared.recorded);
    const auto run = [&](const std::string& tracker) {
      return Runs{bar.name, tracker, {run_tracker(tracker, shared.scenario, shared.recorded, repeats)}, {oracle}};
    };
    const Runs pmbm = run("pmbm"), phd = run("phd");
    for (const Runs* const runs : {&pmbm, &phd}) {
      table.rows.push_back(row_of(*runs, runs == &phd ? &shared.reference_phd : &shared.reference_pmbm));
      judge_cpu("recorded", *runs, kMeanCpu_ms, kWorstCpu_ms, "least of " + std::to_string(repeats) + " passes",
                report);
    }
    judge_pmbm(bar, shared, pmbm, report);
    judge_phd(shared, phd, pmbm, report);
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench::scenarios
