#include "services/boresight/fit_classes/random_traffic.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "services/simulator/world.hpp"

namespace boresight::fit_classes {
namespace {

constexpr double kDuration_s = 20.0;

TEST(RandomTraffic, SameSeedGivesTheSameScenarioAndAnotherSeedAnother) {
  EXPECT_EQ(random_traffic(7, kDuration_s), random_traffic(7, kDuration_s));
  EXPECT_FALSE(random_traffic(7, kDuration_s) == random_traffic(8, kDuration_s));
}

TEST(RandomTraffic, ClassesAreEquallyFrequent) {
  std::map<simulator::BodyKind, int> number;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const simulator::BodySpec& body : random_traffic(seed, kDuration_s).bodies) ++number[body.kind];
  }
  ASSERT_EQ(number.size(), 5U);
  for (const auto& [kind, count] : number) EXPECT_NEAR(count, number.begin()->second, 5) << static_cast<int>(kind);
}

TEST(RandomTraffic, RoadUsersAreNearTheEgoVehicleAtSomeTime) {
  constexpr double kNear_m = 100.0, kShareNear = 0.8;
  int near = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const simulator::World world(random_traffic(seed, kDuration_s), seed, kDuration_s);
    for (std::size_t i = 0; i < world.number_of_bodies(); ++i) {
      double nearest_m = 1e9;
      for (double t_s = 0.0; t_s <= kDuration_s; t_s += 0.5) {
        nearest_m = std::min(nearest_m, (world.body(i, t_s).position_m - world.ego(t_s).position_m).norm());
      }
      ++all;
      near += nearest_m < kNear_m ? 1 : 0;
    }
  }
  EXPECT_GT(near, kShareNear * all);
}

}  // namespace
}  // namespace boresight::fit_classes
