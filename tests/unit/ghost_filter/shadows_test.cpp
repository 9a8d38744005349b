// What vehicles hide: against rays that are followed one by one, and what the map makes of it.
#include "services/ghost_filter/core/reflector_map/shadows.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "services/ghost_filter/core/mirror/mirror.hpp"
#include "services/ghost_filter/core/reflector_map/reflector_map.hpp"

namespace boresight::ghosts {
namespace {

using Eigen::Vector2d;

struct ShadowingBox {
  Vector2d middle_m, axis;
  double half_length_m, half_width_m;
  [[nodiscard]] bool contains(const Vector2d& p) const {
    const Vector2d q = p - middle_m;
    return std::abs(q.dot(axis)) <= half_length_m && std::abs(axis.x() * q.y() - axis.y() * q.x()) <= half_width_m;
  }
  /// Independent of the corners: in steps of a centimetre.
  [[nodiscard]] bool hides(const Vector2d& from_m, const Vector2d& to_m) const {
    const double length = (to_m - from_m).norm();
    for (double k = 0.0; k < length; k += 0.01) {
      if (contains(from_m + k / length * (to_m - from_m))) return true;
    }
    return false;
  }
};

TEST(Shadows, AreWhatNoRayReaches) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> turn(-M_PI, M_PI), share(-1.0, 1.0);
  std::size_t hidden_places = 0, seen_places = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vector2d eye(3.0 * share(random), 2.0 * share(random));
    const double heading = turn(random);
    const Curve curve{
        {20.0 * share(random), 12.0}, {std::cos(0.1 * heading), std::sin(0.1 * heading)}, 0.01 * share(random)};
    std::vector<ShadowingBox> boxes;
    Shadows shadows;
    shadows.begin(eye);
    for (int k = 0; k < 3; ++k) {
      const double yaw = turn(random);
      boxes.push_back({{25.0 * share(random), 6.0 + 9.0 * share(random)},
                       {std::cos(yaw), std::sin(yaw)},
                       3.0 + 2.0 * share(random),
                       1.0 + 0.3 * share(random)});
      // What the eye is in hides nothing, and what stands across the curve hides and is hidden: neither is asked for.
      const bool is_across = [&] {
        for (double arc = -80.0; arc < 80.0; arc += 0.1) {
          if (boxes.back().contains(curve.at(arc))) return true;
        }
        return boxes.back().contains(eye);
      }();
      if (is_across) {
        boxes.pop_back();
        continue;
      }
      shadows.add(boxes.back().middle_m, boxes.back().axis, boxes.back().half_length_m, boxes.back().half_width_m);
    }
    const HiddenStretches hidden = shadows.on(curve);
    for (double arc = -40.0; arc < 40.0; arc += 0.9) {
      const Vector2d place = curve.at(arc), sight = (place - eye).normalized();
      if (curve.crossings(eye, sight)[0] < (place - eye).norm() - 0.01) continue;  // hidden by the curve itself
      bool is_hidden = false, is_close = false;
      for (const ShadowingBox& box : boxes) {
        const bool here = box.hides(eye, place);
        is_hidden = is_hidden || here;
        is_close =
            is_close || box.hides(eye, curve.at(arc - 0.1)) != here || box.hides(eye, curve.at(arc + 0.1)) != here;
      }
      if (is_close) continue;
      ++(is_hidden ? hidden_places : seen_places);
      EXPECT_EQ(hidden.contains(arc), is_hidden) << "trial " << trial << " arc " << arc;
    }
  }
  EXPECT_GT(hidden_places, 200U);
  EXPECT_GT(seen_places, 1000U);
}

