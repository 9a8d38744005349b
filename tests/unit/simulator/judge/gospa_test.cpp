// GOSPA and its assignment, beside brute force and hand-made cases.
#include "services/simulator/judge/gospa.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace boresight::judge {
namespace {

Ellipse car_at(double x, double y, double heading_rad = 0.3) {
  return ellipse_in_box({x, y}, heading_rad, 4.5, 1.8);
}

Eigen::Matrix2d root_of(const Eigen::Matrix2d& m) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(m).operatorSqrt();
}

/// By the definition: tr(X + Y − 2 (X^½ Y X^½)^½).
double distance_by_definition(const Ellipse& a, const Ellipse& b) {
  const Eigen::Matrix2d root = root_of(a.extent_m2);
  return (a.centre_m - b.centre_m).squaredNorm() +
         (a.extent_m2 + b.extent_m2 - 2.0 * root_of(root * b.extent_m2 * root)).trace();
}

/// Least GOSPA over all assignments.
double brute_force(const std::vector<Ellipse>& objects, const std::vector<Ellipse>& tracks, GospaBase base) {
  const std::size_t n = std::max(objects.size(), tracks.size());
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  double best = INFINITY;
  do {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const bool has_object = i < objects.size(), has_track = order[i] < tracks.size();
      double cost = (has_object ? 10.0 : 0.0) + (has_track ? 10.0 : 0.0);
      if (has_object && has_track) {
        const double squared_m2 = distance_by_definition(objects[i], tracks[order[i]]);
        cost = std::min(cost, base == GospaBase::kSquared ? squared_m2 : std::sqrt(squared_m2));
      }
      sum += cost;
    }
    best = std::min(best, sum);
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(GaussianWasserstein, IsThatOfTheDefinition) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-5.0, 5.0), angle(-4.0, 4.0), size(0.3, 15.0);
  for (int i = 0; i < 200; ++i) {
    const Ellipse a = ellipse_in_box({place(random), place(random)}, angle(random), size(random), size(random));
    const Ellipse b = ellipse_in_box({place(random), place(random)}, angle(random), size(random), size(random));
    EXPECT_NEAR(gaussian_wasserstein_squared(a, b), distance_by_definition(a, b), 1e-6);
  }
}

TEST(GaussianWasserstein, OfAlignedEllipsesIsTheDifferenceOfTheHalfAxes) {
  const Ellipse a = ellipse_in_box({0.0, 0.0}, 0.7, 6.0, 2.0), b = ellipse_in_box({0.0, 0.0}, 0.7, 4.0, 1.0);
  EXPECT_NEAR(gaussian_wasserstein_squared(a, b), 1.0 + 0.25, 1e-9);
  EXPECT_NEAR(gaussian_wasserstein_squared(a, a), 0.0, 1e-9);
}

TEST(Gospa, PerfectTracksCostNothing) {
  const std::vector<Ellipse> objects = {car_at(10.0, 0.0), car_at(30.0, 4.0)};
  Gospa gospa;
  for (const GospaBase base : {GospaBase::kSquared, GospaBase::kRoot}) {
    EXPECT_NEAR(gospa.evaluate(objects, objects, base).total(), 0.0, 1e-6);
  }
}

TEST(Gospa, MissedObjectAndFalseTrackCostTenEach) {
  Gospa gospa;
  const std::vector<Ellipse> one = {car_at(10.0, 0.0)}, none, far = {car_at(90.0, 0.0)};
  const GospaParts missed = gospa.evaluate(one, none, GospaBase::kRoot);
  EXPECT_DOUBLE_EQ(missed.missed, 10.0);
  EXPECT_DOUBLE_EQ(missed.total(), 10.0);
  const GospaParts false_track = gospa.evaluate(none, one, GospaBase::kSquared);
  EXPECT_DOUBLE_EQ(false_track.false_tracks, 10.0);
  EXPECT_DOUBLE_EQ(false_track.total(), 10.0);
  const GospaParts both = gospa.evaluate(one, far, GospaBase::kRoot);
  EXPECT_DOUBLE_EQ(both.missed, 10.0);
  EXPECT_DOUBLE_EQ(both.false_tracks, 10.0);
  EXPECT_DOUBLE_EQ(both.localisation, 0.0);
}

