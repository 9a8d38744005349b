// Ghosts in random scenes agree with a reference that uses no mirror images. The reference finds the shortest path over
// points of the mirrors (Fermat's principle) by bisection, and the derivative of its length by a small step in time.
#include <algorithm>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/simulator/random.hpp"
#include "tests/unit/simulator/radar/bench_scene.hpp"

namespace boresight::simulator {
namespace {

constexpr std::uint32_t kTruck = 50, kCar = 9;
constexpr double kEdge_m = 0.05;  // paths nearer to an edge are not compared

/// A vertical plane that moves and rotates, as a function of time.
struct Plane {
  Eigen::Vector2d middle_m, velocity_mps;
  double heading_rad, yaw_rate_radps, half_m, low_m, high_m;
  double outer;  // +1: mirrors on its left face only; 0: on both faces

  [[nodiscard]] Eigen::Vector2d along(double t) const {
    const double heading = heading_rad + yaw_rate_radps * t;
    return {std::cos(heading), std::sin(heading)};
  }
  [[nodiscard]] Eigen::Vector2d at(double t, double s) const { return middle_m + t * velocity_mps + s * along(t); }
  [[nodiscard]] double side(double t, const Eigen::Vector2d& p) const {
    const Eigen::Vector2d u = along(t), d = p - middle_m - t * velocity_mps;
    return u.x() * d.y() - u.y() * d.x();
  }
};

/// All moving things, as functions of time.
struct Example {
  std::vector<Plane> planes;  // the wall, the truck's side
  Eigen::Vector2d ego_m, target_m, target_velocity_mps;
  double ego_heading_rad, ego_speed_mps, ego_yaw_rate_radps, target_height_m;
  Eigen::Vector2d mount_m;

