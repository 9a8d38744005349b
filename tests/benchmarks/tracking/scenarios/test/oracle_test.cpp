#include "tests/benchmarks/tracking/scenarios/common/oracle.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/benchmarks/tracking/scenarios/common/draw.hpp"
#include "tests/benchmarks/tracking/scenarios/common/outcome.hpp"
#include "tests/benchmarks/tracking/scenarios/common/shared_data.hpp"
#include "tests/benchmarks/tracking/scenarios/test/scenarios.hpp"

namespace boresight::bench::scenarios {
namespace {

TEST(Oracle, HasOneEstimateNearEachTarget) {
  const Scenario scenario = testing::two_cars();
  const track::ObjectsByStep estimates = oracle_estimates(scenario, draw_measurements(scenario, 1));
  ASSERT_EQ(estimates.size(), 200U);
  std::size_t number = 0;
  for (std::size_t i = 20; i < estimates.size(); ++i) {
    for (const track::ExtendedObject& estimate : estimates[i]) {
      const track::ExtendedObject& car = scenario.truth[i][estimate.id - 1];
      EXPECT_LT((estimate.ellipse.centre_m - car.ellipse.centre_m).norm(), 2.0) << i;
      EXPECT_NEAR(estimate.velocity_mps.x(), 5.0, 3.0) << i;
      ++number;
    }
  }
  // Two misses in succession, of which there are 1 %, make an existence below one half.
  EXPECT_GT(number, 340U);
  EXPECT_LE(number, 360U);
}

TEST(Oracle, FiltersExistenceAfterTheLastDetection) {
  const Scenario scenario = testing::two_cars();
  Measurements drawn = draw_measurements(scenario, 2);
  constexpr std::size_t kEnd = 100;
  for (std::size_t i = kEnd; i < drawn.scans.size(); ++i) {
    drawn.scans[i].clear();
    drawn.origins[i].clear();
  }
  // A detection before the end, so that existence is 1 there.
  drawn.scans[kEnd - 1] = {{{0.0, -20.0}, kNaN}};
  drawn.origins[kEnd - 1] = {1};
  const track::ObjectsByStep estimates = oracle_estimates(scenario, drawn);
  const auto has = [&](std::size_t i, std::uint32_t id) {
    return std::any_of(estimates[i].begin(), estimates[i].end(), [id](const auto& object) { return object.id == id; });
  };
  EXPECT_TRUE(has(kEnd - 1, 1));
  // P_S = 0.99 and P_D = 0.9: existence is about 0.91 after one miss, 0.5 after two, 0.1 after three.
  EXPECT_TRUE(has(kEnd, 1));
  EXPECT_FALSE(has(kEnd + 2, 1));
}

/// What the prototype's oracle has on the recorded scenarios: another implementation.
TEST(Oracle, HasThePublishedFiguresOnRecordedScenarios) {
  const std::filesystem::path data = BORESIGHT_SHARED_DATA;
  if (!std::filesystem::exists(data / "tracking_scenarios")) GTEST_SKIP() << "skipped: no shared data";
  struct Figures {
    const char* name;
    double squared, root;
    double reference_pmbm_squared, reference_phd_root;
  };
  for (const Figures& expected :
       {Figures{"xia_c30_s2", 4.281, 5.480, 4.979, 12.128}, Figures{"xia_c60_s1", 3.161, 4.796, 3.333, 12.011},
        Figures{"hwy_c15_s11", 0.921, 1.653, 3.006, 8.485}}) {
    const RecordedScenario shared = read_recorded_scenario(data, expected.name);
    const MeanGospa oracle = run_oracle(shared.scenario, shared.recorded).gospa;
    EXPECT_NEAR(oracle.squared, expected.squared, 2e-3) << expected.name;
    EXPECT_NEAR(oracle.root, expected.root, 2e-3) << expected.name;
    EXPECT_NEAR(shared.reference_pmbm.squared, expected.reference_pmbm_squared, 1e-3) << expected.name;
    EXPECT_NEAR(shared.reference_phd.root, expected.reference_phd_root, 1e-3) << expected.name;
  }
}

TEST(SplitMergeData, HasTenRunsOfFiveTargets) {
  const std::filesystem::path data = BORESIGHT_SHARED_DATA;
  if (!std::filesystem::exists(data / "ett_pmbm_benchmark")) GTEST_SKIP() << "skipped: no shared data";
  const SplitMerge published = read_split_merge(data);
  EXPECT_EQ(published.runs.size(), 10U);
  EXPECT_EQ(published.scenario.truth.size(), 40U);
  for (const auto& step : published.scenario.truth) EXPECT_EQ(step.size(), 5U);
  EXPECT_EQ(published.runs.front().scans.size(), 40U);
  EXPECT_EQ(published.runs.front().scans.front().size(), 33U);
}

}  // namespace
}  // namespace boresight::bench::scenarios
