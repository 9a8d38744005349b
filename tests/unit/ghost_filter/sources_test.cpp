#include "services/ghost_filter/core/classify/sources.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

using Eigen::Vector2d;

bool has(const MirrorBits& bits, std::size_t mirror) {
  return (bits[mirror / 64] >> (mirror % 64) & 1U) != 0;
}

TEST(Sources, LeaveOutNoWayToAnObjectAndMostOfTheOthers) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-60.0, 60.0), angle(-M_PI, M_PI), bend(-0.01, 0.01), part(-1.0, 1.0);
  const Vector2d sensor(3.5, 0.5);
  const RecentMovers nothing;
  const Odometry odometry;
  Sources sources;
  std::vector<Touch> touches;
  touches.reserve(Sources::kMax);
  std::size_t ways = 0, followed = 0, all = 0;
  for (int scene = 0; scene < 50; ++scene) {
    std::vector<Mirror> mirrors(20);
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
      const double turned = angle(random);
      mirrors[i].curve = {
          {place(random), place(random)}, {std::cos(turned), std::sin(turned)}, i % 2 == 0 ? 0.0 : bend(random)};
      mirrors[i].covariance = Eigen::Vector3d(0.01, 1e-4, 1e-8).asDiagonal();
      mirrors[i].begin_m = -15.0;
      mirrors[i].end_m = 15.0;
      mirrors[i].existence = 0.9;
    }
    std::vector<Object> objects(10);
    for (Object& o : objects) {
      const double turned = angle(random);
      o.position_m = {place(random), place(random)};
      o.axis = {std::cos(turned), std::sin(turned)};
      o.half_length_m = 2.2;
      o.half_width_m = 0.9;
      o.position_covariance = 0.1 * Eigen::Matrix2d::Identity();
      o.weight = 1.0;
    }
    sources.build(mirrors, objects, nothing, odometry, sensor, 1.3, 0.05);
    for (std::uint32_t k = 0; k < objects.size(); ++k) {
      const Object& o = objects[k];
      const Vector2d on_it = o.position_m + part(random) * o.half_length_m * o.axis;
      const Vector2d sight = on_it - sensor;
      for (std::size_t i = 0; i < mirrors.size(); ++i) {
        const auto detour = detour_to(mirrors[i], sensor, on_it);
        if (!detour || sight.norm() < 3.0) continue;
        // A type-1 ghost of that spot: in its direction, at the length of both ways.
        const double length = sight.norm() + detour->length_m;
        const Ray ray{sensor, sight.normalized(), 0.5 * length, 0.2, 0.005};
        sources.touched(ray, Sources::kAny, touches);
        const MirrorBits found = sources.ways(ray, touches, length, 2.0, kNobody);
        EXPECT_TRUE(has(found, i)) << "scene " << scene << ", object " << k << ", mirror " << i;
        ++ways;
        for (std::size_t each = 0; each < mirrors.size(); ++each) followed += has(found, each) ? 1U : 0U;
        all += mirrors.size();
      }
    }
  }
  EXPECT_GE(ways, 200u);
  EXPECT_LE(3 * followed, all) << followed << " of " << all;
}

TEST(Sources, OfWhatWasDetectedLatelyFindWhatLiesAlongARay) {
  RecentMovers movers;
  const Odometry odometry;
  const auto detected = [&](const Vector2d& at, double weight) {
    movers.add({at, at.normalized(), 0.0, 0.1, weight, 0, 0, 0.0, kNobody});
  };
  detected({30.0, 0.0}, 1.0);
  detected({30.5, 0.3}, 1.0);
  detected({0.0, 30.0}, 1.0);
  detected({-30.0, 0.0}, 0.0);  // weighs nothing
  Sources sources;
  sources.build({}, {}, movers, odometry, {0.0, 0.0}, 1.3, 0.05);
  std::vector<Touch> touches;
  touches.reserve(Sources::kMax);
  const auto found = [&](const Vector2d& direction) {
    sources.touched({{0.0, 0.0}, direction, 100.0, 0.2, 0.005}, Sources::kAny, touches);
    std::vector<std::uint32_t> numbers;
    for (const Touch& touch : touches) {
      sources.visit_movers(touch.source, [&](std::uint32_t number) { numbers.push_back(number); });
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
  };
  EXPECT_EQ(found({1.0, 0.0}), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(found({0.0, 1.0}), (std::vector<std::uint32_t>{2}));
  EXPECT_TRUE(found({-1.0, 0.0}).empty());
}

TEST(Sources, TakeAllThatIsDetectedHoweverMuchItIs) {
  // More than there is room for one by one: larger cells hold it.
  RecentMovers movers;
  for (int i = 0; i < 2000; ++i) {
    const Vector2d at(10.0 * (i % 50), 10.0 * (i / 50));
    movers.add({at, {1.0, 0.0}, 0.0, 0.1, 1.0, 0, 0, 0.0, kNobody});
  }
  Sources sources;
  const Odometry odometry;
  sources.build({}, {}, movers, odometry, {0.0, 0.0}, 1.3, 0.05);
  std::vector<Touch> touches;
  touches.reserve(Sources::kMax);
  // So wide a ray sees everything in front of it.
  sources.touched({{-1.0, -1.0}, {1.0, 0.0}, 1e4, 1e3, 1.0}, Sources::kAny, touches);
  std::size_t number = 0;
  for (const Touch& touch : touches) sources.visit_movers(touch.source, [&](std::uint32_t) { ++number; });
  EXPECT_EQ(number, 2000u);
}

}  // namespace
}  // namespace boresight::ghosts
