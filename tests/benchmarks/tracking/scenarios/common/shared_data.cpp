#include "tests/benchmarks/tracking/scenarios/common/shared_data.hpp"

#include <cmath>
#include <cstdio>

#include "services/boresight/score/table.hpp"
#include "services/boresight/track/gospa_score.hpp"
#include "services/boresight/track/scenario_file.hpp"

namespace boresight::bench::scenarios {

namespace {

namespace fs = std::filesystem;

constexpr double kFarthest_m = 1e6, kFastest_mps = 1e3;
constexpr std::int64_t kMaxId = 1'000'000;

std::map<std::uint32_t, double> read_rates(const fs::path& file) {
  constexpr double kMost = 1e3;
  std::map<std::uint32_t, double> rates;
  score::Table table(file, {"id", "lambda"});
  while (table.next()) {
    rates[static_cast<std::uint32_t>(table.integer("id", 1, kMaxId))] = table.number("lambda", 0.0, kMost);
  }
  return rates;
}

/// Rows in the order of the measurements.
std::vector<std::vector<std::uint32_t>> read_origins(const fs::path& file, std::size_t number_of_scans) {
  std::vector<std::vector<std::uint32_t>> origins(number_of_scans);
  score::Table table(file, {"step", "truth_id_or_0"});
  while (table.next()) {
    const std::int64_t step = table.integer("step", 1, static_cast<std::int64_t>(number_of_scans));
    origins[static_cast<std::size_t>(step - 1)].push_back(
        static_cast<std::uint32_t>(table.integer("truth_id_or_0", 0, kMaxId)));
  }
  return origins;
}

/// Parameters of modelparas2.m of the published code, which stands beside the data's README.
tracking::LinearScenario split_merge_model() {
  constexpr double kRateWindow = 20.0, kExtentWindow = 10.0;  // scans that count
  tracking::LinearScenario model;
  model.survival_probability = 0.99;
  model.step_s = 1.0;
  model.acceleration_density = 0.25;  // its velocity noise has a standard deviation of 0.5 m/s a step
  model.rate_forgetting = 1.0 / (1.0 - 1.0 / kRateWindow);
  model.extent_memory_s = 1.0 / (std::log(kExtentWindow) - std::log(kExtentWindow - 1.0));
  model.detection_probability = 0.7;
  model.spread = 1.0;
  model.noise_variance_m2 = 0.01;
  model.clutter_per_scan = 10.0;
  model.area_min_m = {-100.0, -100.0};
  model.area_max_m = {100.0, 100.0};
  model.birth_weight = 0.01;
  tracking::ScenarioBirth birth;
  birth.std = {50.0, 50.0, 5.0, 5.0};
  birth.extent_scale = 10.0 * Eigen::Matrix2d::Identity();
  birth.extent_dof = 14.0;
  birth.rate_shape = 5e3;
  birth.rate_inverse_scale = 1e3;
  model.births = {birth};
  return model;
}

track::ObjectsByStep read_split_merge_truth(const fs::path& file) {
  constexpr double kLargest_m2 = 1e4;
  track::ObjectsByStep truth;
  score::Table table(file, {"target", "k", "s0", "s1", "s2", "s3", "X11", "X12", "X22"});
  while (table.next()) {
    const auto step = static_cast<std::size_t>(table.integer("k", 1, kMaxId));
    if (truth.size() < step) truth.resize(step);
    track::ExtendedObject& object = truth[step - 1].emplace_back();
    object.id = static_cast<std::uint32_t>(table.integer("target", 1, kMaxId));
    object.ellipse.centre_m = {table.number("s0", -kFarthest_m, kFarthest_m),
                               table.number("s1", -kFarthest_m, kFarthest_m)};
    object.velocity_mps = {table.number("s2", -kFastest_mps, kFastest_mps),
                           table.number("s3", -kFastest_mps, kFastest_mps)};
    const double xy = table.number("X12", -kLargest_m2, kLargest_m2);
    object.ellipse.extent_m2 << table.number("X11", 0.0, kLargest_m2), xy, xy, table.number("X22", 0.0, kLargest_m2);
  }
  return truth;
}

}  // namespace

MeanGospa mean_gospa(const track::ObjectsByStep& truth, const track::ObjectsByStep& estimates) {
  return {track::score_gospa(truth, estimates, judge::GospaBase::kSquared).mean().total(),
          track::score_gospa(truth, estimates, judge::GospaBase::kRoot).mean().total()};
}

RecordedScenario read_recorded_scenario(const fs::path& data_folder, const std::string& name) {
  const fs::path folder = data_folder / "tracking_scenarios" / name;
  const track::ScenarioFile file = track::read_scenario_file(folder / "params.txt");
  RecordedScenario result;
  result.scenario = {name, file.model, track::read_objects(folder / "truth.csv"),
                     read_rates(folder / "truth_rates.csv")};
  result.scenario.truth.resize(file.number_of_scans);
  result.recorded = {track::read_measurements(folder / "measurements.csv", file.number_of_scans).scans,
                     read_origins(folder / "measurement_origin.csv", file.number_of_scans)};
  const track::ObjectsByStep& truth = result.scenario.truth;
  result.reference_pmbm = mean_gospa(truth, track::read_objects(folder / "estimates_ref_pmbm_sym.csv"));
  result.reference_phd = mean_gospa(truth, track::read_objects(folder / "estimates_phd.csv"));
  return result;
}

SplitMerge read_split_merge(const fs::path& data_folder) {
  constexpr std::int64_t kMostRuns = 100;
  const fs::path folder = data_folder / "ett_pmbm_benchmark";
  SplitMerge result;
  result.scenario = {"split_merge", split_merge_model(), read_split_merge_truth(folder / "splitmerge_truth.csv"), {}};
  const std::size_t scans = result.scenario.truth.size();
  const tracking::ScenarioBirth& birth = result.scenario.model.births.front();
  for (const auto& step : result.scenario.truth) {
    for (const track::ExtendedObject& object : step) {
      result.scenario.detections_per_scan[object.id] = birth.rate_shape / birth.rate_inverse_scale;
    }
  }
  score::Table table(folder / "splitmerge_Z_mc1-10.csv", {"mc", "k", "x", "y"});
  while (table.next()) {
    const auto run = static_cast<std::size_t>(table.integer("mc", 1, kMostRuns));
    const auto step = static_cast<std::size_t>(table.integer("k", 1, static_cast<std::int64_t>(scans)));
    while (result.runs.size() < run) result.runs.emplace_back().scans.resize(scans);
    result.runs[run - 1].scans[step - 1].push_back(
        {{table.number("x", -kFarthest_m, kFarthest_m), table.number("y", -kFarthest_m, kFarthest_m)}, kNaN});
  }
  return result;
}

bool has_shared_data(const fs::path& data_folder, const char* group) {
  const bool has = !data_folder.empty() && fs::exists(data_folder / "tracking_scenarios") &&
                   fs::exists(data_folder / "ett_pmbm_benchmark");
  if (!has) std::printf("%s: skipped: no shared data\n", group);
  return has;
}

}  // namespace boresight::bench::scenarios
