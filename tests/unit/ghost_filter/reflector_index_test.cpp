#include "services/ghost_filter/core/reflector_map/reflector_index.hpp"

#include <random>
#include <set>

#include <gtest/gtest.h>

#include "services/ghost_filter/core/reflector_map/joining.hpp"

namespace boresight::ghosts {
namespace {

std::vector<Reflector> some_reflectors(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-100.0, 100.0), angle(-M_PI, M_PI), bend(-0.05, 0.05), half(3.0, 60.0);
  std::vector<Reflector> reflectors;
  for (std::size_t i = 0; i < count; ++i) {
    const double heading = angle(random);
    Reflector r{};
    r.curve = {{place(random), place(random)}, {std::cos(heading), std::sin(heading)}, i % 3 == 0 ? 0.0 : bend(random)};
    r.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    const double reach = std::min(half(random), 1.5 / std::max(1e-3, std::abs(r.curve.curvature_per_m)));
    r.occupancy.reset(-reach, reach, 2.0);
    reflectors.push_back(r);
  }
  return reflectors;
}

TEST(Curve, IsWithinWhatItsDistanceSays) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-40.0, 40.0), near(-2.0, 2.0), bend(-0.05, 0.05);
  for (int i = 0; i < 20000; ++i) {
    const Curve curve{{0.0, 0.0}, {1.0, 0.0}, i % 5 == 0 ? 0.0 : bend(random)};
    const Eigen::Vector2d q = i % 2 == 0
                                  ? Eigen::Vector2d(place(random), place(random))
                                  : Eigen::Vector2d(curve.at(place(random)) + Eigen::Vector2d(0.0, near(random)));
    for (const double most : {0.3, 1.2}) {
      const double distance = std::abs(curve.distance_of_local(q));
      if (std::abs(distance - most) < 1e-9) continue;
      ASSERT_EQ(curve.is_within(q, most), distance < most) << "curvature " << curve.curvature_per_m << ", " << distance;
    }
  }
}

TEST(ReflectorIndex, FindsAllThatRunPast) {
  ReflectorIndex index;
  constexpr double kBeyond_m = 5.0;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::vector<Reflector> reflectors = some_reflectors(seed, 30);
    index.build(reflectors, kBeyond_m);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.0, 1.0),
        beside(-ReflectorIndex::kBeside_m, ReflectorIndex::kBeside_m);
    std::size_t visited = 0;
    constexpr int kPlaces = 3000;
    for (int i = 0; i < kPlaces; ++i) {
      const Reflector& r = reflectors[random() % reflectors.size()];
      const double arc = r.begin_m() - kBeyond_m + share(random) * (r.length_m() + 2.0 * kBeyond_m);
      const Curve there = r.curve.moved(arc);
      const Eigen::Vector2d p = there.origin_m + beside(random) * there.normal();
      std::set<std::uint32_t> found;
      index.visit(p, [&](std::uint32_t number) {
        EXPECT_TRUE(found.insert(number).second) << "once";
        ++visited;
      });
      for (std::uint32_t k = 0; k < reflectors.size(); ++k) {
        const Reflector& each = reflectors[k];
        const double at = each.curve.arc(p);
        if (std::abs(each.curve.distance(p)) >= ReflectorIndex::kBeside_m) continue;
        if (at < each.begin_m() - kBeyond_m || at > each.end_m() + kBeyond_m) continue;
        ASSERT_TRUE(found.contains(k)) << "seed " << seed << ", reflector " << k;
      }
    }
    EXPECT_LT(visited, 10U * kPlaces) << "and not all of the thirty";
  }
}

TEST(RunsAlong, ADistantOneNeverDoes) {
  // Continues the other one as well as can be, or stands somewhere on its line far beyond its end.
  std::vector<Reflector> reflectors = some_reflectors(4, 30);
  for (const Reflector& longer : reflectors) {
    if (longer.length_m() < 20.0) continue;
    for (const double gap : {1.0, 3.0, 12.0, 60.0}) {
      if (std::abs(longer.curve.curvature_per_m) * (longer.length_m() + gap) > 3.0) continue;  // once round
      Reflector shorter = longer;
      const double arc = longer.end_m() + gap + 4.0;
      shorter.curve = longer.curve.moved(arc);
      shorter.occupancy.reset(-4.0, 3.9, 2.0);
      EXPECT_EQ(runs_along(longer, shorter, {}), gap < 5.0) << gap << ", " << longer.length_m();
      shorter.curve.origin_m += 30.0 * shorter.curve.normal();
      EXPECT_FALSE(runs_along(longer, shorter, {}));
    }
  }
}

}  // namespace
}  // namespace boresight::ghosts
