// The recorded scenarios of the literature: accuracy of the PMBM filter beside the oracle with known association.
#include <cmath>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>

#include "services/boresight/track/estimates.hpp"
#include "services/boresight/track/gospa_score.hpp"
#include "services/boresight/track/measurement_table.hpp"
#include "services/boresight/track/scenario_file.hpp"
#include "services/boresight/track/tracker_run.hpp"
#include "services/tracker/core/model/scenario_model.hpp"
#include "services/tracker/core/pmbm/pmbm_filter.hpp"

namespace boresight::tracking::pmbm {
namespace {

/// Mean GOSPA a scan with the squared base distance, of objects more likely than not.
double mean_gospa_of(const std::filesystem::path& folder) {
  const track::ScenarioFile file = track::read_scenario_file(folder / "params.txt");
  const track::MeasurementTable table = track::read_measurements(folder / "measurements.csv", file.number_of_scans);
  ScenarioModel model(file.model);
  PmbmFilter filter(Parameters{}, Capacity{});
  track::ObjectsByStep estimates(file.number_of_scans);
  const auto scan = std::make_unique<ClassifiedScan>();
  for (std::size_t i = 0; i < file.number_of_scans; ++i) {
    track::fill_scan(table.scans[i], i + 1, file.model.step_s, *scan);
    filter.step(model, model.begin_scan(*scan).elapsed_s);
    EXPECT_FALSE(filter.work().budget_reached);
    EXPECT_EQ(filter.work().dropped_objects, 0U);
    for (const ObjectEstimate& e : filter.estimates()) {
      if (e.existence <= 0.5) continue;
      const Symmetric2<double> x = extent(*e.component);
      track::ExtendedObject object;
      object.ellipse.centre_m = {e.component->position_m.x, e.component->position_m.y};
      object.ellipse.extent_m2 << x.xx, x.xy, x.xy, x.yy;
      estimates[i].push_back(object);
    }
  }
  const track::ObjectsByStep truth = track::read_objects(folder / "truth.csv");
  const track::GospaScore score = track::score_gospa(truth, estimates, judge::GospaBase::kSquared);
  EXPECT_EQ(score.not_considered, 0U);
  testing::Test::RecordProperty(folder.filename().string(), std::to_string(score.mean().total()));
  return score.mean().total();
}

TEST(RecordedScenarios, AreTrackedAsWellAsByTheOracle) {
  const std::filesystem::path data = std::filesystem::path(BORESIGHT_SHARED_DATA) / "tracking_scenarios";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "skipped: no shared data";
  // The oracle knows the association of each measurement and filters existence with the scenario's own model.
  EXPECT_LE(mean_gospa_of(data / "xia_c30_s2"), 1.02 * 4.281);
  EXPECT_LE(mean_gospa_of(data / "xia_c60_s1"), 1.02 * 3.161);
  EXPECT_LE(mean_gospa_of(data / "hwy_c15_s11"), 1.10 * 0.921);
}

}  // namespace
}  // namespace boresight::tracking::pmbm
