// Whether reflectors mirror, told by what is seen in them.
#include "services/ghost_filter/core/classify/mirror_trials.hpp"

#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "services/ghost_filter/core/mirror/image.hpp"
#include "tests/unit/ghost_filter/mirror_scene.hpp"

namespace boresight::ghosts {
namespace {

TEST(ImageOf, IsTheShortestWayByTheMirror) {
  // By Fermat's principle, as far as the mirror does not bend towards sensor and target.
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-40.0, 40.0), height(1.0, 30.0), bend(-0.01, 0.0), turn(-3.1, 3.1);
  std::size_t found = 0, none = 0;
  for (int run = 0; run < 2000; ++run) {
    Mirror m;
    m.begin_m = -20.0;
    m.end_m = 20.0;
    const Eigen::Rotation2Dd rotation(turn(random));
    m.curve = {rotation * Vector2d(3.0, -2.0), rotation * Vector2d(1.0, 0.0), run % 2 == 0 ? 0.0 : bend(random)};
    const Vector2d sensor = m.curve.origin_m + rotation * Vector2d(place(random), height(random));
    const Vector2d target = m.curve.origin_m + rotation * Vector2d(place(random), height(random));
    double shortest = 1e9, at = 0.0;
    for (double arc = m.begin_m; arc <= m.end_m; arc += 0.01) {
      const Vector2d w = m.curve.at(arc);
      const double way = (w - sensor).norm() + (target - w).norm();
      if (way < shortest) {
        shortest = way;
        at = arc;
      }
    }
    const auto image = image_of(m, sensor, target);
    if (std::abs(at) > 19.98) {
      EXPECT_FALSE(image && std::abs(image->arc_m) < 19.5) << "run " << run;
      ++none;
      continue;
    }
    if (std::abs(at) > 19.5) continue;
    ASSERT_TRUE(image) << "run " << run;
    ++found;
    EXPECT_NEAR(image->first_m + image->second_m, shortest, 0.01);
    EXPECT_NEAR((sensor + image->first_m * image->departure + image->second_m * image->arrival - target).norm(), 0.0,
                1e-9);
  }
  EXPECT_GT(found, 500U);
  EXPECT_GT(none, 200U);
}

TEST(ImageOf, IsNoneOnTheOtherSide) {
  Mirror m;
  m.begin_m = -20.0;
  m.end_m = 20.0;
  EXPECT_TRUE(image_of(m, {0.0, 5.0}, {10.0, 3.0}));
  EXPECT_FALSE(image_of(m, {0.0, 5.0}, {10.0, -3.0}));
  EXPECT_FALSE(image_of(m, {0.0, 5.0}, {10.0, 0.0}));
}

TEST(MirrorsByLength, IsTheLikelierTheLonger) {
  EXPECT_LT(mirrors_by_length(8.0, 5.0), -2.5);
  EXPECT_GT(mirrors_by_length(100.0, 5.0), 2.0);
  EXPECT_GT(mirrors_by_length(8.0, 0.1), 0.0) << "the first piece of a rail";
  for (double length = 5.0; length < 200.0; length += 5.0) {
    EXPECT_LE(mirrors_by_length(length, 5.0), mirrors_by_length(length + 5.0, 5.0));
  }
}

/// A wall on the left and a car ahead, all turned by an angle about the vehicle.
class MirrorTrialsTest : public testing::TestWithParam<double> {
 protected:
  MirrorTrialsTest() {
    wall_.curve = {turned({20.0, 8.0}), turned({1.0, 0.0}), 0.0};
    wall_.begin_m = -40.0;
    wall_.end_m = 40.0;
    occupancy_.reset(-40.0, 40.0, 2.0);
    for (int k = 0; k < 6; ++k) {
      for (double arc = -39.0; arc < 40.0; arc += 1.0) occupancy_.hit(arc);
      occupancy_.settle();
    }
    wall_.occupancy = &occupancy_;
    Object car;
    car.position_m = turned({30.0, 2.0});
    car.axis = turned({1.0, 0.0});
    car.half_length_m = 2.2;
    car.half_width_m = 0.9;
    car.velocity_mps = turned({20.0, 0.0});
    car.weight = 0.95;
    objects_.push_back(car);
    static_cast<void>(odometry_.advance(1'000'000'000, 0.0, 0.0));
    movers_.forget(0, 0, odometry_);
    trials_.begin();
    for (double azimuth = -3.14; azimuth < 3.14; azimuth += 0.02) {
      trials_.saw({std::cos(azimuth), std::sin(azimuth)}, 100.0);
    }
  }
  [[nodiscard]] Vector2d turned(const Vector2d& v) const { return Eigen::Rotation2Dd(GetParam()) * v; }
  /// Behind the wall, as by three bounces.
  void show_image(double rate_off_mps = 0.0, std::uint32_t of_object = kNobody) {
    const Vector2d p = turned({30.0, 14.0}), sight = p - sensor_;
    movers_.add({p, sight.normalized(), sight.normalized().dot(turned({20.0, 0.0})) + rate_off_mps, 0.1, 1.0,
                 1'000'000'000, 0, 0.0, of_object},
                odometry_);
  }
  [[nodiscard]] double evidence() const {
    return trials_.evidence_of(wall_,
                               {sensor_, turned({15.0, 0.0}), mounting_std_rad_, objects_, &odometry_, &movers_});
  }
  Vector2d sensor_ = turned({3.6, 0.0});
  double mounting_std_rad_ = 0.002;
  Mirror wall_;
  Occupancy occupancy_;
  std::vector<Object> objects_;
  Odometry odometry_;
  RecentMovers movers_;
  MirrorTrials trials_;
};

TEST_P(MirrorTrialsTest, AnImageSpeaksForItAndItsAbsenceAgainst) {
  const double absent = evidence();
  EXPECT_LT(absent, 0.0);
  show_image();
  EXPECT_GT(evidence(), -2.0 * absent) << "one that is there tells more than one that is not";
}

TEST_P(MirrorTrialsTest, WhatMovesOtherwiseOrIsOfAnotherObjectIsNoImage) {
  show_image(4.0);
  show_image(0.0, 0);
  EXPECT_LT(evidence(), 0.0);
}

TEST_P(MirrorTrialsTest, WhereNothingCanBeSeenNothingIsTold) {
  EXPECT_NE(evidence(), 0.0);
  const auto with = [&](const Object& other) {
    objects_.push_back(other);
    const double told = evidence();
    objects_.pop_back();
    return told;
  };
  Object other = objects_.front();
  other.own = false;
  other.moving = 0.0;  // it is not looked for itself
  other.position_m = turned({14.0, 5.0});
  EXPECT_EQ(with(other), 0.0) << "it hides the mirror";
  other.position_m = turned({28.0, 17.0});
  EXPECT_EQ(with(other), 0.0) << "what is detected there may be of it";
  objects_.front().weight = 0.5;
  EXPECT_EQ(evidence(), 0.0) << "perhaps there is no object";
  objects_.front().weight = 0.95;
  objects_.front().velocity_mps = turned({0.5, 0.0});
  EXPECT_EQ(evidence(), 0.0) << "its image would look as if it stood";
  objects_.front().velocity_mps = turned({20.0, 0.0});
  objects_.front().position_covariance = 4.0 * Eigen::Matrix2d::Identity();
  EXPECT_EQ(evidence(), 0.0) << "it is not known well where the object is";
  objects_.front().position_covariance.setZero();
  mounting_std_rad_ = 0.1;
  EXPECT_EQ(evidence(), 0.0) << "nor where the radar looks";
  mounting_std_rad_ = 0.002;
  occupancy_.open(-5.0, 15.0);
  EXPECT_EQ(evidence(), 0.0) << "there is a gap";
  occupancy_.reset(-40.0, 40.0, 2.0);
  trials_.begin();
  EXPECT_EQ(evidence(), 0.0) << "the radar does not look there";
  trials_.saw(turned({1.0, 0.5}), 30.0);
  EXPECT_EQ(evidence(), 0.0) << "or not so far";
}

TEST_P(MirrorTrialsTest, AnImageTellsWhereNoneWouldBeMissed) {
  show_image();
  const double seen = evidence();
  mounting_std_rad_ = 0.1;
  EXPECT_EQ(evidence(), seen) << "it is not known well where the radar looks";
  mounting_std_rad_ = 0.002;
  trials_.begin();
  trials_.saw(turned({1.0, 0.0}), 40.0);
  EXPECT_EQ(evidence(), seen) << "the radar hardly sees so far";
  occupancy_.open(-5.0, 15.0);
  EXPECT_EQ(evidence(), 0.0) << "behind a gap it is rather real";
}

TEST_P(MirrorTrialsTest, AFlankShowsThatItMirrorsAsAWallDoes) {
  // A van as far to the left as the wall; it drives as fast as the own vehicle, along its flank.
  Object van = objects_.front();
  van.position_m = turned({17.0, 9.0});
  van.half_length_m = 3.0;
  van.half_width_m = 1.0;
  objects_.push_back(van);
  wall_.occupancy = nullptr;
  wall_.curve.origin_m = turned({17.0, 8.0});
  wall_.begin_m = -3.0;
  wall_.end_m = 3.0;
  wall_.body = 1;
  wall_.velocity_mps = turned({15.0, 0.0});
  EXPECT_LT(evidence(), 0.0) << "the van itself hides nothing";
  show_image(0.0, 1);
  EXPECT_LT(evidence(), 0.0) << "what is of the van itself is no image";
  show_image();
  EXPECT_GT(evidence(), 0.0);
  wall_.velocity_mps = turned({15.0, 8.0});
  EXPECT_LT(evidence(), 0.0) << "a mirror that comes nearer changes the image's range rate";
  wall_.velocity_mps.setZero();
  wall_.begin_m = 0.0;
  wall_.end_m = 6.0;
  wall_.curve.origin_m = turned({1.0, 8.0});
  EXPECT_EQ(evidence(), 0.0) << "the wave would turn beyond its end";
}

INSTANTIATE_TEST_SUITE_P(Turned, MirrorTrialsTest, testing::Values(0.0, 0.7, -2.1));

constexpr double kHedge = 9.0;

TEST_F(MirrorFilterTest, WhatNeverShowsAnImageIsHardlyBelievedToMirror) {
  const Plane plane{{0.0, kHedge}, {1.0, 0.0}};
  const auto odds_of_ghost = [&](bool shows_images) {
    filter_ = std::make_unique<MirrorFilter>(MirrorConfig{});
    t_s_ = 0.0;
    start_ += 100'000 * kMillisecond;
    std::uint32_t there = 0;
    for (int k = 0; k <= 80; ++k) {
      drive(0.05, [&] {
        const Vector2d p(25.0, 1.0), v(speed_mps_, 0.0);
        track(p, v);
        hand_over_tracks();
        rail(kHedge);
        for (const double x : {-2.0, 0.0, 1.5}) direct(p + Vector2d(x, -0.8), v);
        // In the end something drives on the far side in any case, beside where the image would be.
        if (k == 80) {
          there = by_three_bounces(p + Vector2d(-2.0, -3.5), v, plane);
        } else if (shows_images) {
          by_three_bounces(p + Vector2d(-2.0, -0.5), v, plane);
        }
      });
    }
    const double ghost = out_->ghost_probability(there);
    return ghost / (1.0 - ghost);
  };
  const double mirror = odds_of_ghost(true), hedge = odds_of_ghost(false);
  EXPECT_GT(mirror, 5.0);
  EXPECT_LT(hedge, 0.5 * mirror) << "the rest is of clutter";
}

}  // namespace
}  // namespace boresight::ghosts
