#include "tests/benchmarks/tracking/scenarios/common/draw.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "tests/benchmarks/tracking/scenarios/test/scenarios.hpp"

namespace boresight::bench::scenarios {
namespace {

std::map<std::uint32_t, std::size_t> counts_of(const Measurements& drawn) {
  std::map<std::uint32_t, std::size_t> counts;
  for (const auto& origins : drawn.origins) {
    for (const std::uint32_t origin : origins) ++counts[origin];
  }
  return counts;
}

TEST(DrawnMeasurements, HaveTheNumbersOfTheModel) {
  const Scenario scenario = testing::two_cars();
  const Measurements drawn = draw_measurements(scenario, 7);
  ASSERT_EQ(drawn.scans.size(), scenario.truth.size());
  const std::map<std::uint32_t, std::size_t> counts = counts_of(drawn);
  // Five standard deviations of 200 scans; a target's count is a Poisson number that is zero with 1 − P_D.
  const auto expect_mean = [&](std::uint32_t id, double mean, double variance) {
    EXPECT_NEAR(static_cast<double>(counts.at(id)), 200.0 * mean, 5.0 * std::sqrt(200.0 * variance)) << id;
  };
  const double p = scenario.model.detection_probability;
  expect_mean(1, p * 6.0, p * 6.0 + p * (1.0 - p) * 36.0);
  expect_mean(2, p * 10.0, p * 10.0 + p * (1.0 - p) * 100.0);
  expect_mean(0, 5.0, 5.0);
}

TEST(DrawnMeasurements, ScatterWithTheExtentAndTheNoise) {
  const Scenario scenario = testing::two_cars();
  const Measurements drawn = draw_measurements(scenario, 8);
  double n = 0.0, xx = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < drawn.scans.size(); ++i) {
    for (std::size_t k = 0; k < drawn.scans[i].size(); ++k) {
      if (drawn.origins[i][k] != 2) continue;
      const Eigen::Vector2d offset_m = drawn.scans[i][k].position_m - scenario.truth[i][1].ellipse.centre_m;
      n += 1.0;
      xx += offset_m.x() * offset_m.x();
      yy += offset_m.y() * offset_m.y();
    }
  }
  const auto expect_variance = [&](double sum, double variance) {
    EXPECT_NEAR(sum / n, variance, 5.0 * variance * std::sqrt(2.0 / n));
  };
  expect_variance(xx, 0.25 * 2.3 * 2.3 + 0.09);
  expect_variance(yy, 0.25 * 0.9 * 0.9 + 0.09);
}

TEST(DrawnMeasurements, DependOnTheSeedOnly) {
  const Scenario scenario = testing::two_cars();
  const Measurements a = draw_measurements(scenario, 9), b = draw_measurements(scenario, 9);
  EXPECT_EQ(a.origins, b.origins);
  EXPECT_EQ(a.scans[3][0].position_m, b.scans[3][0].position_m);
  EXPECT_NE(a.origins, draw_measurements(scenario, 10).origins);
}

TEST(DrawnMeasurements, HaveRangeRatesOfTheirOrigin) {
  Scenario scenario = testing::two_cars();
  scenario.model.range_rate_std_mps = 0.1;
  scenario.model.clutter_range_rate_span_mps = 40.0;
  const Measurements drawn = draw_measurements(scenario, 11);
  double largest_clutter_mps = 0.0;
  for (std::size_t i = 0; i < drawn.scans.size(); ++i) {
    for (std::size_t k = 0; k < drawn.scans[i].size(); ++k) {
      const track::MeasuredPoint& point = drawn.scans[i][k];
      if (drawn.origins[i][k] == 0) {
        largest_clutter_mps = std::max(largest_clutter_mps, std::abs(point.range_rate_mps));
      } else {
        const double along_mps = 5.0 * point.position_m.x() / point.position_m.norm();
        EXPECT_NEAR(point.range_rate_mps, along_mps, 0.6);
      }
    }
  }
  EXPECT_GT(largest_clutter_mps, 19.0);
  EXPECT_LE(largest_clutter_mps, 20.0);
}

TEST(DrawnOrigins, AreThoseOfObjectsThatLieApart) {
  const Scenario scenario = testing::two_cars();
  const Measurements drawn = draw_measurements(scenario, 12);
  Measurements recorded{drawn.scans, {}};
  draw_origins(scenario, 13, recorded);
  std::size_t all = 0, wrong = 0;
  for (std::size_t i = 0; i < drawn.origins.size(); ++i) {
    for (std::size_t k = 0; k < drawn.origins[i].size(); ++k) {
      ++all;
      wrong += recorded.origins[i][k] != drawn.origins[i][k] ? 1 : 0;
    }
  }
  EXPECT_GT(all, 3000U);
  EXPECT_LT(wrong, all / 100);
}

TEST(MadeScenario, HasTheWantedSizeInOneArea) {
  const Scenario scenario = make_scenario(30, 500, 10, 3);
  EXPECT_EQ(scenario.truth.size(), 10U);
  EXPECT_EQ(scenario.truth.front().size(), 30U);
  // P_D = 0.9 of 8 detections each
  EXPECT_DOUBLE_EQ(scenario.model.clutter_per_scan, 500.0 - 30.0 * 0.9 * 8.0);
  EXPECT_EQ(scenario.model.area_max_m, make_scenario(3, 50, 10, 3).model.area_max_m);
  EXPECT_THROW((void)make_scenario(30, 100, 10, 3), std::invalid_argument);
}

}  // namespace
}  // namespace boresight::bench::scenarios
