// Headings of one object by its outline and by its range rates.
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/classical/heading/doppler_heading.hpp"
#include "services/tracker/core/classical/heading/l_shape.hpp"

namespace boresight::tracking::classical {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

/// A car's near end and near side, as a sensor at the origin sees them; `noise_m` in all directions.
std::vector<HistoryPoint> outline(const Eigen::Vector2d& centre_m, double heading_rad, double noise_m, int points,
                                  std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> along(-2.3, 2.3), across(-0.9, 0.9);
  std::normal_distribution<double> noise(0.0, noise_m);
  Eigen::Matrix2d to_local;
  to_local << std::cos(heading_rad), -std::sin(heading_rad), std::sin(heading_rad), std::cos(heading_rad);
  const Eigen::Vector2d sensor = -(to_local.transpose() * centre_m);
  std::vector<HistoryPoint> list;
  for (int k = 0; k < points; ++k) {
    const Eigen::Vector2d box = k % 2 == 0 ? Eigen::Vector2d(std::copysign(2.3, sensor.x()), across(random))
                                           : Eigen::Vector2d(along(random), std::copysign(0.9, sensor.y()));
    HistoryPoint p;
    p.place_m = centre_m + to_local * box + Eigen::Vector2d(noise(random), noise(random));
    p.variance_m2 = noise_m * noise_m;
    p.sight = p.place_m.normalized();
    list.push_back(p);
  }
  return list;
}

/// Range rates of a body that moves straight, seen from the origin and, every other one, from a second radar.
std::vector<HistoryPoint> rates(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& velocity_mps, double std_mps,
                                int points, std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  std::normal_distribution<double> noise(0.0, std_mps);
  std::vector<HistoryPoint> list;
  for (int k = 0; k < points; ++k) {
    HistoryPoint p;
    p.place_m = centre_m + Eigen::Vector2d(place(random), place(random));
    p.sight = (p.place_m - Eigen::Vector2d(k % 2 == 0 ? 0.0 : 3.0, 0.0)).normalized();
    p.range_rate_mps = p.sight.dot(velocity_mps) + noise(random);
    p.range_rate_variance = std_mps * std_mps;
    list.push_back(p);
  }
  return list;
}

double error(const Heading& heading, double truth_rad) {
  return geometry::wrap_angle(heading.rad - truth_rad);
}

TEST(LShape, FindsTheAxesOfACorner) {
  for (const auto criterion : {ShapeCriterion::kCloseness, ShapeCriterion::kVariance}) {
    ShapeParameters parameters;
    parameters.criterion = criterion;
    for (const double heading_deg : {-60.0, -17.0, 0.0, 25.0, 71.0, 140.0}) {
      const double heading = heading_deg * kDegree_rad;
      const auto points = outline({12.0, 6.0}, heading, 0.02, 24, 3);
      const auto found = l_shape_heading(points, heading + 0.3, parameters);
      ASSERT_TRUE(found);
      EXPECT_LT(std::abs(error(*found, heading)), 5.0 * kDegree_rad) << heading_deg;
    }
  }
}

TEST(LShape, AreaFindsAnAxisOrTheLineBetweenTheEndsOfTheCorner) {
  // The smallest rectangle about a triangle has the same area along each of its sides.
  ShapeParameters parameters;
  parameters.criterion = ShapeCriterion::kArea;
  const auto found = l_shape_heading(outline({12.0, 6.0}, 0.0, 0.02, 24, 3), 0.0, parameters);
  ASSERT_TRUE(found);
  const double off = std::abs(error(*found, 0.0)), diagonal = std::atan2(1.8, 4.6);
  EXPECT_LT(std::min(off, std::abs(off - diagonal)), 5.0 * kDegree_rad);
}

TEST(LShape, TurnsWithTheScene) {
  const auto points = outline({12.0, 6.0}, 0.4, 0.1, 24, 4);
  const auto before = l_shape_heading(points, 0.5, {});
  auto turned = points;
  const Eigen::Rotation2Dd turn(1.1);
  for (HistoryPoint& p : turned) {
    p.place_m = turn * p.place_m;
    p.sight = turn * p.sight;
  }
  const auto after = l_shape_heading(turned, 1.6, {});
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(error(*after, before->rad + 1.1), 0.0, 1e-9);
  EXPECT_NEAR(after->variance_rad2, before->variance_rad2, 1e-9);
}

TEST(LShape, OneEndLeavesTheAxesUnsure) {
  auto narrow = outline({12.0, 0.0}, 0.0, 0.2, 24, 5);
  std::erase_if(narrow, [](const HistoryPoint& p) { return p.place_m.x() > 10.5; });
  const auto corner = l_shape_heading(outline({12.0, 6.0}, 0.0, 0.2, 24, 5), 0.0, {});
  const auto end = l_shape_heading(narrow, 0.0, {});
  ASSERT_TRUE(corner && end);
  EXPECT_GT(end->variance_rad2, 2.0 * corner->variance_rad2);
}

TEST(LShape, TooFewDetectionsHaveNoOutline) {
  EXPECT_FALSE(l_shape_heading(outline({12.0, 6.0}, 0.0, 0.1, 5, 6), 0.0, {}));
  EXPECT_FALSE(l_shape_heading({}, 0.0, {}));
}

TEST(LShape, EqualPlacesTellNothing) {
  std::vector<HistoryPoint> same(8, outline({12.0, 6.0}, 0.0, 0.1, 1, 7).front());
  const auto found = l_shape_heading(same, 0.3, {});
  ASSERT_TRUE(found);
  EXPECT_GT(found->variance_rad2, std::pow(20.0 * kDegree_rad, 2));  // nearly uniform over a quarter turn
}

TEST(DopplerHeading, BothEstimatorsFindTheDirectionWithHonestDeviations) {
  std::mt19937_64 random(8);
  double line_nees = 0.0, interval_nees = 0.0;
  constexpr int kRuns = 300;
  const Eigen::Vector2d velocity(9.0, 4.0);
  const double truth = std::atan2(velocity.y(), velocity.x());
  for (int run = 0; run < kRuns; ++run) {
    const auto points = rates({8.0, 5.0}, velocity, 0.05, 12, random);
    const auto line = doppler_line(points, {}, 0.0);
    const auto interval = interval_search(points, truth + 0.2, {}, 0.0);
    ASSERT_TRUE(line && interval);
    line_nees += std::pow(error(line->heading, truth), 2) / line->heading.variance_rad2 / kRuns;
    interval_nees += std::pow(error(interval->heading, truth), 2) / interval->heading.variance_rad2 / kRuns;
    EXPECT_NEAR(line->speed_mps, velocity.norm(), 1.0);
  }
  // The scale that the residuals tell is no less than 1, so that the deviations are a little large.
  EXPECT_GT(line_nees, 0.5);
  EXPECT_LT(line_nees, 1.5);
  EXPECT_GT(interval_nees, 0.3);
  EXPECT_LT(interval_nees, 1.5);
}

TEST(DopplerHeading, WithoutNoiseTheLineIsExact) {
  std::mt19937_64 random(9);
  auto points = rates({8.0, 5.0}, {-7.0, 3.0}, 1e-9, 6, random);
  const auto line = doppler_line(points, {}, 0.0);
  ASSERT_TRUE(line);
  EXPECT_NEAR(error(line->heading, std::atan2(3.0, -7.0)), 0.0, 1e-6);
}

TEST(DopplerHeading, RotatingPartsMoveTheLineButNotTheIntervalSearch) {
  std::mt19937_64 random(10);
  const Eigen::Vector2d velocity(9.0, 4.0);
  const double truth = std::atan2(velocity.y(), velocity.x());
  auto points = rates({8.0, 5.0}, velocity, 0.05, 14, random);
  points[3].range_rate_mps += 6.0;
  points[8].range_rate_mps -= 4.0;
  const auto line = doppler_line(points, {}, 0.0);
  const auto interval = interval_search(points, truth + 0.1, {}, 0.0);
  ASSERT_TRUE(line && interval);
  EXPECT_GT(std::abs(error(line->heading, truth)), 2.0 * std::abs(error(interval->heading, truth)));
  EXPECT_LT(std::abs(error(interval->heading, truth)), 6.0 * kDegree_rad);
}

TEST(DopplerHeading, OneLineOfSightTellsNoDirection) {
  std::mt19937_64 random(11);
  auto points = rates({8.0, 5.0}, {9.0, 4.0}, 0.05, 8, random);
  for (HistoryPoint& p : points) p.sight = {1.0, 0.0};
  EXPECT_FALSE(doppler_line(points, {}, 0.0));
  const auto interval = interval_search(points, 0.4, {}, 0.0);
  EXPECT_TRUE(!interval || interval->heading.variance_rad2 > std::pow(15.0 * kDegree_rad, 2));
}

TEST(DopplerHeading, UnknownTurnRateMakesTheDirectionLessSure) {
  std::mt19937_64 random(12);
  const auto points = rates({8.0, 5.0}, {9.0, 4.0}, 0.05, 12, random);
  const auto straight = doppler_line(points, {}, 0.0), turning = doppler_line(points, {}, 2.0);
  ASSERT_TRUE(straight && turning);
  EXPECT_NEAR(turning->heading.variance_rad2 - straight->heading.variance_rad2, std::pow(2.0 / straight->speed_mps, 2),
              1e-9);
}

TEST(History, KeepsTheLatestAndForgetsTheOld) {
  History history;
  HistoryPoint p;
  for (std::size_t k = 0; k < History::kCapacity + 5; ++k) {
    p.range_rate_mps = static_cast<double>(k);
    history.add(p);
  }
  ASSERT_EQ(history.points().size(), History::kCapacity);
  for (const HistoryPoint& kept : history.points()) EXPECT_GE(kept.range_rate_mps, 5.0);
  history.move({1.0, 0.0}, 0.3, 0.5);
  EXPECT_EQ(history.points().size(), History::kCapacity);
  EXPECT_DOUBLE_EQ(history.points()[0].place_m.x(), 1.0);
  history.add(p);
  history.move({1.0, 0.0}, 0.3, 0.5);
  ASSERT_EQ(history.points().size(), 1u);
  EXPECT_DOUBLE_EQ(history.points()[0].age_s, 0.3);
}

}  // namespace
}  // namespace boresight::tracking::classical
