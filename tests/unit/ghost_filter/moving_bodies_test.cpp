#include "services/ghost_filter/core/classify/moving_bodies.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::ghosts {
namespace {

std::vector<Object> some_objects(unsigned seed, std::size_t count, double area_m) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-area_m, area_m), angle(-M_PI, M_PI), share(0.0, 1.0);
  std::vector<Object> objects(count);
  for (Object& o : objects) {
    const double heading = angle(random);
    o.position_m = {place(random), place(random)};
    o.axis = {std::cos(heading), std::sin(heading)};
    o.half_length_m = 0.3 + 10.0 * share(random);
    o.half_width_m = 0.3 + 1.2 * share(random);
    o.moving = share(random) < 0.7 ? 1.0 : share(random);
    o.weight = share(random);
  }
  return objects;
}

TEST(MovingBodies, AreThoseThatAComparisonWithAllFinds) {
  MovingBodies bodies(129);
  std::mt19937 random(1);
  std::size_t on = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const double area_m = 20.0 + 20.0 * seed;  // also more than all strips
    std::vector<Object> objects = some_objects(seed, seed % 4 == 0 ? 129 : 20, area_m);
    if (seed % 5 == 0) objects[3].half_length_m = 1e12;
    bodies.find(objects);
    const auto counts = [](const Object& o) { return o.weight > 0.5 && o.moving >= 0.8; };
    EXPECT_EQ(bodies.numbers().size(), std::count_if(objects.begin(), objects.end(), counts));
    std::uniform_real_distribution<double> place(-1.2 * area_m, 1.2 * area_m), around(-12.0, 12.0);
    for (int i = 0; i < 2000; ++i) {
      Eigen::Vector2d p(place(random), place(random));
      if (i % 2 == 0)
        p = objects[random() % objects.size()].position_m + Eigen::Vector2d(around(random), around(random));
      const bool expected = std::any_of(objects.begin(), objects.end(), [&](const Object& o) {
        return counts(o) && is_on(o, p, MovingBodies::kAround_m);
      });
      ASSERT_EQ(bodies.any_at(p), expected) << "seed " << seed << ", place " << p.transpose();
      on += expected ? 1 : 0;
    }
  }
  EXPECT_GT(on, 1000U);
}

TEST(MovingBodies, TakesNoMoreThanItsCapacityAndAllocatesNothing) {
  MovingBodies bodies(3);
  std::vector<Object> objects = some_objects(2, 8, 20.0);
  for (Object& o : objects) {
    o.weight = 1.0;
    o.moving = 1.0;
  }
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    bodies.find(objects);
    EXPECT_TRUE(bodies.any_at(objects[2].position_m));
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_EQ(bodies.numbers().size(), 3U);
  bodies.find({});
  EXPECT_FALSE(bodies.any_at(objects[2].position_m));
}

}  // namespace
}  // namespace boresight::ghosts
