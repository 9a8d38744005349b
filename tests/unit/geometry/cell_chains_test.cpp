#include "services/common/geometry/cell_chains.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::geometry {
namespace {

TEST(CellChains, FindAllNearNumbersAndOthersOnlyAPeriodAway) {
  constexpr double kCell_m = 4.0, kPeriod_m = kCell_m * CellChains::kSide;
  CellChains chains(300, kCell_m);
  std::mt19937 random(1);
  for (int round = 0; round < 40; ++round) {
    const double area_m = 20.0 + 20.0 * round;  // also much wider than a period
    std::uniform_real_distribution<double> place(-area_m, area_m), beside(-4.0, 4.0);
    std::vector<Eigen::Vector2d> points;
    chains.clear();
    for (std::uint32_t i = 0; i < 300; ++i) {
      points.emplace_back(place(random), place(random));
      chains.link(points.back(), i);
    }
    for (int k = 0; k < 200; ++k) {
      const Eigen::Vector2d p = points[random() % 300] + Eigen::Vector2d(beside(random), beside(random));
      std::set<std::uint32_t> found;
      chains.near(p, [&](std::uint32_t i) {
        EXPECT_TRUE(found.insert(i).second) << "once";
        for (const double apart : {points[i].x() - p.x(), points[i].y() - p.y()}) {
          EXPECT_LT(std::abs(std::remainder(apart, kPeriod_m)), 2.0 * kCell_m) << "round " << round;
        }
      });
      for (std::uint32_t i = 0; i < 300; ++i) {
        if ((points[i] - p).norm() < kCell_m) {
          ASSERT_TRUE(found.contains(i)) << "round " << round;
        }
      }
    }
  }
}

TEST(CellChains, AcceptNumbersUpToTheirCapacityAndForget) {
  CellChains chains(3, 4.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::size_t found = 0;
  const auto count = [&found](std::uint32_t) { ++found; };
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (std::uint32_t i = 0; i < 5; ++i) chains.link({1.0, -2.0}, i);
    chains.near({1.0, -2.0}, count);
    EXPECT_EQ(found, 3U);
    chains.clear();
    chains.near({1.0, -2.0}, count);
    EXPECT_EQ(found, 3U);
    chains.link({nan, 1e300}, 0);
    chains.link({-1e300, nan}, 1);
    chains.near({nan, nan}, count);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::geometry
