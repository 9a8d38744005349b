// No mirror that a line of sight crosses may be missing in its sector.
#include "services/ghost_filter/core/classify/mirror_fan.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

std::vector<Mirror> mirrors(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<double> place(-60.0, 60.0), angle(-3.14, 3.14), half(1.0, 60.0), bend(-0.05, 0.05);
  std::vector<Mirror> made(count);
  for (std::size_t i = 0; i < count; ++i) {
    Mirror& m = made[i];
    const double heading = angle(random);
    m.curve = {{place(random), place(random)},
               {std::cos(heading), std::sin(heading)},
               i % 3 == 0   ? bend(random)
               : i % 3 == 1 ? 0.02 * bend(random)
                            : 0.0};
    m.end_m = half(random);
    if (std::abs(m.curve.curvature_per_m) * m.end_m > 1.2) m.end_m = 1.2 / std::abs(m.curve.curvature_per_m);
    m.begin_m = -m.end_m;
    m.covariance.setZero();
    m.existence = 1.0;
  }
  return made;
}

TEST(MirrorFan, MissesNoCrossingThatTheWholeListHas) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-3.15, 3.15), place(-5.0, 5.0);
  MirrorFan fan;
  std::size_t crossings = 0, visited = 0, all = 0;
  for (int run = 0; run < 60; ++run) {
    const std::vector<Mirror> list = mirrors(random, 50);
    const Eigen::Vector2d sensor(place(random), place(random));
    fan.build(list, sensor);
    for (int ray = 0; ray < 200; ++ray) {
      const double azimuth = angle(random);
      const Eigen::Vector2d direction(std::cos(azimuth), std::sin(azimuth));
      std::vector<const Mirror*> seen;
      fan.visit(direction, [&](const Mirror& m) { seen.push_back(&m); });
      EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end())) << "the order is the list's";
      visited += seen.size();
      all += list.size();
      for (const Mirror& m : list) {
        if (!turn_at(m, sensor, direction, 200.0, 0.01)) continue;
        ++crossings;
        EXPECT_TRUE(std::count(seen.begin(), seen.end(), &m) == 1) << "run " << run << " azimuth " << azimuth;
      }
    }
  }
  EXPECT_GT(crossings, 10000U);
  EXPECT_LT(visited, all / 2) << "or it saves nothing";
}

TEST(MirrorFan, HoldsNoMoreThanItsRoomAndForgets) {
  std::mt19937 random(2);
  const std::vector<Mirror> list = mirrors(random, MirrorFan::kMaxMirrors + 20);
  MirrorFan fan;
  fan.build(list, {0.0, 0.0});
  std::size_t visited = 0;
  for (double azimuth = -3.1; azimuth < 3.1; azimuth += 0.01) {
    fan.visit({std::cos(azimuth), std::sin(azimuth)}, [&](const Mirror& m) {
      ++visited;
      EXPECT_LT(&m - list.data(), static_cast<std::ptrdiff_t>(MirrorFan::kMaxMirrors));
    });
  }
  EXPECT_GT(visited, 0U);
  fan.build({}, {0.0, 0.0});
  fan.visit({1.0, 0.0}, [](const Mirror&) { ADD_FAILURE() << "nothing is left"; });
}

}  // namespace
}  // namespace boresight::ghosts
