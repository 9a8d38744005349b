// Lines among points whose truth is known.
#include "services/ghost_filter/core/reflectors/line_search.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::ghosts {
namespace {

using Points = std::vector<Eigen::Vector2d>;

void add_line(Points& points, const Eigen::Vector2d& from, const Eigen::Vector2d& to, int number, double noise_m,
              std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, noise_m);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const Eigen::Vector2d along = (to - from).normalized(), across(-along.y(), along.x());
  for (int k = 0; k < number; ++k) points.push_back(from + share(random) * (to - from) + noise(random) * across);
}

void add_bush(Points& points, const Eigen::Vector2d& middle, int number, std::mt19937& random) {
  std::normal_distribution<double> leaf(0.0, 1.5);
  for (int k = 0; k < number; ++k) points.push_back(middle + Eigen::Vector2d(leaf(random), leaf(random)));
}

double angle_between(const Segment& s, const Eigen::Vector2d& direction) {
  const Eigen::Vector2d along = (s.end_m - s.start_m).normalized();
  return std::asin(std::min(1.0, std::abs(along.x() * direction.y() - along.y() * direction.x())));
}

TEST(LineSearch, FindsARailWithBushesBehindIt) {
  int found = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    Points points;
    add_line(points, {0.0, 5.0}, {20.0, 5.0}, 60, 0.08, random);
    add_bush(points, {6.0, 8.5}, 40, random);
    add_bush(points, {15.0, 9.0}, 40, random);
    LineSearch search{LineConfig{}, 1024};
    const std::span<const Segment> segments = search.find(points);
    if (segments.empty()) continue;
    const Segment& first = segments.front();
    found +=
        angle_between(first, {1.0, 0.0}) < 0.03 && std::abs(first.start_m.y() - 5.0) < 0.2 && first.length_m() > 15.0
            ? 1
            : 0;
  }
  EXPECT_GE(found, 38);
}

TEST(LineSearch, FindsEachOfTwoCrossingWalls) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937 random(seed);
    Points points;
    add_line(points, {0.0, 0.0}, {20.0, 0.0}, 80, 0.05, random);
    add_line(points, {10.0, -10.0}, {10.0, 10.0}, 80, 0.05, random);
    LineSearch search{LineConfig{}, 1024};
    const std::span<const Segment> segments = search.find(points);
    for (const Eigen::Vector2d& direction : {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0)}) {
      EXPECT_TRUE(std::any_of(segments.begin(), segments.end(), [&](const Segment& s) {
        return angle_between(s, direction) < 0.03 && s.length_m() > 8.0;
      })) << seed;
    }
  }
}

TEST(LineSearch, ALargeGapEndsASegment) {
  std::mt19937 random(3);
  Points points;
  add_line(points, {0.0, 0.0}, {8.0, 0.0}, 60, 0.05, random);
  add_line(points, {14.0, 0.0}, {26.0, 0.0}, 60, 0.05, random);
  LineSearch search{LineConfig{}, 1024};
  const std::span<const Segment> segments = search.find(points);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_NEAR(segments[0].length_m(), 12.0, 0.8) << "the longer one first";
  EXPECT_NEAR(segments[1].length_m(), 8.0, 0.8);
}

TEST(LineSearch, FindsLittleInBushes) {
  std::size_t segments = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    Points points;
    add_bush(points, {0.0, 0.0}, 60, random);
    add_bush(points, {9.0, 3.0}, 60, random);
    LineSearch search{LineConfig{}, 1024};
    segments += search.find(points).size();
  }
  EXPECT_LT(segments, 24U) << "in eighty bushes";
}

TEST(LineSearch, ATurnedSceneGivesTurnedSegments) {
  // On the grid's cells, which turn into cells by quarter turns.
  std::mt19937 random(4);
  Points points;
  add_line(points, {0.13, 5.07}, {20.0, 8.0}, 60, 0.05, random);
  add_bush(points, {6.0, 12.0}, 40, random);
  LineSearch search{LineConfig{}, 1024}, turned_search{LineConfig{}, 1024};
  const std::span<const Segment> segments = search.find(points);
  const Eigen::Matrix2d turn = (Eigen::Matrix2d() << 0.0, -1.0, 1.0, 0.0).finished();
  Points turned;
  for (const Eigen::Vector2d& p : points) turned.push_back(turn * p);
  const std::span<const Segment> found = turned_search.find(turned);
  ASSERT_EQ(found.size(), segments.size());
  ASSERT_FALSE(found.empty());
  const Eigen::Vector2d start = turn * segments[0].start_m, end = turn * segments[0].end_m;
  const double same = (found[0].start_m - start).norm() + (found[0].end_m - end).norm();
  const double swapped = (found[0].start_m - end).norm() + (found[0].end_m - start).norm();
  EXPECT_LT(std::min(same, swapped), 1e-6);
}

TEST(LineSearch, FewPointsOrOnePlaceGiveNothing) {
  LineSearch search{LineConfig{}, 1024};
  EXPECT_TRUE(search.find({}).empty());
  EXPECT_TRUE(search.find(Points(5, {1.0, 2.0})).empty());
  EXPECT_TRUE(search.find(Points(500, {1.0, 2.0})).empty());
  std::mt19937 random(6);
  Points small;
  add_line(small, {0.0, 0.0}, {3.0, 0.0}, 100, 0.05, random);
  EXPECT_TRUE(search.find(small).empty()) << "shorter than the least length";
}

TEST(LineSearch, StopsAtItsCapacityWithoutAllocation) {
  LineConfig config;
  LineSearch search(config, 200);
  std::mt19937 random(7);
  Points points;
  for (int line = 0; line < 20; ++line) add_line(points, {0.0, 2.0 * line}, {20.0, 2.0 * line}, 60, 0.05, random);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    EXPECT_LE(search.find(points).size(), config.most_lines);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::ghosts