TEST(Shadows, GoOnForEverWhereNoRayPastTheVehicleMeetsTheCurve) {
  Shadows shadows;
  shadows.begin({0.0, 0.0});
  // The ray past its far right corner goes to the right of the wall, and never meets it.
  shadows.add({20.0, 0.5}, {1.0, 0.0}, 2.0, 1.0);
  const Curve wall{{0.0, 6.0}, {1.0, 0.0}, 0.0};
  const HiddenStretches hidden = shadows.on(wall);
  const double first = 6.0 * 18.0 / 1.5;  // past its near left corner
  EXPECT_FALSE(hidden.contains(first - 0.1));
  EXPECT_TRUE(hidden.contains(first + 0.1));
  EXPECT_TRUE(hidden.contains(500.0));
  EXPECT_FALSE(hidden.contains(-20.0));
  EXPECT_DOUBLE_EQ(hidden.after(first + 1.0, 40.0), 40.0);
  EXPECT_DOUBLE_EQ(hidden.before(first + 1.0, 40.0), 1.0);
  // The same wall the other way round.
  const HiddenStretches turned = shadows.on({{0.0, 6.0}, {-1.0, 0.0}, 0.0});
  EXPECT_TRUE(turned.contains(-500.0));
  EXPECT_FALSE(turned.contains(-first + 0.1));
}

TEST(Shadows, OfWhatIsBehindTheCurveOrAroundTheEyeThereAreNone) {
  Shadows shadows;
  shadows.begin({0.0, 0.0});
  shadows.add({5.0, 12.0}, {1.0, 0.0}, 2.0, 1.0);
  shadows.add({1.0, 0.0}, {1.0, 0.0}, 2.5, 1.0);
  const HiddenStretches hidden = shadows.on({{0.0, 6.0}, {1.0, 0.0}, 0.0});
  for (double arc = -100.0; arc < 100.0; arc += 0.5) ASSERT_FALSE(hidden.contains(arc)) << arc;
}

TEST(Shadows, ThoseThatTouchAreOne) {
  HiddenStretches hidden;
  for (const Stretch& s : {Stretch{12.0, 20.0}, Stretch{3.0, 8.0}, Stretch{7.0, 13.0}, Stretch{25.0, 30.0}})
    hidden.add(s);
  EXPECT_DOUBLE_EQ(hidden.after(4.0, 40.0), 16.0);
  EXPECT_DOUBLE_EQ(hidden.after(4.0, 5.0), 5.0);
  EXPECT_DOUBLE_EQ(hidden.before(19.0, 40.0), 16.0);
  EXPECT_DOUBLE_EQ(hidden.after(22.0, 40.0), 0.0);
}

TEST(Shadows, MoreThanThereIsRoomForHideNothing) {
  Shadows shadows;
  shadows.begin({0.0, 0.0});
  for (std::size_t k = 0; k < 2 * Shadows::kMost; ++k)
    shadows.add({0.0, 3.0 + 0.01 * static_cast<double>(k)}, {1.0, 0.0}, 1.0, 0.5);
  EXPECT_TRUE(shadows.on({{0.0, 20.0}, {1.0, 0.0}, 0.0}).contains(0.0));
}

/// Drives along a wall on the left, beside a truck that goes as fast and hides a part of it.
class TruckAlongside {
 public:
  explicit TruckAlongside(bool is_told) : is_told_(is_told) {}
  void drive(double duration_s) {
    constexpr std::int64_t kScan_ns = 25'000'000;
    std::normal_distribution<double> noise(0.0, 0.05);
    const std::int64_t end_ns = time_ns_ + static_cast<std::int64_t>(duration_s * 1e9);
    for (; time_ns_ < end_ns; time_ns_ += kScan_ns) {
      static_cast<void>(odometry.advance(time_ns_, 20.0, 0.0));
      const Vector2d eye = odometry.position_m();
      const ShadowingBox truck{eye + truck_m, {1.0, 0.0}, 8.0, 1.25};
      for (double x = std::floor(eye.x() - 50.0); x < eye.x() + 50.0; x += 1.0) {
        const Vector2d place(x, kWall_m);
        if (has_truck && truck.hides(eye, place)) continue;
        map.add(place + Vector2d(noise(random_), noise(random_)), 0.05 * 0.05, time_ns_);
      }
      map.shadows().begin(eye);
      if (has_truck && is_told_) map.shadows().add(truck.middle_m, truck.axis, truck.half_length_m, truck.half_width_m);
      map.update(odometry, 0.02, 0.0005);
    }
  }
  [[nodiscard]] const Reflector& wall() const {
    const Reflector* longest = &map.reflectors().front();
    for (const Reflector& r : map.reflectors()) {
      if (r.length_m() > longest->length_m()) longest = &r;
    }
    return *longest;
  }
  /// Least of what is beside the own vehicle.
  [[nodiscard]] double least_beside() const {
    double least = 1.0;
    for (double x = -10.0; x <= 10.0; x += 1.0) {
      const double arc = wall().curve.arc(odometry.position_m() + Vector2d(x, kWall_m));
      least = std::min(least, wall().occupancy.probability(arc + wall().arc_shift_m, 0.0));
    }
    return least;
  }
  static constexpr double kWall_m = 9.0;
  ReflectorMap map{MapConfig{}};
  Odometry odometry;
  Vector2d truck_m{0.0, 3.5};
  bool has_truck = false;

