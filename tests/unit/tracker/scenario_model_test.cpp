#include "services/tracker/core/model/scenario_model.hpp"

#include <array>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking {
namespace {

LinearScenario some_scenario() {
  LinearScenario s;
  s.step_s = 0.5;
  s.survival_probability = 0.97;
  s.rate_forgetting = 1.25;
  s.extent_memory_s = 4.0;
  s.acceleration_density = 1.5;
  s.detection_probability = 0.8;
  s.noise_variance_m2 = 0.1;
  s.clutter_per_scan = 20.0;
  s.area_min_m = {-50.0, -10.0};
  s.area_max_m = {150.0, 30.0};
  ScenarioBirth b;
  b.mean << 10.0, -5.0, 3.0, -1.0;
  b.std << 4.0, 3.0, 2.0, 1.0;
  b.extent_dof = 26.0;
  b.extent_scale << 80.0, 20.0, 20.0, 40.0;
  b.rate_shape = 12.0;
  b.rate_inverse_scale = 3.0;
  s.births = {b};
  s.birth_weight = 0.07;
  return s;
}

std::unique_ptr<ClassifiedScan> scan_at(std::int64_t time_ns, std::initializer_list<std::array<float, 3>> detections) {
  auto scan = std::make_unique<ClassifiedScan>();
  scan->header.measurement_time_ns = time_ns;
  scan->number_of_valid_detections = 0;
  for (const auto& [x_m, y_m, rate_mps] : detections) {
    const std::uint32_t i = scan->number_of_valid_detections++;
    scan->x_vehicle_m[i] = x_m;
    scan->y_vehicle_m[i] = y_m;
    scan->range_rate_over_ground_mps[i] = rate_mps;
  }
  return scan;
}

TEST(ScenarioModel, ReadsPlacesRangeRatesAndLinesOfSightFromTheOrigin) {
  LinearScenario s = some_scenario();
  s.range_rate_std_mps = 0.2;
  s.clutter_range_rate_span_mps = 40.0;
  ScenarioModel model(s);
  const ScanStart start = model.begin_scan(*scan_at(7, {{3.0F, 4.0F, -2.5F}, {0.0F, 0.0F, 1.0F}}));
  EXPECT_EQ(start.dropped_detections, 0U);
  EXPECT_FALSE(start.restarted);
  ASSERT_EQ(model.measurements().size(), 2U);
  const Measurement<double>& z = model.measurements()[0];
  EXPECT_EQ(z.position_m.x, 3.0);
  EXPECT_EQ(z.position_m.y, 4.0);
  EXPECT_NEAR(z.sight.x, 0.6, 1e-15);
  EXPECT_NEAR(z.sight.y, 0.8, 1e-15);
  EXPECT_EQ(z.range_rate_mps, -2.5);
  EXPECT_NEAR(z.log_clutter, std::log(20.0 / (200.0 * 40.0) / 40.0), 1e-12);
  EXPECT_EQ(squared_norm(model.measurements()[1].sight), 0.0) << "the origin is in no direction";
}

TEST(ScenarioModel, HasClutterPerAreaAloneWithoutRangeRates) {
  ScenarioModel model(some_scenario());
  static_cast<void>(model.begin_scan(*scan_at(0, {{3.0F, 4.0F, 0.0F}})));
  EXPECT_NEAR(model.measurements()[0].log_clutter, std::log(20.0 / (200.0 * 40.0)), 1e-12);
}

TEST(ScenarioModel, HasAFiniteClutterDensityWithoutAnyClutter) {
  LinearScenario s = some_scenario();
  s.clutter_per_scan = 0.0;
  ScenarioModel model(s);
  static_cast<void>(model.begin_scan(*scan_at(0, {{3.0F, 4.0F, 0.0F}})));
  EXPECT_TRUE(std::isfinite(model.measurements()[0].log_clutter));
  EXPECT_LT(model.measurements()[0].log_clutter, -20.0);
}

TEST(ScenarioModel, TakesOneStepToTheFirstScanAndThenTheTimeBetweenScans) {
  ScenarioModel model(some_scenario());
  EXPECT_EQ(model.begin_scan(*scan_at(9'000'000'000, {})).elapsed_s, 0.5);
  EXPECT_NEAR(model.begin_scan(*scan_at(9'500'000'000, {})).elapsed_s, 0.5, 1e-12);
  EXPECT_NEAR(model.begin_scan(*scan_at(11'000'000'000, {})).elapsed_s, 1.5, 1e-12);
  EXPECT_TRUE(model.measurements().empty());
}

TEST(ScenarioModel, ForgetsRateAndExtentByTheScenariosFactors) {
  const ScenarioModel model(some_scenario());
  Component<double> c;
  c.rate_shape = 10.0;
  c.rate_inverse_scale = 2.0;
  c.extent_dof = 26.0;
  c.extent_scale = {80.0, 0.0, 40.0};
  support::Reference expected = support::reference_of(c);
  EXPECT_EQ(model.predict(c, 0.5), 0.97);
  EXPECT_NEAR(c.rate_shape, 8.0, 1e-12) << "divided by the factor in one step";
  EXPECT_NEAR(c.rate_inverse_scale, 1.6, 1e-12);
  EXPECT_NEAR(c.extent_dof, 6.0 + 20.0 * std::exp(-0.125), 1e-12);
  MotionParameters motion;
  motion.acceleration_density = 1.5;
  motion.rate_memory_s = 0.5 / std::log(1.25);
  motion.extent_memory_s = 4.0;
  support::predict_reference(expected, motion, 0.5);
  support::expect_equal(support::reference_of(c), expected, 1e-12);
}

TEST(ScenarioModel, WithoutForgettingKeepsTheRate) {
  LinearScenario s = some_scenario();
  s.rate_forgetting = 1.0;
  const ScenarioModel model(s);
  Component<double> c;
  c.rate_shape = 10.0;
  c.extent_scale = {4.0, 0.0, 4.0};
  static_cast<void>(model.predict(c, 0.5));
  EXPECT_NEAR(c.rate_shape, 10.0, 1e-9);
}

TEST(ScenarioModel, HasTheScenariosBirthsEveryScan) {
  const ScenarioModel model(some_scenario());
  ASSERT_EQ(model.births().size(), 1U);
  EXPECT_EQ(model.births()[0].weight, 0.07);
  const support::Reference r = support::reference_of(model.births()[0].component);
  EXPECT_EQ(r.mean, Eigen::Vector4d(10.0, -5.0, 3.0, -1.0));
  EXPECT_EQ(Eigen::Vector4d(r.covariance.diagonal()), Eigen::Vector4d(16.0, 9.0, 4.0, 1.0));
  EXPECT_EQ(r.covariance(0, 2), 0.0);
  EXPECT_EQ(r.scale(0, 1), 20.0);
  EXPECT_EQ(r.dof, 26.0);
  EXPECT_EQ(r.rate_shape, 12.0);
  EXPECT_FALSE(model.has_births_anywhere());
}

TEST(ScenarioModel, LinksDetectionsWithinFourDeviationsOfANewborn) {
  const LinearScenario s = some_scenario();
  const ScenarioModel model(s);
  const Eigen::Matrix2d r = 0.25 * s.births[0].extent_scale / 20.0 + 0.1 * Eigen::Matrix2d::Identity();
  const double expected = 4.0 * std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(r).eigenvalues()(1));
  EXPECT_NEAR(model.link_distance_m(), expected, 1e-12);
  Measurement<double> a, b;
  b.position_m = {expected * 0.999, 0.0};
  EXPECT_TRUE(model.are_linked(a, b));
  b.position_m = {0.0, expected * 1.001};
  EXPECT_FALSE(model.are_linked(a, b));
}

TEST(ScenarioModel, LinksNoDetectionsWhoseRangeRatesAreNotOfOneVelocity) {
  LinearScenario s = some_scenario();
  s.range_rate_std_mps = 0.1;
  const ScenarioModel model(s);
  const auto at = [](double x_m, double y_m, double rate_mps) {
    Measurement<double> z = support::detection_at({x_m, y_m}, {0.0, 0.0}, 0.0, 0.0);
    z.range_rate_mps = rate_mps;
    return z;
  };
  EXPECT_TRUE(model.are_linked(at(40.0, 0.0, 5.0), at(41.0, 0.0, 5.5)));
  EXPECT_FALSE(model.are_linked(at(40.0, 0.0, 5.0), at(41.0, 0.0, 5.6))) << "one line of sight, noise alone";
  // Across the line of sight the range rates of one velocity differ; the fastest newborn has (9, 4) m/s.
  EXPECT_TRUE(model.are_linked(at(10.0, 2.0, 5.0), at(10.0, -2.0, 8.0)));
  EXPECT_FALSE(model.are_linked(at(10.0, 2.0, 5.0), at(10.0, -2.0, 10.0)));
}

TEST(ScenarioModel, SeesEveryObjectAlike) {
  LinearScenario s = some_scenario();
  s.range_rate_std_mps = 0.3;
  const ScenarioModel model(s);
  for (const double x_m : {0.0, 100.0, 1e4}) {
    Component<double> c;
    c.position_m.x = x_m;
    const View<double> view = model.view(c);
    EXPECT_EQ(view.detection_probability, 0.8);
    EXPECT_EQ(view.exposure, 1.0);
    EXPECT_EQ(view.spread, 0.25);
    EXPECT_EQ(view.noise_m2.xx, 0.1);
    EXPECT_EQ(view.noise_m2.xy, 0.0);
    EXPECT_NEAR(view.range_rate_variance, 0.09, 1e-15);
  }
}

}  // namespace
}  // namespace boresight::tracking