  explicit Example(Stream& draw) {
    const auto any = [&](double from, double to) { return draw.uniform(from, to); };
    ego_m = {any(-5.0, 5.0), any(-5.0, 5.0)};
    ego_heading_rad = any(-3.0, 3.0);
    ego_speed_mps = any(-5.0, 30.0);
    ego_yaw_rate_radps = any(-0.4, 0.4);
    mount_m = {any(-1.0, 4.0), any(-1.0, 1.0)};
    target_m = {any(-40.0, 40.0), any(-40.0, 40.0)};
    target_velocity_mps = {any(-25.0, 25.0), any(-25.0, 25.0)};
    target_height_m = any(0.3, 1.5);
    planes.push_back({{any(-30.0, 30.0), any(-30.0, 30.0)},
                      {0.0, 0.0},
                      any(-3.0, 3.0),
                      0.0,
                      any(5.0, 60.0),
                      any(0.0, 0.4),
                      any(0.7, 3.0),
                      0.0});
    planes.push_back({{any(-30.0, 30.0), any(-30.0, 30.0)},
                      {any(-20.0, 20.0), any(-20.0, 20.0)},
                      any(-3.0, 3.0),
                      any(-0.5, 0.5),
                      any(5.0, 40.0),
                      any(0.0, 0.4),
                      any(0.7, 3.0),
                      1.0});
  }
  [[nodiscard]] Eigen::Vector2d sensor(double t) const {
    // Motion on an arc, exact to second order; a central difference needs no more.
    const double middle = ego_heading_rad + 0.5 * ego_yaw_rate_radps * t,
                 now = ego_heading_rad + ego_yaw_rate_radps * t;
    const Eigen::Vector2d ahead(std::cos(now), std::sin(now)), left(-ahead.y(), ahead.x());
    return ego_m + t * ego_speed_mps * Eigen::Vector2d(std::cos(middle), std::sin(middle)) + mount_m.x() * ahead +
           mount_m.y() * left;
  }
  [[nodiscard]] Eigen::Vector2d target(double t) const { return target_m + t * target_velocity_mps; }
};

/// Specular point on the line of the shortest path from a to b: there the derivative of a convex sum rises through
/// zero.
double shortest(const Plane& plane, double t, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const auto slope = [&](double s) {
    const Eigen::Vector2d p = plane.at(t, s);
    return plane.along(t).dot((p - a).normalized() + (p - b).normalized());
  };
  double low = -2000.0, high = 2000.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (slope(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Specular points of the path from the sensor over these planes, in this order, to the target.
std::vector<Eigen::Vector2d> corners(const Example& e, const std::vector<std::size_t>& order, double t) {
  const Eigen::Vector2d from = e.sensor(t), to = e.target(t);
  if (order.empty()) return {from, to};
  if (order.size() == 1) return {from, e.planes[order[0]].at(t, shortest(e.planes[order[0]], t, from, to)), to};
  // On the shortest path over both planes, the derivative of the length by the first point is zero, with the best
  // second point for it.
  const Plane &first = e.planes[order[0]], &second = e.planes[order[1]];
  const auto best_second = [&](const Eigen::Vector2d& p) { return second.at(t, shortest(second, t, p, to)); };
  double low = -2000.0, high = 2000.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const Eigen::Vector2d p = first.at(t, middle), q = best_second(p);
    (first.along(t).dot((p - from).normalized() + (p - q).normalized()) < 0.0 ? low : high) = middle;
  }
  const Eigen::Vector2d p = first.at(t, 0.5 * (low + high));
  return {from, p, best_second(p), to};
}

double length(const Example& e, const std::vector<Eigen::Vector2d>& way) {
  double flat = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) flat += (way[i] - way[i - 1]).norm();
  return std::hypot(flat, e.target_height_m - kHeight_m);
}

struct Way {
  double length_m, rate_mps;
  Eigen::Vector2d leaves;  // towards the first corner
  unsigned mirrors;
  std::uint32_t first_body;
};

enum class Is { kThere, kNotThere, kTooClose };

/// Whether each specular point lies on its plane, and the path arrives and leaves on a mirroring face.
Is judge(const Example& e, const std::vector<std::size_t>& order, const std::vector<Eigen::Vector2d>& way) {
  double margin = 1e9;
  double travelled = 0.0, whole = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) whole += (way[i] - way[i - 1]).norm();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Plane& plane = e.planes[order[i]];
    travelled += (way[i + 1] - way[i]).norm();
    const double z = kHeight_m + travelled / whole * (e.target_height_m - kHeight_m);
    const double from = plane.side(0.0, way[i]), to = plane.side(0.0, way[i + 2]);
    const double sign = from > 0.0 ? 1.0 : -1.0;
    margin = std::min({margin, plane.half_m - (way[i + 1] - plane.middle_m).norm(), plane.high_m - z, z - plane.low_m,
                       sign * from, sign * to});
    if (plane.outer != 0.0) margin = std::min(margin, plane.outer * from);
  }
  return std::abs(margin) < kEdge_m ? Is::kTooClose : margin > 0.0 ? Is::kThere : Is::kNotThere;
}

/// All paths; nothing if a path is too close to an edge to decide.
std::optional<std::vector<Way>> ways(const Example& e) {
  std::vector<Way> ways;
  for (const std::vector<std::size_t>& order : {std::vector<std::size_t>{}, {0}, {1}, {0, 1}, {1, 0}}) {
    const auto now = corners(e, order, 0.0);
    switch (judge(e, order, now)) {
      case Is::kTooClose:
        return std::nullopt;
      case Is::kNotThere:
        continue;
      case Is::kThere:
        break;
    }
    constexpr double kStep_s = 1e-4;
    const double rate =
        (length(e, corners(e, order, kStep_s)) - length(e, corners(e, order, -kStep_s))) / (2.0 * kStep_s);
    const bool truck_first = !order.empty() && order.front() == 1;
    ways.push_back({length(e, now), rate, (now[1] - now[0]).normalized(), static_cast<unsigned>(order.size()),
                    truck_first ? kTruck : 0});
  }
  return ways;
}

Bench bench_of(const Example& e) {
  Bench bench;
  bench.ego_body = {-100.0, -99.0, 0.1, 0.15, 0.2};  // the ego vehicle hides nothing
  bench.config.mounting_pose.position_m = {e.mount_m.x(), e.mount_m.y(), kHeight_m};
  bench.config.field_of_view = {-3.2, 3.2, -1.6, 1.6, 300.0};
  bench.effects.unambiguous_mps = 0.0;
  bench.effects.multipath.bistatic_rad = 0.0;
  bench.scene.ego = {e.ego_m, e.ego_heading_rad, e.ego_speed_mps, 0.0, e.ego_yaw_rate_radps};
  Body& car = bench.add_body(kCar, {e.target_m.x(), e.target_m.y(), e.target_height_m},
                             {e.target_velocity_mps.x(), e.target_velocity_mps.y(), 0.0});
  car.length_m = car.width_m = 1e-3;  // hides nothing
  const Plane& side = e.planes[1];
  const Eigen::Vector2d u = side.along(0.0);
  // The truck's body lies to the right of its side. The velocity of its centre is chosen for that of the side's middle.
  const Eigen::Vector2d arm = Eigen::Vector2d(u.y(), -u.x());
  Body& truck = bench.add_body(kTruck, {side.middle_m.x() + arm.x(), side.middle_m.y() + arm.y(), 2.0}, {0, 0, 0});
  truck.velocity_mps = side.velocity_mps + side.yaw_rate_radps * Eigen::Vector2d(-arm.y(), arm.x());
  truck.yaw_rate_radps = side.yaw_rate_radps;
  truck.length_m = truck.width_m = 1e-3;
  truck.number_of_centres = 0;
  bench.scene.centres.pop_back();
  const auto add = [&](const Plane& p, std::uint32_t body) {
    bench.scene.surfaces.push_back(
        {p.at(0.0, -p.half_m), p.at(0.0, p.half_m), p.low_m, p.high_m, 3.0, p.velocity_mps, body, false});
  };
  add(e.planes[0], 0);
  add(e.planes[1], kTruck);
  return bench;
}

TEST(RayReference, EveryGhostHasTheLengthDirectionAndRateOfTheShortestPath) {
  Stream draw(2026, "rays");
  std::size_t scenes = 0, moving_mirror = 0;
  std::map<std::pair<Provenance, unsigned>, std::size_t> compared;
  for (int trial = 0; trial < 4000; ++trial) {
    const Example e(draw);
    const std::optional<std::vector<Way>> found = ways(e);
    if (!found || (e.sensor(0.0) - e.target(0.0)).norm() < 2.0) continue;
    ++scenes;
    const Bench bench = bench_of(e);
    const Measured m = measure(bench);
    std::vector<bool> taken(m.count(), false);
    std::size_t expected = 0;
    for (const Way& out : *found) {
      for (const Way& back : *found) {
        if (out.mirrors + back.mirrors > 2) continue;  // three bounces, the target's included
        ++expected;
        const double range = 0.5 * (out.length_m + back.length_m), rate = 0.5 * (out.rate_mps + back.rate_mps);
        const double azimuth =
            std::remainder(std::atan2(back.leaves.y(), back.leaves.x()) - e.ego_heading_rad, 2.0 * M_PI);
        const Provenance kind = back.mirrors > 0  ? Provenance::kGhostType2
                                : out.mirrors > 0 ? Provenance::kGhostType1
                                                  : Provenance::kMoving;
        const std::uint32_t mirror = back.mirrors > 0 ? back.first_body : out.mirrors > 0 ? out.first_body : 0;
        bool is_there = false;
        for (std::size_t i = 0; i < m.count() && !is_there; ++i) {
          is_there = !taken[i] && m.truth[i].provenance == kind && m.truth[i].bounces == out.mirrors + back.mirrors &&
                     m.truth[i].mirror_body == mirror && std::abs(m.scan->range_m[i] - range) < 5e-5 &&
                     std::abs(std::remainder(m.scan->azimuth_rad[i] - azimuth, 2.0 * M_PI)) < 2e-6 &&
                     std::abs(m.scan->range_rate_mps[i] - rate) < 2e-4;
          if (is_there) taken[i] = true;
        }
        ASSERT_TRUE(is_there) << "trial " << trial << ": " << out.mirrors << " out, " << back.mirrors << " back, range "
                              << range << ", azimuth " << azimuth << ", rate " << rate << " of " << m.count();
        ++compared[{kind, out.mirrors + back.mirrors}];
        moving_mirror += mirror == kTruck ? 1 : 0;
      }
    }
    ASSERT_EQ(m.count(), expected) << "trial " << trial << ": ghosts without a path in the reference";
  }
  EXPECT_GT(scenes, 2000u);
  EXPECT_GT(moving_mirror, 500u);
  for (const auto& [kind, bounces] : {std::pair{Provenance::kGhostType1, 1u},
                                      {Provenance::kGhostType1, 2u},
                                      {Provenance::kGhostType2, 1u},
                                      {Provenance::kGhostType2, 2u}}) {
    EXPECT_GT((compared[{kind, bounces}]), 50u) << static_cast<int>(kind) << ", " << bounces;
  }
}

/// Boxes and sheets in a scene, tested point by point along the line of sight.
TEST(RayReference, ATargetIsHiddenExactlyIfItsLineOfSightIsBlocked) {
  Stream draw(7, "occlusion");
  const auto any = [&](double from, double to) { return draw.uniform(from, to); };
  std::size_t hidden = 0, clear = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Scene scene;
    Body body{};
    body.id = 3;
    body.position_m = {any(-10.0, 10.0), any(-10.0, 10.0)};
    body.heading_rad = any(-3.0, 3.0);
    body.length_m = any(1.0, 12.0);
    body.width_m = any(0.5, 3.0);
    body.clearance_m = any(0.0, 0.5);
    body.height_m = any(1.0, 4.0);
    scene.bodies.push_back(body);
    const Eigen::Vector2d a(any(-10.0, 10.0), any(-10.0, 10.0)), b(any(-10.0, 10.0), any(-10.0, 10.0));
    scene.surfaces.push_back({a, b, any(0.0, 0.5), any(0.6, 3.0), 3.0, {0.0, 0.0}, 0, true});
    const MirrorSurface& sheet = scene.surfaces.front();
    const Eigen::Vector3d from(any(-20.0, 20.0), any(-20.0, 20.0), any(0.2, 2.0)),
        to(any(-20.0, 20.0), any(-20.0, 20.0), any(0.2, 5.0));
    radar::Occlusion occlusion;
    occlusion.prepare(scene, {0.0, 0.0}, 100.0, radar::EgoBox{{-99.0, -99.0}, {-98.0, -98.0}, 0.1, 0.2});
    // In small steps: a point inside the box shrunk by 3 cm is hidden, a point outside the box grown by 3 cm is not.
    bool surely_in = false, maybe_in = false;
    constexpr int kSteps = 6000;
    double across_before = 0.0;
    for (int i = 0; i <= kSteps; ++i) {
      const Eigen::Vector3d p = from + static_cast<double>(i) / kSteps * (to - from);
      const Eigen::Vector2d d = p.head<2>() - body.position_m;
      const double c = std::cos(body.heading_rad), s = std::sin(body.heading_rad);
      const double beyond = std::max({std::abs(c * d.x() + s * d.y()) - 0.5 * body.length_m,
                                      std::abs(-s * d.x() + c * d.y()) - 0.5 * body.width_m, p.z() - body.height_m,
                                      body.clearance_m - p.z()});
      surely_in |= beyond < -0.03;
      maybe_in |= beyond < 0.03;
      const Eigen::Vector2d along = b - a, e = p.head<2>() - a;
      const double across = (along.x() * e.y() - along.y() * e.x()) / along.norm();
      if (i > 0 && across * across_before <= 0.0) {
        const double u = e.dot(along) / along.norm();
        const double inside = std::min({u, along.norm() - u, p.z() - sheet.low_m, sheet.high_m - p.z()});
        const double ends = std::min(std::abs((along.x() * (from - Eigen::Vector3d(a.x(), a.y(), 0)).y() -
                                               along.y() * (from - Eigen::Vector3d(a.x(), a.y(), 0)).x()) /
                                              along.norm()),
                                     std::abs((along.x() * (to - Eigen::Vector3d(a.x(), a.y(), 0)).y() -
                                               along.y() * (to - Eigen::Vector3d(a.x(), a.y(), 0)).x()) /
                                              along.norm()));
        surely_in |= inside > 0.05 && ends > 0.1;
        maybe_in |= inside > -0.05;
      }
      across_before = across;
    }
    const bool is_clear = occlusion.clear(from, to);
    if (surely_in) {
      ASSERT_FALSE(is_clear) << trial;
      ++hidden;
    } else if (!maybe_in) {
      ASSERT_TRUE(is_clear) << trial;
      ++clear;
    }
  }
  EXPECT_GT(hidden, 300u);
  EXPECT_GT(clear, 500u);
}

}  // namespace
}  // namespace boresight::simulator
