// Images that look as if they stood, images that are tracked, and mirrors that are hardly seen.
#include "tests/unit/ghost_filter/mirror_scene.hpp"

namespace boresight::ghosts {
namespace {

constexpr double kRailOffset_m = -7.0;
const Plane kMirrorPlane{{0.0, kRailOffset_m}, {1.0, 0.0}};

TEST_F(MirrorFilterTest, TheImageOfWhoCreepsIsAGhostThoughItLooksStill) {
  speed_mps_ = 0.0;
  std::size_t ghosts = 0, posts = 0, scans = 0;
  drive(2.0, [&] {
    rail(kRailOffset_m);
    still({8.0, -17.5});
  });
  for (int k = 0; k < 20; ++k) {
    std::uint32_t ghost = 0, post = 0;
    drive(0.05, [&] {
      // Abeam: no range rate.
      const Vector2d p(2.8 + 0.06 * k, 4.0), v(1.2, 0.0);
      track(p, v, 4.5, 2.0);
      hand_over_tracks();
      rail(kRailOffset_m);
      post = still({8.0, -17.5});
      ghost = by_three_bounces(p + Vector2d(0.0, -1.0), v, kMirrorPlane);
      scan_->detection_flags[ghost] = corrected_flag::kStationary;
    });
    ++scans;
    ghosts += label(ghost) == Provenance::kGhostType2 ? 1U : 0U;
    posts += label(post) == Provenance::kStationary ? 1U : 0U;
  }
  EXPECT_GE(ghosts, scans * 8 / 10);
  EXPECT_EQ(posts, scans);
}

TEST_F(MirrorFilterTest, WhatLiesOnATrackedImageIsAGhostThoughItMirrorsNothing) {
  const auto share_of_ghosts = [&](bool with_object) {
    filter_ = std::make_unique<MirrorFilter>(MirrorConfig{});
    std::size_t ghosts = 0, scans = 0;
    for (int k = 0; k < 80; ++k) {
      std::uint32_t far_end = 0;
      drive(0.05, [&] {
        const Vector2d p(25.0, 1.0), v(23.0, 0.0);
        rail(kRailOffset_m);
        if (with_object) {
          track(p, v);
          direct(p + Vector2d(-2.2, 0.0), v);
          by_three_bounces(p + Vector2d(-2.2, 0.0), v, kMirrorPlane);
        } else {
          ++tracks_->number_of_tracks;  // an empty place, so that the image has the same number
          tracks_->tracks[0] = {};
        }
        // The image's track is longer than the object's.
        track(kMirrorPlane.image(p) + Vector2d(5.0, 0.0), v, 14.0, 2.0);
        hand_over_tracks();
        far_end = direct(kMirrorPlane.image(p) + Vector2d(11.5, 0.0), v, -8.0);
      });
      if (k < 40) continue;
      ++scans;
      ghosts += label(far_end) == Provenance::kGhostType2 ? 1U : 0U;
    }
    return static_cast<double>(ghosts) / static_cast<double>(scans);
  };
  EXPECT_GE(share_of_ghosts(true), 0.9);
  EXPECT_LE(share_of_ghosts(false), 0.1) << "of nothing it is no image";
}

TEST_F(MirrorFilterTest, WhatWasLongTrackedIsNoImageForASecondWhereOneWouldBe) {
  std::size_t moving_before = 0, moving_at_first = 0, ghosts_later = 0;  // the middle: of 70, in 3.5 s
  for (int k = 0; k < 260; ++k) {
    std::uint32_t far_end = 0;
    drive(0.05, [&] {
      const Vector2d p(25.0, 1.0), v(23.0, 0.0);
      rail(kRailOffset_m);
      // For three seconds it drives alone, then beside what would be mirrored there.
      if (k >= 60) {
        track(p, v);
        direct(p + Vector2d(-2.2, 0.0), v);
        by_three_bounces(p + Vector2d(-2.2, 0.0), v, kMirrorPlane);
      } else {
        ++tracks_->number_of_tracks;  // an empty place, so that it keeps its number
        tracks_->tracks[0] = {};
      }
      track(kMirrorPlane.image(p) + Vector2d(5.0, 0.0), v, 14.0, 2.0);
      hand_over_tracks();
      far_end = direct(kMirrorPlane.image(p) + Vector2d(11.5, 0.0), v, -8.0);
    });
    moving_before += k >= 50 && k < 60 && label(far_end) == Provenance::kMoving ? 1U : 0U;
    moving_at_first += k >= 60 && k < 130 && label(far_end) == Provenance::kMoving ? 1U : 0U;
    ghosts_later += k >= 240 && label(far_end) == Provenance::kGhostType2 ? 1U : 0U;
  }
  EXPECT_EQ(moving_before, 10U);
  EXPECT_GE(moving_at_first, 68U);
  EXPECT_GE(ghosts_later, 18U) << "but in the end it is believed";
}

TEST_F(MirrorFilterTest, ALongRailGoesOnUnseenAndAShortOneDoesNot) {
  const auto share_of_ghosts = [&](double length_m) {
    filter_ = std::make_unique<MirrorFilter>(MirrorConfig{});
    t_s_ = 0.0;
    speed_mps_ = 0.0;
    std::size_t ghosts = 0, scans = 0;
    for (int k = 0; k < 60; ++k) {
      std::uint32_t ghost = 0;
      drive(0.05, [&] {
        // Seen up to 20 m ahead; the bounce is at about 29 m.
        const Vector2d p(50.0, 1.0), v(-9.0, 0.0);
        track(p, v);
        hand_over_tracks();
        rail(kRailOffset_m, [&](double x) { return x < 20.0 && x > 20.0 - length_m; });
        direct(p + Vector2d(-2.2, 0.0), v);
        ghost = by_three_bounces(p + Vector2d(-2.2, 0.0), v, kMirrorPlane);
      });
      if (k < 40) continue;
      ++scans;
      ghosts += label(ghost) == Provenance::kGhostType2 ? 1U : 0U;
    }
    return static_cast<double>(ghosts) / static_cast<double>(scans);
  };
  EXPECT_GE(share_of_ghosts(60.0), 0.9);
  EXPECT_LE(share_of_ghosts(14.0), 0.1);
}

TEST_F(MirrorFilterTest, NothingIsItsOwnImageInAMirrorAlongTheLineOfSight) {
  // A hundred metres ahead, where the azimuth's noise is half a lane and the car and its image are one place.
  constexpr double kAzimuthStd_rad = 0.015;
  const Vector2d p(100.0, -1.0), v(20.0, 0.0);
  std::normal_distribution<double> across_m(0.0, kAzimuthStd_rad * p.x());
  std::size_t scans = 0;
  double ghost_probability = 0.0;
  for (int k = 0; k < 120; ++k) {
    std::uint32_t car = 0;
    drive(0.05, [&] {
      track(p, v, 4.5, 1.8, 0.5);
      hand_over_tracks();
      rail(-0.7);
      car = direct(p + Vector2d(-2.2, across_m(random_)), v);
      scan_->azimuth_std_rad[car] = static_cast<float>(kAzimuthStd_rad);
    });
    if (k < 40) continue;
    ++scans;
    ghost_probability += static_cast<double>(out_->ghost_probability(car));
  }
  EXPECT_LE(ghost_probability / static_cast<double>(scans), 0.01) << "0.03 where it may be its own image";
}

}  // namespace
}  // namespace boresight::ghosts
