// The world at an instant is complete, reproducible, and without collisions.
#include "services/simulator/world.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include <gtest/gtest.h>

#include "services/simulator/scenario_file.hpp"

namespace boresight::simulator {
namespace {

class Shipped : public testing::TestWithParam<std::string> {};

TEST_P(Shipped, IsTheSameForTheSameSeedWhateverTheDuration) {
  const Scenario s = scenario(GetParam());
  const World a(s, 5, s.duration_s), b(s, 5, 2.0), other(s, 6, 2.0);
  Scene in_a, in_b, in_other;
  a.at(1.5, 80.0, in_a);
  b.at(1.5, 80.0, in_b);
  other.at(1.5, 80.0, in_other);
  ASSERT_EQ(in_a.scatterers.size(), in_b.scatterers.size());
  ASSERT_EQ(in_a.surfaces.size(), in_b.surfaces.size());
  ASSERT_EQ(in_a.centres.size(), in_b.centres.size());
  for (std::size_t i = 0; i < in_a.scatterers.size(); ++i) {
    ASSERT_EQ(in_a.scatterers[i].position_m, in_b.scatterers[i].position_m);
  }
  for (std::size_t i = 0; i < in_a.centres.size(); ++i) {
    ASSERT_EQ(in_a.centres[i].position_m, in_b.centres[i].position_m);
  }
  ASSERT_FALSE(in_other.scatterers.empty());
  EXPECT_NE(in_a.scatterers[0].position_m, in_other.scatterers[0].position_m);
}

TEST_P(Shipped, ContainsEverythingWithinReachAndKeepsItsBuffers) {
  const Scenario s = scenario(GetParam());
  const World world(s, 1, s.duration_s);
  Scene scene, all;
  for (double t = 0.0; t < s.duration_s; t += 0.5) world.at(t, 100.0, scene);
  const std::array<const void*, 4> buffers = {scene.bodies.data(), scene.centres.data(), scene.surfaces.data(),
                                              scene.scatterers.data()};
  for (double t = 0.0; t < s.duration_s; t += 0.5) {
    world.at(t, 100.0, scene);
    // The near part of a scene with a much longer reach must be the same.
    world.at(t, World::kReach_m, all);
    const auto near = std::count_if(all.scatterers.begin(), all.scatterers.end(), [&](const Scatterer& p) {
      return (p.position_m.head<2>() - all.ego.position_m).norm() <= 100.0;
    });
    ASSERT_EQ(static_cast<std::size_t>(near), scene.scatterers.size()) << t;
    std::size_t centres = 0;
    std::uint32_t last = 0;
    for (const Body& b : scene.bodies) {
      EXPECT_GT(b.id, last);
      last = b.id;
      EXPECT_EQ(b.first_centre, centres);
      centres += b.number_of_centres;
      EXPECT_TRUE(!b.parked || b.velocity_mps.norm() == 0.0);
    }
    EXPECT_EQ(centres, scene.centres.size());
  }
  EXPECT_EQ(buffers[0], scene.bodies.data());
  EXPECT_EQ(buffers[1], scene.centres.data());
  EXPECT_EQ(buffers[2], scene.surfaces.data());
  EXPECT_EQ(buffers[3], scene.scatterers.data());
}

using Box = std::array<Eigen::Vector2d, 4>;

Box box(const Eigen::Vector2d& centre, double heading, double length, double width) {
  const Eigen::Vector2d ahead(std::cos(heading), std::sin(heading)), left(-ahead.y(), ahead.x());
  const Eigen::Vector2d u = 0.5 * length * ahead, w = 0.5 * width * left;
  return {centre + u + w, centre - u + w, centre - u - w, centre + u - w};
}

/// Overlap test by separating axes; a segment is a box without width.
bool overlap(const Box& a, const Box& b) {
  for (const Box* sides : {&a, &b}) {
    for (std::size_t i = 0; i < 2; ++i) {
      Eigen::Vector2d axis = (*sides)[i + 1] - (*sides)[i];
      if (axis.norm() < 1e-9) continue;
      double a_low = 1e9, a_high = -1e9, b_low = 1e9, b_high = -1e9;
      for (std::size_t k = 0; k < 4; ++k) {
        a_low = std::min(a_low, axis.dot(a[k]));
        a_high = std::max(a_high, axis.dot(a[k]));
        b_low = std::min(b_low, axis.dot(b[k]));
        b_high = std::max(b_high, axis.dot(b[k]));
      }
      if (a_high < b_low || b_high < a_low) return false;
    }
  }
  return true;
}

TEST_P(Shipped, BodiesDoNotCollide) {
  const Scenario s = scenario(GetParam());
  const World world(s, 1, s.duration_s);
  Scene scene;
  for (double t = 0.0; t < s.duration_s; t += 0.25) {
    world.at(t, 120.0, scene);
    const Eigen::Vector2d ahead(std::cos(scene.ego.heading_rad), std::sin(scene.ego.heading_rad));
    const EgoSpec& e = s.ego;
    std::vector<std::pair<std::uint32_t, Box>> boxes = {
        {0, box(scene.ego.position_m + (0.5 * e.length_m - e.rear_overhang_m) * ahead, scene.ego.heading_rad,
                e.length_m, e.width_m)}};
    for (const Body& b : scene.bodies) {
      boxes.emplace_back(b.id, box(b.position_m, b.heading_rad, b.length_m, b.width_m));
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        ASSERT_FALSE(overlap(boxes[i].second, boxes[k].second))
            << boxes[i].first << " and " << boxes[k].first << " at " << t;
      }
      for (const MirrorSurface& m : scene.surfaces) {
        if (m.body_id != 0) continue;
        const Eigen::Vector2d thin = 1e-6 * (m.to_m - m.from_m).normalized();
        const Eigen::Vector2d across(-thin.y(), thin.x());
        ASSERT_FALSE(overlap(boxes[i].second, {m.from_m + across, m.to_m + across, m.to_m - across, m.from_m - across}))
            << boxes[i].first << " at " << t << " in (" << m.from_m.transpose() << ")–(" << m.to_m.transpose() << ")";
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Shipped, testing::ValuesIn(scenario_names()));

TEST(World, StationaryThingsNameTheirTableInTheScenario) {
  const Scenario s = scenario("city_canyon");
  const World world(s, 1, 2.0);
  Scene scene;
  world.at(0.5, 100.0, scene);
  std::size_t kerbs = 0, right_facades = 0;
  for (const Scatterer& p : scene.scatterers) {
    ASSERT_NE(p.origin.kind, Origin::Kind::kNone);
    if (p.origin == Origin{Origin::Kind::kScatter, 0}) {  // the kerb: low, 5.3 … 5.4 m off the road's line
      ++kerbs;
      EXPECT_LT(p.position_m.z(), 0.2);
      EXPECT_NEAR(std::abs(p.position_m.y()), 5.35, 0.06);
    }
    if (p.origin == Origin{Origin::Kind::kStructure, 1}) {  // the facade on the right
      ++right_facades;
      EXPECT_NEAR(p.position_m.y(), -7.5, 1.0);
    }
  }
  EXPECT_GT(kerbs, 50u);
  EXPECT_GT(right_facades, 50u);
}

TEST(World, ParkedCarsKeepTheirNumbersWhateverElseThereIs) {
  Scenario s = scenario("city_canyon");
  const World alone(s, 1, 5.0);
  s.bodies.push_back(s.bodies.front());
  const World more(s, 1, s.duration_s);
  std::map<std::uint32_t, Eigen::Vector2d> places;
  for (std::size_t i = 0; i < more.number_of_bodies(); ++i) {
    const Body body = more.body(i, 0.0);
    EXPECT_TRUE(places.emplace(body.id, body.position_m).second) << body.id;
    EXPECT_EQ(body.id >= World::kParkedIds, i >= s.bodies.size());
  }
  std::size_t parked = 0;
  for (std::size_t i = s.bodies.size() - 1; i < alone.number_of_bodies(); ++i, ++parked) {
    const Body body = alone.body(i, 0.0);
    ASSERT_TRUE(places.contains(body.id));
    EXPECT_EQ(places[body.id], body.position_m);
  }
  EXPECT_GT(parked, 10u);
}

TEST(World, AddingOneThingChangesNoOther) {
  Scenario s = scenario("aligned_drive");
  const World before(s, 9, 2.0);
  s.scatter.push_back(s.scatter.front());
  s.structures.push_back(s.structures.front());
  s.bodies.push_back(s.bodies.front());
  const World after(s, 9, 2.0);
  Scene a, b;
  before.at(1.0, 60.0, a);
  after.at(1.0, 60.0, b);
  EXPECT_GT(b.scatterers.size(), a.scatterers.size());
  for (const Scatterer& p : a.scatterers) {
    ASSERT_TRUE(std::any_of(b.scatterers.begin(), b.scatterers.end(), [&](const Scatterer& q) {
      return q.position_m == p.position_m && q.rcs_dbsm == p.rcs_dbsm;
    }));
  }
  for (std::size_t i = 0; i < a.centres.size(); ++i) ASSERT_EQ(a.centres[i].position_m, b.centres[i].position_m);
}

}  // namespace
}  // namespace boresight::simulator
