// Sets of directions: what is in one of them is never missed, and most of what is not is left out.
#include "services/ghost_filter/core/classify/sectors.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

SectorSet sector_with(const Eigen::Vector2d& direction) {
  return SectorSet{1} << sector_of<64>(direction);
}

TEST(Sectors, AllThatIsWithinReachOfAPlaceIsInItsSet) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-60.0, 60.0), reach(0.0, 20.0), share(0.0, 1.0), angle(-3.2, 3.2);
  std::size_t others = 0, left_out = 0;
  for (int run = 0; run < 20000; ++run) {
    const Eigen::Vector2d place(coordinate(random), coordinate(random));
    const double reach_m = reach(random);
    const SectorSet set = sectors_about(place, reach_m);
    const double to = angle(random);
    const Eigen::Vector2d within =
        place + reach_m * std::sqrt(share(random)) * Eigen::Vector2d(std::cos(to), std::sin(to));
    EXPECT_NE(set & sector_with(within), 0U) << place.transpose() << " ± " << reach_m;
    // Any direction far from all of it.
    const Eigen::Vector2d other(coordinate(random), coordinate(random));
    const double off = std::acos(other.normalized().dot(place.normalized()));
    if (off < std::asin(std::min(1.0, reach_m / place.norm())) + 0.3 || reach_m > 0.5 * place.norm()) continue;
    ++others;
    left_out += (set & sector_with(other)) == 0 ? 1 : 0;
  }
  EXPECT_GT(others, 5000U);
  EXPECT_EQ(left_out, others);
}

TEST(Sectors, WhatIsAllAroundOrNowhereIsInAll) {
  EXPECT_EQ(sectors_about({3.0, 1.0}, 5.0), kAllSectors);
  EXPECT_EQ(sectors_about({0.0, 0.0}, 0.0), kAllSectors);
  EXPECT_EQ(sectors_about({std::numeric_limits<double>::quiet_NaN(), 1.0}, 1.0), kAllSectors);
  EXPECT_EQ(sectors_about({30.0, 1.0}, std::numeric_limits<double>::infinity()), kAllSectors);
}

}  // namespace
}  // namespace boresight::ghosts
