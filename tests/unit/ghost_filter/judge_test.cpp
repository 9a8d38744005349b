// What a detection may be, by itself: a wall on the left, a car ahead, and what was detected of both.
#include "services/ghost_filter/core/classify/judge.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::ghosts {

namespace {

using Eigen::Vector2d;

class JudgeTest : public testing::Test {
 protected:
  JudgeTest() {
    Mirror wall;
    wall.curve = {{20.0, 8.0}, {1.0, 0.0}, 0.0};
    wall.covariance = Eigen::Vector3d(1e-3, 1e-6, 1e-8).asDiagonal();
    wall.begin_m = -40.0;
    wall.end_m = 40.0;
    wall.existence = 0.99;
    wall.beam = Beam(wall, sensor_);
    mirrors_.push_back(wall);
    Object car;
    car.position_m = {30.0, 2.0};
    car.half_length_m = 2.2;
    car.half_width_m = 0.9;
    car.velocity_mps = kVelocity;
    car.position_covariance = car.velocity_covariance = 0.01 * Eigen::Matrix2d::Identity();
    car.weight = 0.95;
    objects_.push_back(car);
    sources_.enter_object(0, car.position_m, most_extent(car));
    static_cast<void>(odometry_.advance(1'000'000'000, 15.0, 0.0));
    movers_.forget(0, 0, odometry_);
    begin();
  }
  [[nodiscard]] Surroundings surroundings() const {
    return {sensor_, kOwn, mirrors_, objects_, &sources_, &odometry_, &movers_, &echoes_, &stationary_};
  }
  void begin() { judge_.begin(surroundings()); }
  [[nodiscard]] Measured measured(const Vector2d& place_m, const Vector2d& velocity_mps, double rcs_dbsm) const {
    Measured m{};
    m.position_m = place_m;
    m.range_m = (place_m - sensor_).norm();
    m.direction = (place_m - sensor_) / m.range_m;
    m.rate_mps = m.direction.dot(velocity_mps);
    m.range_std_m = 0.1;
    m.azimuth_std_rad = 0.004;
    m.rate_std_mps = 0.05;
    m.still_std_mps = 0.1;
    m.rcs_dbsm = rcs_dbsm;
    return m;
  }
  /// What was detected of it directly, in the same scan.
  void hear(const Measured& m, std::uint32_t index, std::uint32_t object) {
    echoes_.add({m.direction, m.range_m, m.range_std_m * m.range_std_m, m.azimuth_std_rad * m.azimuth_std_rad,
                 m.rate_mps, m.rcs_dbsm, 1.0, index, object});
  }
  /// Out by the wall, back directly from the car's end that the sensor sees.
  [[nodiscard]] Measured detour(double rcs_dbsm = -12.0) const {
    const Vector2d end(27.8, 2.0), image(27.8, 14.0);
    const double direct_m = (end - sensor_).norm(), far_m = (image - sensor_).norm();
    const Vector2d e = (end - sensor_) / direct_m, u = (image - sensor_) / far_m, d(u.x(), -u.y());
    Measured m = measured(sensor_ + 0.5 * (direct_m + far_m) * e, {0.0, 0.0}, rcs_dbsm);
    m.rate_mps = 0.5 * ((e + d).dot(kVelocity) + (e - u).dot(Vector2d(15.0, 0.0)));
    return m;
  }
  /// The car's end that the sensor sees, and its image by three bounces.
  [[nodiscard]] Measured of_car() const { return measured({27.8, 2.0}, kVelocity, 5.0); }
  [[nodiscard]] Measured image() const { return measured({27.8, 14.0}, kVelocity, -21.0); }
  static void expect_same(const Densities& a, const Densities& b) {
    EXPECT_EQ(a.moving, b.moving);
    EXPECT_EQ(a.stationary, b.stationary);
    EXPECT_EQ(a.type1, b.type1);
    EXPECT_EQ(a.type2, b.type2);
    EXPECT_EQ(a.clutter, b.clutter);
  }
  static inline const Vector2d kOwn{15.0, 0.0}, kVelocity{20.0, 0.0};
  Vector2d sensor_{3.6, 0.0};
  std::vector<Mirror> mirrors_;
  std::vector<Object> objects_;
  SourceMap sources_;
  Odometry odometry_;
  RecentMovers movers_;
  DirectEchoes echoes_{64};
  StationaryGrid stationary_{64, 0.5};
  Judge judge_{ClassConfig{}};
};

}  // namespace

TEST_F(JudgeTest, TheImageIsAGhostBeyondDoubtAndTheCarIsNone) {
  const Densities car = judge_.weigh(of_car(), 0), ghost = judge_.weigh(image(), 1);
  EXPECT_GT(car.moving, 20.0 * (car.sum() - car.moving));
  EXPECT_GT(ghost.type2, 20.0 * (ghost.moving + ghost.stationary + ghost.clutter));
  EXPECT_GT(ghost.type2, ghost.type1);
}

TEST_F(JudgeTest, TheOrderOfMirrorsTellsNothing) {
  const auto add_wall = [&](double offset_m, double existence) {
    mirrors_.push_back(mirrors_.front());
    mirrors_.back().curve.origin_m.y() = offset_m;
    mirrors_.back().existence = existence;
    mirrors_.back().beam = Beam(mirrors_.back(), sensor_);
  };
  add_wall(-20.0, 0.9);
  add_wall(11.0, 0.6);
  add_wall(-7.0, 0.1);  // hardly there
  // Out by the wall on the right, back by that on the left, where the car's image is.
  const Vector2d end(27.8, 2.0), back(27.8, 14.0), out(3.6, -40.0);
  Measured by_both = measured(back, {0.0, 0.0}, -21.0);
  const Vector2d d(by_both.direction.x(), -by_both.direction.y()), e = (end - out).normalized(), u(e.x(), -e.y());
  by_both.range_m = 0.5 * (by_both.range_m + (end - out).norm());
  by_both.position_m = sensor_ + by_both.range_m * by_both.direction;
  by_both.rate_mps = 0.5 * ((d + e).dot(kVelocity) + (by_both.direction - u).dot(kOwn));
  hear(of_car(), 0, 0);
  const auto weigh_all = [&] {
    begin();
    return std::array{judge_.weigh(of_car(), 0), judge_.weigh(image(), 1), judge_.weigh(detour(), 2),
                      judge_.weigh(by_both, 3)};
  };
  const auto before = weigh_all();
  EXPECT_GT(before[1].type2, before[1].moving);
  EXPECT_GT(before[2].type1, before[2].moving);
  EXPECT_GT(before[3].type2, 3.0 * before[3].moving);
  std::reverse(mirrors_.begin(), mirrors_.end());
  const auto after = weigh_all();
  for (std::size_t i = 0; i < before.size(); ++i) expect_same(before[i], after[i]);
}

TEST_F(JudgeTest, WhatIsLongerThanACarIsDetectedMoreOften) {
  ClassConfig alike;
  alike.real_per_truck = alike.real_per_object;
  Judge without(alike);
  const auto more = [&](double length_m) {
    objects_[0].half_length_m = 0.5 * length_m;
    begin();
    without.begin(surroundings());
    const Measured rear = measured({30.0 - 0.5 * length_m, 2.0}, kVelocity, 5.0);
    return judge_.weigh(rear, 0).moving / without.weigh(rear, 0).moving;
  };
  EXPECT_EQ(more(4.5), 1.0);
  EXPECT_NEAR(more(5.0), 2.0, 0.01);
  EXPECT_NEAR(more(12.0), 3.0, 0.01);
}

TEST_F(JudgeTest, AMetreOfALongTruckShowsAsMuchAsOneOfAShortTruck) {
  const auto at_rear = [&](double length_m) {
    objects_[0].half_length_m = 0.5 * length_m;
    objects_[0].position_m = {26.0 + 0.5 * length_m, 2.0};
    begin();
    return judge_.weigh(measured({26.0, 2.0}, kVelocity, 5.0), 0).moving;
  };
  // The share of the rear falls as the flank grows: (1.8 + 8) / (1.8 + 16) of it is left, of twice as many detections.
  EXPECT_NEAR(at_rear(16.0) / at_rear(8.0), 1.1, 0.15);
}

TEST_F(JudgeTest, WhatStandsInFrontIsFoundOnceWhoeverAsksFirst) {
  const Densities car = judge_.weigh(of_car(), 4), ghost = judge_.weigh(image(), 7);
  EXPECT_EQ(judge_.behind_mirror(of_car(), 4), 0.0);
  EXPECT_GT(judge_.behind_mirror(image(), 7), 0.9);
  expect_same(judge_.weigh(of_car(), 4), car);
  expect_same(judge_.weigh(image(), 7), ghost);
  // All that was kept is used up.
  expect_same(judge_.weigh(image(), 7), ghost);
}

TEST_F(JudgeTest, WhatWasNotAskedForInOrderIsFoundAgain) {
  const Densities ghost = judge_.weigh(image(), 7);
  EXPECT_EQ(judge_.behind_mirror(of_car(), 4), 0.0);
  EXPECT_GT(judge_.behind_mirror(image(), 7), 0.9);
  expect_same(judge_.weigh(image(), 7), ghost);
}

TEST_F(JudgeTest, WhatLiesBehindAStrongerEchoAtTheLengthOfADetourIsAGhost) {
  hear(of_car(), 0, 0);
  const Densities ghost = judge_.weigh(detour(), 1);
  EXPECT_GT(ghost.type1, 5.0 * (ghost.sum() - ghost.type1));
  const Densities car = judge_.weigh(of_car(), 0);
  EXPECT_LT(car.type1, 0.01 * car.moving) << "its own echo is not in front of it";
}

TEST_F(JudgeTest, WithoutAnEchoInFrontOrBehindAWeakerOneNothingIsAType1Ghost) {
  // Where the car reflects to by the wall, it reflects directly as well.
  EXPECT_EQ(judge_.weigh(detour(), 1).type1, 0.0);
  hear(measured({27.8, 2.0}, kVelocity, -15.0), 0, 0);
  EXPECT_EQ(judge_.weigh(detour(), 1).type1, 0.0);
}

TEST_F(JudgeTest, AnEchoOfWhatIsNotTrackedIsInFrontAsWell) {
  hear(of_car(), 0, kNobody);
  const Densities ghost = judge_.weigh(detour(), 1);
  EXPECT_GT(ghost.type1, 0.1 * judge_.weigh(detour(), 1).sum());
  // Elsewhere than the length of a detour it is another part of what reflects there.
  Measured other = detour();
  other.position_m += 12.0 * other.direction;
  other.range_m += 12.0;
  EXPECT_LT(judge_.weigh(other, 1).type1, 0.01 * ghost.type1);
}

TEST_F(JudgeTest, WhatShowsNoRangeRateDirectlyNeedsNoEcho) {
  // Across the line of sight: its own echo looks as if it stood, and is none of a moving detection.
  const Vector2d sight = (objects_[0].position_m - sensor_).normalized();
  objects_[0].velocity_mps = {-6.0 * sight.y(), 6.0 * sight.x()};
  begin();
  Measured m = detour();
  const Vector2d end(27.8, 2.0), image(27.8, 14.0);
  const Vector2d e = (end - sensor_).normalized(), u = (image - sensor_).normalized(), d(u.x(), -u.y());
  m.rate_mps = 0.5 * ((e + d).dot(objects_[0].velocity_mps) + (e - u).dot(Vector2d(15.0, 0.0)));
  EXPECT_GT(judge_.weigh(m, 1).type1, 0.0);
}

/// The wall on the left at 8 m, another one on the right at 10 m, and the car beside the sensor.
class AlongsideTest : public JudgeTest {
 protected:
  AlongsideTest() {
    Mirror right = mirrors_[0];
    right.curve.origin_m.y() = -10.0;
    // Walls are of the map; they are seen all along.
    seen_.reset(-40.0, 40.0, 0.5);
    for (int times = 0; times < 20; ++times) {
      for (double arc = -40.0; arc <= 40.0; arc += 0.25) seen_.hit(arc);
      seen_.settle();
    }
    mirrors_[0].occupancy = right.occupancy = &seen_;
    right.beam = Beam(right, sensor_);
    mirrors_.push_back(right);
    objects_[0].position_m = {3.6, 3.5};
    objects_[0].velocity_mps = kOwn;
    objects_[0].sectors = sectors_about(objects_[0].position_m - sensor_, 4.0);
    sources_.clear();
    sources_.enter_object(0, objects_[0].position_m, most_extent(objects_[0]));
  }
  Occupancy seen_;
};

TEST_F(AlongsideTest, BetweenTwoWallsItHasGhostsThatLookStill) {
  const auto weigh = [&](double range_m) {
    begin();
    return judge_.weigh_still(measured({3.6, range_m}, {0.0, 0.0}, -18.0));
  };
  // The flank at 2.6 m; by the left wall and the right one: 8 + 18 + 12.6 m to it, 2.6 m back.
  const double by_both_m = 0.5 * (8.0 + 18.0 + 12.6 + 2.6);
  const Densities ghost = weigh(by_both_m), other = weigh(by_both_m + 6.0);
  EXPECT_GT(ghost.type1, 0.2 * ghost.stationary);
  EXPECT_LT(other.type1, 0.01 * ghost.type1);
  // It takes both.
  mirrors_.pop_back();
  EXPECT_LT(weigh(by_both_m).type1, 0.01 * ghost.type1);
}

TEST_F(AlongsideTest, BetweenTwoWallsItHasGhostsThatMoveToo) {
  // Its front corner is 2 m ahead: there it has a range rate. Both walls' images of the sensor are at y = 8 + 18 + 10.
  const Vector2d corner(5.6, 2.6), image(3.6, -36.0);
  const double direct_m = (corner - sensor_).norm(), far_m = (corner - image).norm();
  const Vector2d e = (corner - sensor_) / direct_m, d = (corner - image) / far_m;
  Measured m = measured(sensor_ + 0.5 * (direct_m + far_m) * e, {0.0, 0.0}, -18.0);
  m.rate_mps = 0.5 * ((e + d).dot(kOwn) + (e - d).dot(kOwn));  // twice turned at walls along x, it leaves as it arrives
  hear(measured(corner, kOwn, 8.0), 0, 0);
  begin();
  const Densities ghost = judge_.weigh(m, 1);
  EXPECT_GT(ghost.type1, 3.0 * (ghost.sum() - ghost.type1));
  m.rate_mps += 3.0;
  begin();
  EXPECT_LT(judge_.weigh(m, 1).type1, 0.01 * ghost.type1) << "not with any range rate";
  m.rate_mps -= 3.0;
  mirrors_.pop_back();
  begin();
  EXPECT_LT(judge_.weigh(m, 1).type1, 0.01 * ghost.type1) << "it takes both";
}

TEST_F(JudgeTest, WhatDrivesBehindLightsNothingThatIsSeenAhead) {
  // A wall across the road; out by it, and back directly from behind the radar, which does not look there.
  Mirror& wall = mirrors_.front();
  wall.curve = {{58.0, 0.0}, {0.0, 1.0}, 0.0};
  wall.beam = Beam(wall, sensor_);
  const auto type2_with = [&](double x_m, double range_m, double rate_mps) {
    objects_[0].position_m = {x_m, 0.0};
    sources_.clear();
    sources_.enter_object(0, objects_[0].position_m, most_extent(objects_[0]));
    begin();
    Measured m = measured(sensor_ + range_m * Vector2d(1.0, 0.0), {0.0, 0.0}, -8.0);
    m.rate_mps = rate_mps;
    return judge_.weigh(m, 0).type2;
  };
  const double out_m = 58.0 - 3.6, behind_m = 41.0 + 3.6;
  const double nothing = type2_with(1000.0, out_m + behind_m, -5.0);
  EXPECT_LT(type2_with(-41.0, out_m + behind_m, -5.0), 1.1 * nothing);
  // By the wall out and back it is seen in it.
  EXPECT_GT(type2_with(-41.0, out_m + 58.0 + 38.8, -20.0), 100.0 * nothing);
}

TEST_F(JudgeTest, WhatStandsWhereNothingElseCanBeIsThatAlone) {
  const Densities alone = judge_.weigh_still(measured({-30.0, -20.0}, {0.0, 0.0}, 0.0));
  EXPECT_GT(alone.stationary, 0.0);
  EXPECT_EQ(alone.sum(), alone.stationary);
}

}  // namespace boresight::ghosts
