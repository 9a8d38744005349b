// What moves across the line of sight shows no range rate: who is known to move there, and what stood there before.
#include "services/ghost_filter/core/classify/object.hpp"
#include "tests/unit/ghost_filter/mirror_scene.hpp"

namespace boresight::ghosts {
namespace {

TEST_F(MirrorFilterTest, WhatCrossesTheLineOfSightOfATrackMovesThoughItLooksStill) {
  std::uint32_t crossing = 0, post = 0;
  drive(0.5, [&] {
    track({20.0, 0.0}, {0.0, 8.0});
    hand_over_tracks();
    crossing = still({19.2, 0.2});
    post = still({30.0, 6.0});
  });
  EXPECT_EQ(label(crossing), Provenance::kMoving);
  EXPECT_EQ(label(post), Provenance::kStationary);
}

TEST_F(MirrorFilterTest, WhoWalksAcrossTheLineOfSightMovesWhereNothingStoodBefore) {
  // The speed is not beyond doubt, and what looks still makes places known where it passes.
  speed_mps_ = 0.0;
  std::size_t walking = 0, scans = 0;
  for (int k = 0; k < 60; ++k) {
    const Vector2d p(12.0, -2.0 + 1.3 * 0.05 * k);
    std::uint32_t person = 0;
    drive(0.05, [&] {
      track(p, {0.0, 1.3}, 0.6, 0.6, 0.3);
      hand_over_tracks();
      person = still(p);
    });
    if (t_s_ < 0.5) continue;
    ++scans;
    walking += label(person) == Provenance::kMoving ? 1U : 0U;
  }
  EXPECT_GE(walking, scans * 9 / 10);
}

TEST_F(MirrorFilterTest, WhatWasThereBeforeTheTrackCameIsNotOfIt) {
  speed_mps_ = 0.0;
  // Where it comes by, and where it was found for the first time.
  for (const double age_s : {5.0, 0.2}) {
    const double speed_mps = age_s > 1.0 ? 1.5 : 0.9;
    filter_ = std::make_unique<MirrorFilter>(MirrorConfig{});
    std::uint32_t post = 0, elsewhere = 0;
    for (int k = 0; k < 30; ++k) {
      drive(0.05, [&] {
        if (k >= 26) {
          track({12.0, 0.0}, {0.0, speed_mps}, 2.0, 2.0, 0.1, age_s);
          hand_over_tracks();
          elsewhere = still({12.0, -0.8});
        }
        post = still({12.0, 0.3});
      });
    }
    EXPECT_EQ(label(post), Provenance::kStationary) << age_s;
    EXPECT_EQ(label(elsewhere), Provenance::kMoving) << age_s;
  }
}

TEST(ObjectMotion, IsAsLikelyAsItsVelocityIsKnown) {
  Object o;
  o.velocity_mps = {0.0, 1.3};
  o.velocity_covariance = Eigen::Vector2d(0.05, 0.4).asDiagonal();
  EXPECT_FALSE(moves_surely(o));
  EXPECT_GT(moving_of(o), 0.8);
  EXPECT_LT(moving_of(o), 1.0);
  o.velocity_covariance *= 0.25;
  EXPECT_EQ(moving_of(o), 1.0);
  o.velocity_covariance *= 100.0;
  EXPECT_LT(moving_of(o), 0.7);
  o.velocity_mps = {0.0, 0.4};
  EXPECT_EQ(moving_of(o), 0.0) << "as slow as what stands";
}

}  // namespace
}  // namespace boresight::ghosts