 private:
  bool is_told_;
  std::mt19937 random_{5};
  std::int64_t time_ns_ = 1'000'000'000;
};

TEST(ReflectorMap, WhatAVehicleHidesIsNotMissed) {
  for (const bool is_told : {false, true}) {
    TruckAlongside scene(is_told);
    scene.drive(1.0);
    ASSERT_GT(scene.least_beside(), 0.9);
    // It stops beside the wall: what is hidden stays so for long, between what is seen before and behind it.
    scene.has_truck = true;
    scene.truck_m = {0.0, 6.0};
    scene.drive(0.8);
    if (is_told) {
      EXPECT_GT(scene.least_beside(), 0.9);
    } else {
      EXPECT_LT(scene.least_beside(), 0.9) << "nothing else tells that it is hidden";
    }
  }
}

TEST(ReflectorMap, KnowsHowFarBeyondItsEndAWallIsHidden) {
  TruckAlongside scene(true);
  scene.has_truck = true;
  scene.truck_m = {12.0, 3.5};  // from x = 4 on: the wall is seen up to where the ray past its rear comes
  scene.drive(2.0);
  const Reflector& wall = scene.wall();
  const bool along = wall.curve.tangent.x() > 0.0;
  const double end_m =
      (along ? wall.curve.at(wall.end_m()) : wall.curve.at(wall.begin_m())).x() - scene.odometry.position_m().x();
  EXPECT_LT(end_m, 20.0);
  const double hidden_m = along ? wall.hidden_after_m : wall.hidden_before_m;
  EXPECT_GT(hidden_m, 15.0);
  EXPECT_DOUBLE_EQ(along ? wall.hidden_before_m : wall.hidden_after_m, 0.0);
}

TEST(ReflectorMap, AWallRatherGoesOnBehindAVehicleThanInTheOpen) {
  Occupancy occupancy;
  occupancy.reset(-20.0, 20.0, 2.0);
  Mirror wall;
  wall.curve.origin_m = {0.0, 9.0};
  wall.begin_m = occupancy.begin_m();
  wall.end_m = occupancy.end_m();
  wall.existence = 0.9;
  wall.occupancy = &occupancy;
  const double ahead_m = wall.end_m + 15.0, behind_m = wall.begin_m - 15.0;
  const double in_the_open = chance_at(wall, ahead_m, 0.5);
  EXPECT_LT(in_the_open, 0.2);
  wall.hidden_after_m = 20.0;
  EXPECT_GT(chance_at(wall, ahead_m, 0.5), 2.0 * in_the_open);
  EXPECT_EQ(chance_at(wall, wall.end_m + 25.0, 0.5), chance_at(wall, wall.begin_m - 25.0, 0.5)) << "hidden no farther";
  EXPECT_EQ(chance_at(wall, behind_m, 0.5), in_the_open) << "the other end is not";
  occupancy.open(ahead_m, 3.0);
  EXPECT_EQ(chance_at(wall, ahead_m, 0.5), 0.0) << "something drove through";
}

}  // namespace
}  // namespace boresight::ghosts
