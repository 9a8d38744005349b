// The box estimator in single scans and in degenerate cases.
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/tracker/simulated_object.hpp"

namespace boresight::tracking {
namespace {

using extended_object::kRoadUserClasses;
using extended_object::RoadUserClass;

constexpr std::size_t kBoxCar = support::index_of(RoadUserClass::kCar),
                      kBoxTruck = support::index_of(RoadUserClass::kTruck);

BoxEstimator default_estimator() {
  return {support::class_table(), BoxParameters{}};
}

/// Of an object at a place with a course that is known well.
Component<double> driving(const Eigen::Vector2d& position_m, double course_rad, double speed_mps) {
  Component<double> c;
  c.label = 1;
  c.position_m = support::vector_of(position_m);
  c.velocity_mps = {speed_mps * std::cos(course_rad), speed_mps * std::sin(course_rad)};
  c.position_covariance = {0.04, 0.0, 0.04};
  c.velocity_covariance = {0.01, 0.0, 0.01};
  c.extent_dof = 20.0;
  c.extent_scale = {14.0, 0.0, 14.0};
  return c;
}
BoxObservation observed(const Component<double>& c, double n) {
  BoxObservation o;
  o.elapsed_s = 0.05;
  o.noise_m2 = {0.03, 0.0, 0.05};
  o.detections = n;
  o.mean_m = o.predicted_m = c.position_m;
  o.scatter = {0.3 * std::max(0.0, n - 1.0), 0.0, 0.3 * std::max(0.0, n - 1.0)};
  o.predicted_covariance_m2 = c.position_covariance;
  return o;
}
double speed_of(const Component<double>& c) {
  return std::sqrt(squared_norm(c.velocity_mps));
}
/// Shows its tracked point to a viewpoint for some scans.
BoxMemory remembered(const BoxEstimator& e, const Component<double>& c, const Viewpoint& from, int scans = 3) {
  BoxMemory m = e.begin();
  for (int i = 0; i < scans; ++i) e.update(m, c, observed(c, 2.0), e.view(m, c.position_m, speed_of(c), from));
  return m;
}
void expect_finite(const Box& b) {
  EXPECT_TRUE(b.centre_m.allFinite() && b.covariance_m2.allFinite() && b.centre_length_covariance_m2.allFinite());
  EXPECT_GT(b.covariance_m2.determinant(), 0.0);
  EXPECT_TRUE(std::isfinite(b.heading_rad + b.heading_variance_rad2 + b.height_m));
  EXPECT_GT(b.length_m, 0.0);
  EXPECT_GT(b.width_m, 0.0);
  EXPECT_GT(b.length_variance_m2, 0.0);
  EXPECT_GT(b.width_variance_m2, 0.0);
}
void expect_probabilities(const BoxMemory& m) {
  double sum = 0.0;
  for (const double p : m.probability) {
    EXPECT_GE(p, 0.0);
    sum += p;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(BoxEstimator, SameViewHasNoOffset) {
  const BoxEstimator e = default_estimator();
  const Viewpoint from{{0.0, 0.0}};
  const Component<double> c = driving({40.0, 0.0}, 0.0, 10.0);
  const BoxMemory m = remembered(e, c, from);
  ASSERT_TRUE(m.has_point);
  const ClassViews views = e.view(m, c.position_m, 10.0, from);
  for (const ClassView& v : views) {
    if (v.probability <= 0.0) continue;
    EXPECT_LT(v.offset_m.norm(), 0.05);
    EXPECT_LT(v.offset_covariance_m2.norm(), 0.05);
  }
  EXPECT_EQ(views[kBoxCar].reflections.share_in_view, 1.0);
}

TEST(BoxEstimator, ViewFromTheOtherEndIsOffsetTowardsIt) {
  const BoxEstimator e = default_estimator();
  const Component<double> c = driving({40.0, 0.0}, 0.0, 10.0);
  const BoxMemory m = remembered(e, c, {{0.0, 0.0}});
  const ClassViews views = e.view(m, c.position_m, 10.0, {{90.0, 0.0}});
  ASSERT_GT(views[kBoxCar].probability, 0.0);
  ASSERT_GT(views[kBoxTruck].probability, 0.0);
  EXPECT_GT(views[kBoxCar].offset_m.x(), 1.5);
  EXPECT_LT(views[kBoxCar].offset_m.x(), 4.6);
  EXPECT_GT(views[kBoxTruck].offset_m.x(), views[kBoxCar].offset_m.x());
  EXPECT_GT(views[kBoxTruck].offset_covariance_m2(0, 0), 10.0 * views[kBoxCar].offset_covariance_m2(0, 0))
      << "lengths of trucks are known badly";
  EXPECT_NEAR(views[kBoxTruck].offset_m.y(), 0.0, 0.1);
}

TEST(BoxEstimator, CentreLiesBehindWhatIsSeen) {
  const BoxEstimator e = default_estimator();
  for (const double course_rad : {0.0, 0.5 * std::numbers::pi, std::numbers::pi, -1.0}) {
    const Component<double> c = driving({30.0, 0.0}, course_rad, 10.0);
    const BoxMemory m = remembered(e, c, {{0.0, 0.0}});
    const Box b = e.box(m, c, {0.0, 0.0});
    EXPECT_GT(b.centre_m.x(), 30.2) << course_rad;
    EXPECT_LT(b.centre_m.x(), 34.0) << course_rad;
  }
}

TEST(BoxEstimator, PlacesOfTheBoxAreInsideAndThoseBesideAreNot) {
  const BoxEstimator e = default_estimator();
  const Component<double> c = driving({30.0, 0.0}, 0.0, 10.0);
  const BoxMemory m = remembered(e, c, {{0.0, 0.0}});
  const Symmetric2<double> small{0.01, 0.0, 0.01};
  const auto at = [&](double x, double y) { return e.inside(m, kBoxCar, e.place(m, {x, y}, small), {0.0, 0.0}); };
  EXPECT_GT(at(1.5, 0.0), 0.95);
  EXPECT_LT(at(1.5, 3.0), 1e-3);
  EXPECT_LT(at(-3.0, 0.0), 1e-3);
  EXPECT_LT(at(8.0, 0.0), 1e-3);
  EXPECT_GT(e.inside(m, kBoxCar, e.place(m, {1.5, 1.5}, small), {0.0, 1.5}), 0.95) << "the margin counts";
  for (double x = -20.0; x <= 20.0; x += 0.5) {
    for (double y = -5.0; y <= 5.0; y += 0.5) {
      const double p = at(x, y);
      EXPECT_GE(p, 0.0);
      EXPECT_LE(p, 1.0);
      EXPECT_GE(e.inside(m, kBoxCar, e.place(m, {x, y}, small), {1.0, 1.0}), p - 1e-12);
    }
  }
}

TEST(BoxEstimator, PartFarBehindMakesATruckOfACar) {
  const BoxEstimator e = default_estimator();
  const Component<double> c = driving({30.0, 0.0}, 0.0, 10.0);
  BoxMemory m = remembered(e, c, {{0.0, 0.0}});
  const double before = m.probability[kBoxTruck];
  e.add_part(m, {7.0, 0.0}, {0.2, 0.0, 0.2});
  expect_probabilities(m);
  EXPECT_GT(m.probability[kBoxTruck], std::max(0.9, before));
}

TEST(BoxEstimator, ScanWithoutDetectionsKeepsClassesAndBox) {
  const BoxEstimator e = default_estimator();
  const Component<double> c = driving({30.0, 0.0}, 0.0, 10.0);
  BoxMemory m = remembered(e, c, {{0.0, 0.0}});
  const BoxMemory before = m;
  BoxObservation none = observed(c, 0.0);
  none.elapsed_s = 0.0;
  e.update(m, c, none, e.view(m, c.position_m, 10.0, {{0.0, 0.0}}));
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    EXPECT_NEAR(m.probability[k], before.probability[k], 1e-12);
    EXPECT_EQ(m.classes[k].length_m, before.classes[k].length_m);
    EXPECT_EQ(m.classes[k].point_m, before.classes[k].point_m);
  }
}

TEST(BoxEstimator, UnknownHeadingHasNoViewsAndABoxBehindTheReflections) {
  const BoxEstimator e = default_estimator();
  Component<double> c = driving({20.0, 0.0}, 0.0, 0.0);
  BoxMemory m = e.begin();
  for (int i = 0; i < 20; ++i) {
    const ClassViews views = e.view(m, c.position_m, 0.0, {{0.0, 0.0}});
    for (const ClassView& v : views) EXPECT_EQ(v.probability, 0.0);
    e.update(m, c, observed(c, 2.0), views);
  }
  EXPECT_FALSE(e.knows_heading(m));
  EXPECT_FALSE(m.has_point);
  expect_probabilities(m);
  const Box b = e.box(m, c, {0.0, 0.0});
  expect_finite(b);
  EXPECT_GT(b.centre_m.x(), 20.02) << "people are likeliest at rest, and they are small";
  EXPECT_NEAR(b.centre_m.y(), 0.0, 1e-6);
  EXPECT_LE(b.heading_variance_rad2, std::numbers::pi * std::numbers::pi / 3.0 + 1e-12);
  EXPECT_EQ(e.inside(m, kBoxCar, e.place(m, {0.0, 0.0}, {0.1, 0.0, 0.1}), {1.0, 1.0}), 0.0);
}

TEST(BoxEstimator, StopsWithTheHeadingOfItsDrive) {
  const BoxEstimator e = default_estimator();
  Component<double> c = driving({30.0, 0.0}, 0.6, 10.0);
  BoxMemory m = remembered(e, c, {{0.0, 0.0}});
  c.velocity_mps = {0.0, 0.0};
  for (int i = 0; i < 200; ++i) {
    e.update(m, c, observed(c, i % 3), e.view(m, c.position_m, 0.0, {{0.0, 0.0}}));
    ASSERT_TRUE(std::isfinite(m.heading_variance_rad2));
  }
  EXPECT_TRUE(e.knows_heading(m));
  EXPECT_NEAR(m.heading_rad, 0.6, 0.02);
  expect_probabilities(m);
  expect_finite(e.box(m, c, {0.0, 0.0}));
}

TEST(BoxEstimator, SensorWithinTheBoxGivesFiniteNumbers) {
  const BoxEstimator e = default_estimator();
  for (const double x : {0.0, 0.5, -1.0, 2.3}) {
    const Component<double> c = driving({x, 0.1}, 0.0, 10.0);
    const Viewpoint at{{0.0, 0.0}, 0.0, 1.0, 0.05};
    BoxMemory m = remembered(e, c, at, 10);
    expect_probabilities(m);
    const Box b = e.box(m, c, at.sensor_m);
    expect_finite(b);
    for (const ClassView& v : e.view(m, c.position_m, 10.0, at)) {
      EXPECT_TRUE(v.offset_m.allFinite() && v.offset_covariance_m2.allFinite());
      EXPECT_TRUE(std::isfinite(v.expected_detections + v.range_rate_variance_m2ps2 + v.wide_share));
    }
  }
}

TEST(BoxEstimator, ObjectOutOfViewThatIsDetectedAllTheSameGivesFiniteNumbers) {
  const BoxEstimator e = default_estimator();
  const Component<double> c = driving({200.0, 0.0}, 0.0, 10.0);
  BoxMemory m = remembered(e, c, {{0.0, 0.0}});
  const Viewpoint away{{0.0, 0.0}, std::numbers::pi, 0.5, 0.01};
  for (int i = 0; i < 20; ++i) e.update(m, c, observed(c, 3.0), e.view(m, c.position_m, 10.0, away));
  expect_probabilities(m);
  for (const ClassBox& b : m.classes) EXPECT_TRUE(std::isfinite(b.log_evidence + b.length_m + b.length_variance_m2));
  expect_finite(e.box(m, c, {0.0, 0.0}));
}

TEST(BoxEstimator, LengthStaysPositiveUnderWildDetections) {
  const BoxEstimator e = default_estimator();
  const Component<double> c = driving({40.0, 0.0}, 0.0, 10.0);
  BoxMemory m = remembered(e, c, {{0.0, 0.0}});
  support::Random random(5);
  for (int i = 0; i < 500; ++i) {
    BoxObservation o = observed(c, 1.0 + i % 4);
    o.mean_m = o.mean_m + Vector2<double>{10.0 * support::normal(random), 5.0 * support::normal(random)};
    e.update(m, c, o, e.view(m, c.position_m, 10.0, {{i % 2 == 0 ? 0.0 : 90.0, 0.0}}));
    for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
      ASSERT_GT(m.classes[k].length_m, 0.0);
      ASSERT_GT(m.classes[k].length_variance_m2, 0.0);
      ASSERT_LE(m.classes[k].length_variance_m2,
                support::class_table()[k].size.length_std_m * support::class_table()[k].size.length_std_m + 1e-9);
    }
  }
  expect_probabilities(m);
}

// A course that was wrong by half a turn at first: the tracked point is chosen anew in the axes of the new heading.
TEST(BoxEstimator, ReversedCourseChoosesTheTrackedPointAnew) {
  const BoxEstimator e = default_estimator();
  const Viewpoint from{{0.0, 0.0}};
  BoxMemory m = remembered(e, driving({30.0, 0.0}, std::numbers::pi, 10.0), from);
  const Component<double> c = driving({30.0, 0.0}, 0.0, 10.0);
  for (int i = 0; i < 3; ++i) e.update(m, c, observed(c, 2.0), e.view(m, c.position_m, 10.0, from));
  EXPECT_NEAR(m.heading_rad, 0.0, 1e-9);
  EXPECT_TRUE(m.has_point);
  EXPECT_LT(m.classes[kBoxCar].point_m.x(), 0.0) << "seen from behind";
  EXPECT_GT(e.box(m, c, {0.0, 0.0}).centre_m.x(), 30.2);
}

}  // namespace
}  // namespace boresight::tracking
