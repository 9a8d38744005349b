#include "services/tracker/core/clusters/cluster_features.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::tracking::cluster_features_test {
namespace {

constexpr double kTight = 1e-9;

/// Points in a rectangle of 4 × 1 m, its length at an angle, seen from the origin of the axes.
std::vector<ClusterPoint> rectangle(double angle_rad, const Vector2<double>& centre_m, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(-2.0, 2.0), across(-0.5, 0.5), level(-10.0, 20.0);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  std::vector<ClusterPoint> points;
  for (int i = 0; i < 40; ++i) {
    const double x = along(random), y = across(random);
    ClusterPoint& p = points.emplace_back();
    p.position_m = {centre_m.x + c * x - s * y, centre_m.y + s * x + c * y};
    p.range_m = std::sqrt(squared_norm(p.position_m));
    p.sight = (1.0 / p.range_m) * p.position_m;
    p.height_m = 1.0 + 0.02 * i;
    p.strength_db = level(random);
    p.snr_db = level(random);
    p.range_rate_mps = 0.1 * i;
    p.weight = i % 2 == 0 ? 1.0 : 0.5;
  }
  return points;
}

/// Plain sums, as in a textbook.
ClusterStatistics by_definition(const std::vector<ClusterPoint>& points, double ClusterPoint::*value) {
  ClusterStatistics s{0.0, 0.0, 0.0, points[0].*value, points[0].*value};
  for (const ClusterPoint& p : points) {
    s.number += p.weight;
    s.mean += p.weight * p.*value;
    s.least = std::min(s.least, p.*value);
    s.largest = std::max(s.largest, p.*value);
  }
  s.mean /= s.number;
  for (const ClusterPoint& p : points) s.std += p.weight * (p.*value - s.mean) * (p.*value - s.mean);
  s.std = std::sqrt(s.std / s.number);
  return s;
}

void expect_same(const ClusterStatistics& a, const ClusterStatistics& b) {
  EXPECT_NEAR(a.number, b.number, kTight);
  EXPECT_NEAR(a.mean, b.mean, kTight);
  EXPECT_NEAR(a.std, b.std, kTight);
  EXPECT_NEAR(a.least, b.least, kTight);
  EXPECT_NEAR(a.largest, b.largest, kTight);
}

TEST(ClusterFeatures, StatisticsAreThoseOfTheirDefinition) {
  const auto points = rectangle(0.3, {20.0, 5.0});
  const ClusterFeatures f = cluster_features(points);
  EXPECT_NEAR(f.points, 30.0, kTight);
  expect_same(f.strength_db, by_definition(points, &ClusterPoint::strength_db));
  expect_same(f.snr_db, by_definition(points, &ClusterPoint::snr_db));
  expect_same(f.range_rate_mps, by_definition(points, &ClusterPoint::range_rate_mps));
  expect_same(f.range_m, by_definition(points, &ClusterPoint::range_m));
  expect_same(f.elevation_m, by_definition(points, &ClusterPoint::height_m));
  EXPECT_NEAR(f.height_m, 0.78, kTight);
}

TEST(ClusterFeatures, BoxAlongTheHeadingHoldsAllPointsAndTouchesThem) {
  constexpr double kHeading_rad = 0.7;
  const auto points = rectangle(0.3, {-20.0, 5.0});
  const ClusterFeatures f = cluster_features(points, kHeading_rad);
  double least_along = 1e9, most_along = -1e9, least_across = 1e9, most_across = -1e9;
  for (const ClusterPoint& p : points) {
    const double along = dot(p.position_m, {std::cos(kHeading_rad), std::sin(kHeading_rad)});
    const double across = dot(p.position_m, {-std::sin(kHeading_rad), std::cos(kHeading_rad)});
    least_along = std::min(least_along, along);
    most_along = std::max(most_along, along);
    least_across = std::min(least_across, across);
    most_across = std::max(most_across, across);
  }
  EXPECT_NEAR(f.length_m, most_along - least_along, kTight);
  EXPECT_NEAR(f.width_m, most_across - least_across, kTight);
  EXPECT_NEAR(f.area_m2, f.length_m * f.width_m, kTight);
  EXPECT_NEAR(f.volume_m3, f.area_m2 * f.height_m, kTight);
}

TEST(ClusterFeatures, PrincipalAxisIsThatOfTheRectangle) {
  constexpr double kTolerance_rad = 0.1;
  for (const double angle_rad : {-1.4, -0.5, 0.0, 0.3, 1.2}) {
    const ClusterFeatures f = cluster_features(rectangle(angle_rad, {20.0, 5.0}));
    EXPECT_NEAR(std::abs(std::cos(f.axis_rad - angle_rad)), 1.0, 1.0 - std::cos(kTolerance_rad)) << angle_rad;
    EXPECT_GT(f.length_m, 2.0 * f.width_m);
  }
}

TEST(ClusterFeatures, AreTheSameInTurnedAndShiftedAxes) {
  const auto points = rectangle(0.3, {20.0, 5.0});
  const ClusterFeatures before = cluster_features(points), before_along = cluster_features(points, 0.4);
  for (const double turn_rad : {0.5, 2.0, -2.5}) {
    const double c = std::cos(turn_rad), s = std::sin(turn_rad);
    const auto turned = [&](const Vector2<double>& v) { return Vector2<double>{c * v.x - s * v.y, s * v.x + c * v.y}; };
    auto moved = points;
    for (ClusterPoint& p : moved) {
      p.position_m = turned(p.position_m) + Vector2<double>{1e4, -3e3};
      p.sight = turned(p.sight);
    }
    const ClusterFeatures after = cluster_features(moved), after_along = cluster_features(moved, 0.4 + turn_rad);
    EXPECT_NEAR(after.length_m, before.length_m, 1e-8);
    EXPECT_NEAR(after.width_m, before.width_m, 1e-8);
    EXPECT_NEAR(after.along_std_m, before.along_std_m, 1e-8);
    EXPECT_NEAR(after.across_std_m, before.across_std_m, 1e-8);
    EXPECT_NEAR(determinant(after.covariance_m2), determinant(before.covariance_m2), 1e-8);
    EXPECT_NEAR(after_along.length_m, before_along.length_m, 1e-8);
    EXPECT_NEAR(after_along.width_m, before_along.width_m, 1e-8);
  }
}

TEST(ClusterFeatures, OnePointHasNoSizeAndIsItsOwnCentre) {
  ClusterPoint p;
  p.position_m = {3.0, -4.0};
  p.sight = {0.6, -0.8};
  const ClusterFeatures f = cluster_features(std::vector{p});
  EXPECT_EQ(f.centre_m.x, 3.0);
  EXPECT_EQ(f.centre_m.y, -4.0);
  EXPECT_EQ(f.length_m, 0.0);
  EXPECT_EQ(f.width_m, 0.0);
  EXPECT_EQ(f.range_rate_mps.std, 0.0);
  EXPECT_NEAR(f.axis_rad, std::atan2(-0.8, 0.6), kTight);
  EXPECT_TRUE(std::isnan(f.height_m));
  EXPECT_TRUE(std::isnan(f.volume_m3));
  EXPECT_TRUE(std::isnan(f.strength_db.mean));
}

TEST(ClusterFeatures, EqualPointsHaveNoSize) {
  ClusterPoint p;
  p.position_m = {1e3 / 3.0, 1e3 / 7.0};
  p.sight = {1.0, 0.0};
  p.height_m = 0.1;
  const ClusterFeatures f = cluster_features(std::vector<ClusterPoint>(7, p));
  EXPECT_EQ(f.points, 7.0);
  EXPECT_EQ(f.length_m, 0.0);
  EXPECT_EQ(f.along_std_m, 0.0);
  EXPECT_EQ(f.height_m, 0.0);
  EXPECT_EQ(f.volume_m3, 0.0);
}

TEST(ClusterFeatures, PointsWithoutPlaceOrWeightAreLeftOut) {
  auto points = rectangle(0.3, {20.0, 5.0});
  const ClusterFeatures before = cluster_features(points);
  ClusterPoint p = points.front();
  p.position_m = {NAN, 1000.0};
  points.insert(points.begin(), p);
  p = points.back();
  p.position_m = {1000.0, 1000.0};
  p.weight = 0.0;
  points.push_back(p);
  const ClusterFeatures after = cluster_features(points);
  EXPECT_EQ(after.points, before.points);
  EXPECT_EQ(after.length_m, before.length_m);
  EXPECT_EQ(after.strength_db.mean, before.strength_db.mean);
}

TEST(ClusterFeatures, QuantityThatSomePointsDoNotStateIsThatOfTheOthers) {
  auto points = rectangle(0.3, {20.0, 5.0});
  for (std::size_t i = 0; i < points.size(); i += 2) points[i].height_m = points[i].snr_db = NAN;
  const ClusterFeatures f = cluster_features(points);
  EXPECT_NEAR(f.elevation_m.number, 10.0, kTight);
  EXPECT_NEAR(f.elevation_m.least, 1.02, kTight);
  EXPECT_TRUE(std::isfinite(f.snr_db.std));
}

TEST(ClusterFeatures, NoPointsAreNoCluster) {
  const ClusterFeatures f = cluster_features({});
  EXPECT_EQ(f.points, 0.0);
  EXPECT_TRUE(std::isnan(f.length_m));
  EXPECT_TRUE(std::isnan(f.centre_m.x));
}

}  // namespace
}  // namespace boresight::tracking::cluster_features_test
