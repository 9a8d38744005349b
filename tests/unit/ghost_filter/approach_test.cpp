// Ways by a mirror: those found are ways, none is missed, and what is told of one without following it holds.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "services/ghost_filter/core/density/exponential.hpp"
#include "services/ghost_filter/core/mirror/beam.hpp"
#include "services/ghost_filter/core/mirror/meeting.hpp"

namespace boresight::ghosts {
namespace {

Mirror some_mirror(std::mt19937& random, double most_curvature_per_m) {
  std::uniform_real_distribution<double> place(-70.0, 70.0), angle(-3.15, 3.15), half(2.0, 50.0),
      bend(-most_curvature_per_m, most_curvature_per_m);
  Mirror m;
  const double heading = angle(random);
  m.curve = {{place(random), place(random)}, {std::cos(heading), std::sin(heading)}, bend(random)};
  m.end_m = half(random);
  if (std::abs(m.curve.curvature_per_m) * m.end_m > 1.2) m.end_m = 1.2 / std::abs(m.curve.curvature_per_m);
  m.begin_m = -m.end_m;
  m.covariance = Eigen::Vector3d(0.01, 1e-5, 1e-9).asDiagonal();
  m.existence = 1.0;
  return m;
}

/// A ray, and how long the way by a mirror to a place on it and back along it is.
struct Ray {
  Eigen::Vector2d sensor{3.6, 0.7}, direction, from;
  double length;
};
/// From the sensor itself, or from somewhere else.
Ray some_ray(std::mt19937& random, bool from_sensor) {
  std::uniform_real_distribution<double> place(-35.0, 35.0), angle(-3.15, 3.15), range(5.0, 120.0);
  const double azimuth = angle(random);
  Ray ray;
  ray.direction = {std::cos(azimuth), std::sin(azimuth)};
  ray.from = from_sensor ? ray.sensor : Eigen::Vector2d(place(random), place(random));
  ray.length = (ray.from - ray.sensor).norm() + 2.0 * range(random);
  return ray;
}

/// Of a way that turns at a place on the mirror, the cosine at which it arrives there less that at which it leaves:
/// light turns where that changes its sign. NaN where there is no such way.
double arriving_less_leaving(const Mirror& m, double arc, const Ray& ray, double* rest) {
  const auto& [sensor, direction, from, length] = ray;
  const Eigen::Vector2d point = m.curve.at(arc), tangent = m.curve.tangent_at(arc);
  const double left = length - (point - sensor).norm();
  // |T − W| = left − rest along the ray, by halving.
  double low = 0.0, high = left;
  const auto too_short = [&](double r) { return r + (ray.from + r * ray.direction - point).norm() < left; };
  if (left <= 0.0 || !too_short(low)) return std::nan("");
  for (int k = 0; k < 60; ++k) (too_short(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  *rest = low;
  const Eigen::Vector2d target = from + low * direction;
  const Eigen::Vector2d normal(-tangent.y(), tangent.x());
  if ((sensor - point).dot(normal) * (target - point).dot(normal) <= 0.0) return std::nan("");
  return (point - sensor).normalized().dot(tangent) - (target - point).normalized().dot(tangent);
}

TEST(Meet, FindsWhatASearchAlongTheMirrorFinds) {
  std::mt19937 random(2);
  // Straight ones, rails in bends, and a quarter of a roundabout.
  constexpr std::array<double, 3> kMostBent{0.0, 0.01, 0.03}, kLeastFound{0.99, 0.96, 0.85};
  std::array<std::size_t, 3> ways{}, found{}, invented{};
  for (int run = 0; run < 20000; ++run) {
    const Mirror m = some_mirror(random, kMostBent[static_cast<std::size_t>(run % 3)]);
    const Ray ray = some_ray(random, run % 2 == 0);
    const auto& [sensor, direction, from, length] = ray;
    const auto way = WaysBy(m, sensor).approach(from, direction, length);
    const auto met = way ? WaysBy(m, sensor).meet(way->arc_m, from, direction, length, 0.5) : std::nullopt;
    if (met) {
      const Eigen::Vector2d target = from + met->rest_m * direction;
      const double by_mirror = (met->point_m - sensor).norm() + (target - met->point_m).norm();
      ASSERT_NEAR(by_mirror + met->rest_m, length, 1e-6);
      ASSERT_NEAR(m.curve.distance(met->point_m), 0.0, 1e-5);
      const Eigen::Vector2d tangent = m.curve.tangent_at(m.curve.arc(met->point_m));
      ASSERT_NEAR(met->departure.dot(tangent), met->arrival.dot(tangent), 0.2);
      const Eigen::Vector2d normal(-tangent.y(), tangent.x());
      ASSERT_LT(met->departure.dot(normal) * met->arrival.dot(normal), 0.0) << "through the mirror";
    }
    // Every place where the sign changes is a way, as far as it is not near the mirror's end or its own begin.
    double before = std::nan("");
    bool is_way = false, is_found = false;
    for (double arc = m.begin_m; arc <= m.end_m; arc += 0.5) {
      double rest = 0.0;
      const double now = arriving_less_leaving(m, arc, ray, &rest);
      if (before * now <= 0.0 && rest > 1.0) {
        is_way = true;
        is_found = is_found || (met && std::abs(m.curve.arc(met->point_m) - arc) < 1.0);
      }
      before = now;
    }
    const auto kind = static_cast<std::size_t>(run % 3);
    ways[kind] += is_way ? 1 : 0;
    found[kind] += is_found ? 1 : 0;
    const bool within = met && std::abs(m.curve.arc(met->point_m)) < m.end_m - 0.5 && met->rest_m > 1.0;
    invented[kind] += within && !is_way ? 1 : 0;
  }
  for (std::size_t kind = 0; kind < 3; ++kind) {
    EXPECT_GT(ways[kind], 500U);
    EXPECT_GE(static_cast<double>(found[kind]), kLeastFound[kind] * static_cast<double>(ways[kind])) << kind;
    EXPECT_LT(invented[kind], ways[kind] / 100) << kind;
  }
}

TEST(Approach, HoldsOfEveryWayThatIsFound) {
  std::mt19937 random(1);
  std::size_t met = 0, known = 0, none = 0, gentle_missed = 0, missed = 0, farther = 0;
  for (int run = 0; run < 100000; ++run) {
    const bool gentle = run % 3 != 0;  // as walls and rails are
    const Mirror m = some_mirror(random, run % 3 == 2 ? 0.0 : gentle ? 0.0005 : 0.05);
    const Ray ray = some_ray(random, run % 2 == 0);
    const auto& [sensor, direction, from, length] = ray;
    const auto way = WaysBy(m, sensor).approach(from, direction, length);
    none += way ? 0 : 1;
    // What starts near a way finds it, whatever approach() says.
    const auto there = WaysBy(m, sensor).meet(way ? way->arc_m : m.curve.arc(sensor), from, direction, length, 0.5);
    if (!there) continue;
    ++met;
    gentle_missed += gentle && !way ? 1 : 0;
    missed += way ? 0 : 1;
    if (!way || !std::isfinite(way->error_m)) continue;
    ++known;
    const bool is_off = std::abs(way->rest_m - there->rest_m) > way->error_m + 0.5;
    EXPECT_FALSE(is_off && gentle) << "run " << run;
    farther += is_off ? 1 : 0;
    EXPECT_LE(there->metres_per_m * there->length_std_m, 1.2 * way->metres_per_m * way->length_std_m + 3.0);
  }
  EXPECT_GT(met, 3000U);
  EXPECT_GT(known, met / 2);
  EXPECT_GT(none, 20000U) << "or it saves nothing";
  EXPECT_LE(gentle_missed, 2U) << "but what grazes";
  // Of mirrors that are bent to a quarter of a circle some are hard to foretell; and what meet() would not find from
  // where approach() leads is not told.
  EXPECT_LT(missed, met / 400);
  EXPECT_LT(farther, known / 2000);
}

TEST(Beam, LightsEveryWayThatIsFound) {
  std::mt19937 random(3);
  std::size_t met = 0, dark = 0, missed = 0, gentle_missed = 0;
  for (int run = 0; run < 100000; ++run) {
    const bool gentle = run % 3 != 0;  // as walls and rails are
    const Mirror m = some_mirror(random, run % 3 == 2 ? 0.0 : gentle ? 0.0005 : 0.03);
    const Ray ray = some_ray(random, run % 2 == 0);
    const auto& [sensor, direction, from, length] = ray;
    // Farther along the ray than this, there and back would be longer.
    const double farthest = 0.5 * (length + (from - sensor).norm());
    const bool is_lit = Beam(m, sensor).may_light(from, from + farthest * direction);
    dark += is_lit ? 0 : 1;
    const auto way = WaysBy(m, sensor).approach(from, direction, length);
    if (!way || !WaysBy(m, sensor).meet(way->arc_m, from, direction, length, 0.5)) continue;
    ++met;
    missed += is_lit ? 0 : 1;
    gentle_missed += gentle && !is_lit ? 1 : 0;
  }
  EXPECT_GT(met, 3000U);
  EXPECT_GT(dark, 20000U) << "or it saves nothing";
  EXPECT_EQ(gentle_missed, 0U);
  EXPECT_LT(missed, met / 500);
}

TEST(Exponential, HasNineDigits) {
  for (double x = -700.0; x <= 700.0; x += 0.0137) {
    ASSERT_NEAR(exponential(x) / std::exp(x), 1.0, 1e-9) << x;
  }
  EXPECT_LT(exponential(-1e300), 1e-300);
  EXPECT_TRUE(std::isnan(exponential(std::nan(""))));
}

}  // namespace
}  // namespace boresight::ghosts
