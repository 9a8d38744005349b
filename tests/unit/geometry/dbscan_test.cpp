#include "services/common/geometry/dbscan.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::geometry {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// The definition of Ester et al., by comparing all pairs: core points, their connected components, and reachable
/// points.
struct Reference {
  Reference(const Points& points, double radius, std::size_t min_points) : component(points.size(), -1) {
    const std::size_t n = points.size();
    const auto near = [&](std::size_t i, std::size_t j) { return (points[i] - points[j]).norm() <= radius; };
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t reached = 0;
      for (std::size_t j = 0; j < n; ++j) reached += near(i, j) ? 1 : 0;
      is_core.push_back(reached >= min_points);
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (!is_core[i] || component[i] >= 0) continue;
      std::vector<std::size_t> open{i};
      component[i] = number;
      while (!open.empty()) {
        const std::size_t at = open.back();
        open.pop_back();
        for (std::size_t j = 0; j < n; ++j) {
          if (!is_core[j] || component[j] >= 0 || !near(at, j)) continue;
          component[j] = number;
          open.push_back(j);
        }
      }
      ++number;
    }
    for (std::size_t i = 0; i < n; ++i) {
      reachable.emplace_back();
      for (std::size_t j = 0; j < n; ++j) {
        if (is_core[j] && near(i, j)) reachable.back().insert(component[j]);
      }
    }
  }
  std::vector<bool> is_core;
  std::vector<int> component;
  std::vector<std::set<int>> reachable;
  int number = 0;
};

Points cloud(unsigned seed, std::size_t count, double size_m) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-size_m, size_m);
  std::normal_distribution<double> near(0.0, 1.0);
  Points points;
  Eigen::Vector2d centre(0.0, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 7 == 0) centre = {place(random), place(random)};
    points.push_back(i % 3 == 0 ? Eigen::Vector2d(place(random), place(random))
                                : Eigen::Vector2d(centre + Eigen::Vector2d(near(random), near(random))));
  }
  return points;
}

TEST(Dbscan, IsTheDefinitionOnRandomClouds) {
  Dbscan dbscan(512);
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Points points = cloud(seed, 20 + seed, 30.0);
    const double radius = 0.5 + 0.02 * seed;
    const std::size_t min_points = 1 + seed % 5;
    const Reference reference(points, radius, min_points);
    const std::size_t found = dbscan.cluster(points, radius, min_points);
    ASSERT_EQ(found, static_cast<std::size_t>(reference.number)) << "seed " << seed;
    const auto labels = dbscan.labels();
    ASSERT_EQ(labels.size(), points.size());
    std::map<int, int> name_of;  // component of the reference → label
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (reference.is_core[i]) {
        const auto [known, fresh] = name_of.try_emplace(reference.component[i], labels[i]);
        EXPECT_EQ(known->second, labels[i]) << "seed " << seed << ", core " << i;
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (reference.is_core[i]) continue;
      // Other points belong to one of the clusters within the radius, or are noise if there is none.
      std::set<int> allowed;
      for (const int component : reference.reachable[i]) allowed.insert(name_of.at(component));
      if (allowed.empty()) allowed.insert(Dbscan::kNoise);
      EXPECT_TRUE(allowed.contains(labels[i])) << "seed " << seed << ", point " << i;
    }
  }
}

TEST(Dbscan, DoesNotDependOnTheGridsOrigin) {
  Dbscan dbscan(512);
  const Points points = cloud(5, 300, 40.0);
  const std::size_t found = dbscan.cluster(points, 1.3, 3);
  const std::vector<std::int32_t> labels(dbscan.labels().begin(), dbscan.labels().end());
  for (const double shift : {0.4, -17.9, 1234.5, -9999.9}) {
    Points moved;
    for (const auto& p : points) moved.push_back(p + Eigen::Vector2d(shift, -0.7 * shift));
    EXPECT_EQ(dbscan.cluster(moved, 1.3, 3), found);
    EXPECT_TRUE(std::equal(labels.begin(), labels.end(), dbscan.labels().begin())) << shift;
  }
}

TEST(Dbscan, DistinguishesDistantPointsInTheSameBucket) {
  // Clusters at all powers of two of the radius in both directions, across all borders of the square of buckets.
  Dbscan dbscan(512);
  const Points clump = cloud(6, 12, 0.3);
  Points points;
  for (std::int32_t i = 1; i <= 12; ++i) {
    const double far = 1.5 * (1 << i);
    for (const auto& p : clump) {
      points.push_back(p + Eigen::Vector2d(far, 0.0));
      points.push_back(p + Eigen::Vector2d(0.0, -far));
    }
  }
  for (std::size_t count : {std::size_t{40}, std::size_t{100}, points.size()}) {
    const std::span<const Eigen::Vector2d> some = std::span(points).first(count);
    const Reference reference({some.begin(), some.end()}, 1.5, 3);
    ASSERT_EQ(dbscan.cluster(some, 1.5, 3), static_cast<std::size_t>(reference.number)) << count;
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(dbscan.labels()[i] == Dbscan::kNoise, reference.reachable[i].empty()) << count << ", point " << i;
    }
  }
}

TEST(Dbscan, NothingAndMoreThanItsCapacity) {
  Dbscan dbscan(16);
  EXPECT_EQ(dbscan.cluster({}, 1.0, 3), 0u);
  EXPECT_TRUE(dbscan.labels().empty());
  const Points many(100, Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(dbscan.cluster(many, 1.0, 3), 1u);
  EXPECT_EQ(dbscan.labels().size(), 16u);
}

TEST(Dbscan, AllocatesOnlyWhenConstructed) {
  Dbscan dbscan(4096);
  const Points points = cloud(9, 4096, 60.0);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    dbscan.cluster(points, 2.0, 3);
    dbscan.cluster(points, 0.1, 3);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::geometry
