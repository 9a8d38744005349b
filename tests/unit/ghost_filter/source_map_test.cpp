// No object or mover that is within reach of a place may be missing there.
#include "services/ghost_filter/core/classify/source_map.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

struct Box {
  Eigen::Vector2d centre, half;
  [[nodiscard]] bool is_within(double reach, const Eigen::Vector2d& place) const {
    return ((place - centre).cwiseAbs().array() <= half.array() + reach).all();
  }
};

bool holds(SourceMap::Bits bits, std::uint32_t index, std::uint32_t count) {
  bool found = false;
  SourceMap::visit_objects(bits, count, [&](std::uint32_t i) { found = found || i == index; });
  return found;
}

TEST(SourceMap, MissesNoObjectWithinReachAlsoBeyondItsEdges) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> near(-100.0, 100.0), far(-400.0, 400.0), half(0.0, 12.0), reach(0.0, 25.0);
  std::size_t within = 0, told = 0, asked = 0;
  SourceMap map;
  for (int run = 0; run < 20; ++run) {
    const std::uint32_t count = run % 2 == 0 ? 129 : 20;
    auto& place = run % 4 < 2 ? near : far;
    map.clear();
    std::vector<Box> boxes;
    for (std::uint32_t i = 0; i < count; ++i) {
      boxes.push_back({{place(random), place(random)}, {half(random), half(random)}});
      map.enter_object(i, boxes[i].centre, boxes[i].half);
    }
    for (int query = 0; query < 1000; ++query) {
      const Eigen::Vector2d at(place(random), place(random));
      const double reach_m = reach(random);
      const SourceMap::Bits bits = map.about(at, reach_m);
      constexpr double kMostReachOfMovers_m = 20.0;  // beyond it there may always be one
      EXPECT_TRUE(!SourceMap::has_movers(bits) || reach_m > kMostReachOfMovers_m) << "none was entered";
      for (std::uint32_t i = 0; i < count; ++i) {
        const bool is_within = boxes[i].is_within(reach_m, at);
        within += is_within ? 1 : 0;
        told += holds(bits, i, count) ? 1 : 0;
        ++asked;
        EXPECT_TRUE(!is_within || holds(bits, i, count)) << "object " << i << " of " << count;
        EXPECT_EQ(holds(map.objects_about(at, reach_m), i, count), holds(bits, i, count));
      }
    }
  }
  EXPECT_GT(within, 5000U);
  EXPECT_LT(told, asked / 2) << "or it saves nothing";
}

TEST(SourceMap, WhatIsKnownBadlyAlongOneAxisIsToldByTheOtherOne) {
  constexpr double kNoReach_m = 1e3;
  SourceMap map;
  for (std::uint32_t i = 0; i < 10; ++i) map.enter_object(i, {20.0 * i - 90.0, 15.0}, {2.0, 1.0});
  const auto found = [&](const Eigen::Vector2d& place, const Eigen::Vector2d& reach) {
    std::size_t number = 0;
    SourceMap::visit_objects(map.about(place, reach), 10, [&](std::uint32_t) { ++number; });
    return number;
  };
  EXPECT_EQ(found({-90.0, 100.0}, {1.0, kNoReach_m}), 1U);
  EXPECT_EQ(found({-90.0, 15.0}, {kNoReach_m, 1.0}), 10U);
  EXPECT_EQ(found({-90.0, 100.0}, {kNoReach_m, 1.0}), 0U);
  EXPECT_EQ(map.about({-90.0, 100.0}, {kNoReach_m, kNoReach_m}), SourceMap::kAll);
}

TEST(SourceMap, MoversAreFoundWithinReachAndForgotten) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-300.0, 300.0), size(0.0, 9.0);
  SourceMap map;
  for (int run = 0; run < 200; ++run) {
    map.clear();
    const Box mover{{place(random), place(random)}, Eigen::Vector2d::Constant(size(random))};
    map.enter_mover(mover.centre, mover.half.x());
    for (int query = 0; query < 100; ++query) {
      const Eigen::Vector2d at = mover.centre + 0.1 * Eigen::Vector2d(place(random), place(random));
      const double reach_m = size(random);
      EXPECT_TRUE(!mover.is_within(reach_m, at) || SourceMap::has_movers(map.about(at, reach_m)));
    }
    EXPECT_FALSE(SourceMap::has_movers(map.about(-mover.centre.array() + 150.0, 1.0)) &&
                 (2.0 * mover.centre.array() - 150.0).abs().maxCoeff() > 50.0)
        << "far away";
    map.clear();
    EXPECT_EQ(map.about(mover.centre, 20.0), 0U);
  }
}

TEST(SourceMap, WhatIsNotANumberMayBeAnywhere) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  SourceMap map;
  EXPECT_EQ(map.about({0.0, 0.0}, 5.0), 0U);
  for (const double bad : {kNan, kInf, -kInf}) {
    EXPECT_EQ(map.about({bad, 0.0}, 5.0), SourceMap::kAll);
    EXPECT_EQ(map.about({0.0, bad}, 5.0), SourceMap::kAll);
  }
  EXPECT_EQ(map.about({0.0, 0.0}, kNan), SourceMap::kAll);
  EXPECT_EQ(map.about({0.0, 0.0}, kInf), SourceMap::kAll);
  map.enter_object(3, {kNan, 0.0}, {1.0, 1.0});
  map.enter_object(4, {0.0, 0.0}, {1.0, kInf});
  const SourceMap::Bits far = map.about({200.0, -200.0}, 1.0);
  EXPECT_TRUE(holds(far, 3, 10) && holds(far, 4, 10) && !holds(far, 5, 10));
}

}  // namespace
}  // namespace boresight::ghosts
