// What comes to a stand is where it was.
#include <cmath>

#include <gtest/gtest.h>

#include "services/tracker/core/kalman.hpp"
#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

TEST(Stand, TakesTheVelocityAway) {
  KinematicState s;
  s.mean.setZero();
  s.mean.segment<2>(2) = Eigen::Vector2d(0.5, -0.2);
  s.covariance = Matrix6d::Identity();
  for (int i = 0; i < 10; ++i) come_to_rest(s);
  EXPECT_LT(s.mean.segment<2>(2).norm(), 0.03);
  EXPECT_LT(s.covariance(2, 2), 0.02);
  EXPECT_GT(s.covariance(2, 2), 0.0);
  EXPECT_NEAR(s.covariance(0, 0), 1.0, 1e-9) << "where it stands is not seen better";
}

class Stopping : public testing::Test {
 protected:
  /// A car brakes to a stand in so long; then, at most, stationary detections are left of it, beside a wall or not.
  /// `ahead_m`: where, from the middle of its rear. `wall_m`: where that begins and ends, from there; it lies along the
  /// course, or across, at what is left of it.
  void drive(bool seen_standing, bool by_a_wall, double braking_s = 6.0, double ahead_m = 0.3,
             const Eigen::Vector2d& wall_m = {-40.0, 40.0}, bool across = false) {
    x_ = 14.0;
    tracker_ = Tracker(two_radars(), RulesConfig{});
    for (int i = 0; i < 160; ++i) {
      const double t = 0.05 * i, v = std::max(0.0, 8.0 * (1.0 - t / braking_s));
      x_ += 0.05 * v;
      scene_.begin((1000 + 50 * i) * kMillisecond);
      if (v > 0.25) {
        scene_.add({x_, 0.7}, {v, 0.0});
        scene_.add({x_, -0.7}, {v, 0.0});
      } else if (seen_standing) {
        scene_.add({x_ + ahead_m, 0.0}, {0.0, 0.0}, Provenance::kStationary);
      }
      scene_.scan->number_of_reflector_segments = by_a_wall ? 1 : 0;
      const auto x = static_cast<float>(x_), from = static_cast<float>(wall_m.x()), to = static_cast<float>(wall_m.y());
      ReflectorSegment& wall = scene_.scan->reflector_segments[0];
      wall = {{x + from, 0.2F}, {x + to, 0.2F}, 0.1F, 100};
      const float at = x + static_cast<float>(ahead_m);
      if (across) wall = {{at, from}, {at, to}, 0.1F, 100};
      tracker_.step(*scene_.scan);
    }
    tracker_.write(*list_);
  }
  double x_ = 0.0;
  Tracker tracker_{two_radars(), RulesConfig{}};
  Scene scene_;
  std::unique_ptr<TrackList> list_ = std::make_unique<TrackList>();
};

TEST_F(Stopping, WhatStandsWhereItCameToAStandIsKept) {
  drive(true, false);
  ASSERT_EQ(list_->number_of_confirmed_tracks, 1u);
  EXPECT_NEAR(list_->tracks[0].position_vehicle_m[0] - 0.5F * list_->tracks[0].length_m, x_, 1.5);
  EXPECT_NEAR(list_->tracks[0].velocity_over_ground_mps[0], 0.0, 0.1);
  EXPECT_EQ(list_->tracks[0].movement, MovementState::kStopped);
}

TEST_F(Stopping, WhatIsSeenOfItMayLieALittleBesideItsBox) {
  drive(true, false, 6.0, -0.3);
  EXPECT_EQ(list_->number_of_confirmed_tracks, 1u);
}

TEST_F(Stopping, WhatStandsFartherOffIsNotIt) {
  drive(true, false, 6.0, -2.0);
  EXPECT_EQ(list_->number_of_tracks, 0u);
}

TEST_F(Stopping, WhatWasNotTrackedForLongIsGone) {
  drive(true, false, 3.0);
  EXPECT_EQ(list_->number_of_tracks, 0u);
}

TEST_F(Stopping, WhereNothingIsSeenItIsGone) {
  drive(false, false);
  EXPECT_EQ(list_->number_of_tracks, 0u);
}

TEST_F(Stopping, AWallIsNoVehicleThatCameToAStand) {
  drive(true, true);
  EXPECT_EQ(list_->number_of_tracks, 0u);
}

TEST_F(Stopping, AVehiclesOwnSideIsNoWall) {
  drive(true, true, 6.0, 0.3, {-2.3, 5.7});
  EXPECT_EQ(list_->number_of_confirmed_tracks, 1u);
}

// Cars and trucks beside show images of a rear, which the map takes for more of it. Who drives forward came through
// there.
TEST_F(Stopping, WhatLiesAcrossWhereItCameFromIsNoWallHoweverLong) {
  for (const Eigen::Vector2d& wall_m : {Eigen::Vector2d(-6.1, 1.9), {-1.4, 8.6}, {-40.0, 40.0}}) {
    drive(true, true, 6.0, 0.3, wall_m, true);
    EXPECT_EQ(list_->number_of_confirmed_tracks, 1u) << wall_m.transpose();
  }
}

// The map finds ends in steps of 4 m.
TEST_F(Stopping, AVehiclesOwnFrontIsNoWall) {
  drive(true, true, 6.0, 4.3, {-6.1, 1.9}, true);
  EXPECT_EQ(list_->number_of_confirmed_tracks, 1u);
}

TEST_F(Stopping, AWallInFrontOfItIsNoVehicle) {
  drive(true, true, 6.0, 4.3, {-40.0, 40.0}, true);
  EXPECT_EQ(list_->number_of_tracks, 0u);
}

}  // namespace
}  // namespace boresight::tracking