TEST(Gospa, SquaredBaseCutsAtTheRootOfTwenty) {
  Gospa gospa;
  const std::vector<Ellipse> object = {car_at(10.0, 0.0)};
  const std::vector<Ellipse> near = {car_at(14.4, 0.0)}, farther = {car_at(14.5, 0.0)};
  EXPECT_NEAR(gospa.evaluate(object, near, GospaBase::kSquared).localisation, 4.4 * 4.4, 1e-6);
  EXPECT_DOUBLE_EQ(gospa.evaluate(object, farther, GospaBase::kSquared).missed, 10.0);
  EXPECT_NEAR(gospa.evaluate(object, farther, GospaBase::kRoot).localisation, 4.5, 1e-6);
}

TEST(Gospa, EqualsBruteForce) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(0.0, 12.0), angle(-4.0, 4.0), size(0.5, 8.0);
  std::uniform_int_distribution<int> number(0, 6);
  Gospa gospa;
  for (int i = 0; i < 60; ++i) {
    std::vector<Ellipse> objects, tracks;
    for (int n = number(random); n > 0; --n) {
      objects.push_back(ellipse_in_box({place(random), place(random)}, angle(random), size(random), size(random)));
    }
    for (int n = number(random); n > 0; --n) {
      tracks.push_back(ellipse_in_box({place(random), place(random)}, angle(random), size(random), size(random)));
    }
    for (const GospaBase base : {GospaBase::kSquared, GospaBase::kRoot}) {
      EXPECT_NEAR(gospa.evaluate(objects, tracks, base).total(), brute_force(objects, tracks, base), 1e-6);
    }
  }
}

TEST(Gospa, DoesNotDependOnTheFrame) {
  std::vector<Ellipse> objects, tracks, turned_objects, turned_tracks;
  const double turn_rad = 1.1;
  const Eigen::Rotation2Dd turn(turn_rad);
  const Eigen::Vector2d shift(-20.0, 7.0);
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d at(10.0 + 3.0 * i, 2.0 * i), track = at + Eigen::Vector2d(0.4, -0.3 * i);
    objects.push_back(ellipse_in_box(at, 0.2 * i, 4.5, 1.8));
    tracks.push_back(ellipse_in_box(track, 0.3 * i, 4.0, 2.0));
    turned_objects.push_back(ellipse_in_box(turn * at + shift, 0.2 * i + turn_rad, 4.5, 1.8));
    turned_tracks.push_back(ellipse_in_box(turn * track + shift, 0.3 * i + turn_rad, 4.0, 2.0));
  }
  Gospa gospa;
  const double total = gospa.evaluate(objects, tracks, GospaBase::kRoot).total();
  EXPECT_GT(total, 0.5);
  EXPECT_NEAR(gospa.evaluate(turned_objects, turned_tracks, GospaBase::kRoot).total(), total, 1e-9);
}

TEST(Pairing, OfMoreThanTheSolversCapacitySucceedsInIndependentGroups) {
  constexpr std::size_t kMany = 300;
  std::vector<PairCost> pairs;
  for (std::size_t i = 0; i < kMany; ++i) {
    pairs.push_back({i, i, 1.0});
    if (i % 2 == 1) pairs.push_back({i, i - 1, 0.5});  // dearer in sum: its partner would be alone
  }
  Pairing pairing;
  pairing.solve(kMany, kMany, pairs, 20.0);
  for (std::size_t i = 0; i < kMany; ++i) EXPECT_EQ(pairing.column_of(i), i);
  EXPECT_DOUBLE_EQ(pairing.cost_of_pairs(), static_cast<double>(kMany));
  EXPECT_EQ(pairing.not_considered(), 0u);
}

}  // namespace
}  // namespace boresight::judge
