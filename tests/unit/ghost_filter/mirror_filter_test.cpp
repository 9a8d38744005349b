// The mirror method in small scenes whose ghosts are exact by the image method.
#include "services/ghost_filter/core/classify/mirror_filter.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/ghost_filter/mirror_scene.hpp"

namespace boresight::ghosts {
namespace {

constexpr double kRail = -7.0;
const Plane kRailPlane{{0.0, kRail}, {1.0, 0.0}};

TEST_F(MirrorFilterTest, ARailBecomesOneLineThatFollowsTheVehicle) {
  drive(2.0, [&] { rail(kRail); });
  ASSERT_GE(out_->number_of_reflector_segments, 1u);
  double from = 1e9, to = -1e9, covered = 0.0;
  for (std::size_t i = 0; i < out_->number_of_reflector_segments; ++i) {
    const ReflectorSegment& s = out_->reflector_segments[i];
    EXPECT_NEAR(s.start_vehicle_m[1], kRail, 0.15);
    EXPECT_NEAR(s.end_vehicle_m[1], kRail, 0.15);
    from = std::min({from, static_cast<double>(s.start_vehicle_m[0]), static_cast<double>(s.end_vehicle_m[0])});
    to = std::max({to, static_cast<double>(s.start_vehicle_m[0]), static_cast<double>(s.end_vehicle_m[0])});
    covered += std::abs(static_cast<double>(s.end_vehicle_m[0] - s.start_vehicle_m[0]));
  }
  EXPECT_LT(from, -30.0);
  EXPECT_GT(to, 70.0);
  EXPECT_GT(covered, 90.0) << "few holes";
  EXPECT_LT(covered, to - from + 1.0) << "and nothing twice";
}

TEST_F(MirrorFilterTest, WithoutTracksTheImageOfADetectedCarIsAType2GhostByTwoAndByThreeBounces) {
  std::uint32_t car = 0, three = 0, two = 0;
  std::size_t threes = 0, twos = 0, cars = 0, scans = 0;
  for (int k = 0; k < 60; ++k) {
    drive(0.05, [&] {
      const Vector2d p(20.0 + 5.0 * t_s_, -1.0), v(25.0, 0.0);
      rail(kRail);
      car = direct(p, v);
      direct(p + Vector2d(1.0, 0.6), v);
      three = by_three_bounces(p, v, kRailPlane);
      two = by_two_bounces(p, v, kRailPlane, false);
    });
    if (t_s_ < 1.0) continue;
    ++scans;
    cars += label(car) == Provenance::kMoving ? 1U : 0U;
    threes += label(three) == Provenance::kGhostType2 ? 1U : 0U;
    twos += label(two) == Provenance::kGhostType2 ? 1U : 0U;
  }
  EXPECT_TRUE(out_->flags & pipeline_flag::kNoTracks);
  EXPECT_GE(cars, scans - 1);
  EXPECT_GE(threes, scans - 1);
  EXPECT_GE(twos, scans - 1);
}

TEST_F(MirrorFilterTest, ARealCarSeenAboveTheRailSurvivesWhileAGhostBesideItDoesNot) {
  // On the other side of the rail, slower, with nothing where its mirror image would be.
  std::size_t real = 0, ghosts = 0, scans = 0;
  for (int k = 0; k < 60; ++k) {
    std::uint32_t beyond = 0, again = 0, ghost = 0;
    drive(0.05, [&] {
      const Vector2d p(20.0 + 5.0 * t_s_, -1.0), v(25.0, 0.0);
      const Vector2d q(45.0 - 8.0 * t_s_, -11.0), w(12.0, 0.0);
      rail(kRail);
      direct(p, v);
      beyond = direct(q, w);
      again = direct(q + Vector2d(-2.0, 0.5), w);
      ghost = by_three_bounces(p, v, kRailPlane);
    });
    if (t_s_ < 1.0) continue;
    ++scans;
    real += (label(beyond) == Provenance::kMoving ? 1U : 0U) + (label(again) == Provenance::kMoving ? 1U : 0U);
    ghosts += label(ghost) == Provenance::kGhostType2 ? 1U : 0U;
  }
  EXPECT_GE(real, 2 * scans * 97 / 100);
  EXPECT_GE(ghosts, scans - 1);
}

TEST_F(MirrorFilterTest, TheRangeRateMustBeTheImages) {
  // At the place of an image, but it moves otherwise than the image would.
  std::uint32_t wrong = 0, right = 0;
  drive(2.0, [&] {
    const Vector2d p(20.0 + 5.0 * t_s_, -1.0), v(25.0, 0.0);
    rail(kRail);
    direct(p, v);
    right = by_three_bounces(p, v, kRailPlane);
    wrong = direct(kRailPlane.image(p) + Vector2d(0.5, 0.0), {10.0, 0.0});
    direct(kRailPlane.image(p) + Vector2d(1.5, 0.5), {10.0, 0.0});
  });
  EXPECT_EQ(label(right), Provenance::kGhostType2);
  EXPECT_EQ(label(wrong), Provenance::kMoving);
}

TEST_F(MirrorFilterTest, APassageInTheRailStaysOpen) {
  const auto open = [](double world) { return world < 80.0 || world > 100.0; };
  drive(2.0, [&] { rail(kRail, open); });
  const double driven = t_s_ * speed_mps_;
  for (std::size_t i = 0; i < out_->number_of_reflector_segments; ++i) {
    const ReflectorSegment& s = out_->reflector_segments[i];
    const double from = std::min(s.start_vehicle_m[0], s.end_vehicle_m[0]) + driven;
    const double to = std::max(s.start_vehicle_m[0], s.end_vehicle_m[0]) + driven;
    EXPECT_TRUE(to < 83.0 || from > 97.0) << from << " … " << to;
  }
  EXPECT_GE(out_->number_of_reflector_segments, 2u);
  // Through it one sees what is there, even where a car would be mirrored if the rail went on.
  std::uint32_t through = 0;
  drive(0.05, [&] {
    const double gap = 90.0 - t_s_ * speed_mps_;  // of the passage's middle, vehicle frame
    const Vector2d direction = (Vector2d(gap, kRail) - sensor()).normalized();
    const Vector2d place = sensor() + 1.3 * (Vector2d(gap, kRail) - sensor()).norm() * direction;
    rail(kRail, open);
    direct(kRailPlane.image(place), {15.0, 0.0});
    through = direct(place, {15.0, 0.0});
    direct(place + Vector2d(0.8, 0.4), {15.0, 0.0});
  });
  EXPECT_EQ(label(through), Provenance::kMoving);
}

TEST_F(MirrorFilterTest, WhatIsDrivenThroughStaysOpenUnlessTheTrackIsNew) {
  // A new track may seem to drive any way.
  const auto open_m = [this](double age_s) {
    filter_ = std::make_unique<MirrorFilter>(MirrorConfig{});
    t_s_ = 0.0;
    const double at_world = 60.0;
    for (int k = 0; k < 40; ++k) {
      drive(0.05, [&] {
        if (k == 20) {
          track({at_world - t_s_ * speed_mps_, kRail}, {0.0, 8.0}, 4.5, 1.8, 0.1, age_s);
          hand_over_tracks();
        }
        rail(kRail);
      });
    }
    const double from_m = -20.0, to_m = 60.0;
    double covered_m = 0.0;
    for (std::size_t i = 0; i < out_->number_of_reflector_segments; ++i) {
      const ReflectorSegment& r = out_->reflector_segments[i];
      const double low = std::min(r.start_vehicle_m[0], r.end_vehicle_m[0]);
      const double high = std::max(r.start_vehicle_m[0], r.end_vehicle_m[0]);
      covered_m += std::max(0.0, std::min(high, to_m) - std::max(low, from_m));
    }
    return to_m - from_m - covered_m;
  };
  EXPECT_LT(open_m(1.0), 1.0);
  EXPECT_GT(open_m(3.0), 6.0);
}

TEST_F(MirrorFilterTest, InTheDirectionOfATrackAtTheLengthOfADetourIsAType1Ghost) {
  std::size_t ghosts = 0, cars = 0, beside = 0, scans = 0;
  for (int k = 0; k < 60; ++k) {
    std::uint32_t car = 0, ghost = 0, other = 0;
    drive(0.05, [&] {
      const Vector2d p(11.0, 2.0), v(24.0, 0.0);
      track(p, v);
      hand_over_tracks();
      rail(kRail);
      car = direct(p + Vector2d(-2.0, 0.0), v);
      // The ways out and back are far apart at the car: little comes back.
      ghost = by_two_bounces(p + Vector2d(-2.0, 0.0), v, kRailPlane, true, -16.0);
      other = direct({40.0, 6.0}, {20.0, 0.0});
      direct({41.0, 6.5}, {20.0, 0.0});
    });
    if (t_s_ < 1.0) continue;
    ++scans;
    cars += label(car) == Provenance::kMoving ? 1U : 0U;
    ghosts += label(ghost) == Provenance::kGhostType1 ? 1U : 0U;
    beside += label(other) == Provenance::kMoving ? 1U : 0U;
  }
  EXPECT_GE(cars, scans - 1);
  EXPECT_GE(beside, scans - 1);
  EXPECT_GE(ghosts, scans * 9 / 10);
}

TEST_F(MirrorFilterTest, TheOrderOfDetectionsTellsNothing) {
  // Twins: one is given the detections of its last scan in the opposite order.
  const auto last_scan = [this](bool turned) {
    filter_ = std::make_unique<MirrorFilter>(MirrorConfig{});
    random_.seed(5);
    t_s_ = 0.0;
    const Vector2d p(11.0, 2.0), v(24.0, 0.0);
    drive(1.0, [&] {
      track(p, v);
      hand_over_tracks();
      rail(kRail);
    });
    t_s_ += 0.05;
    begin();
    track(p, v);
    hand_over_tracks();
    direct(p + Vector2d(-2.25, 0.5), v);
    direct(p + Vector2d(-2.25, -0.5), v, 2.0);
    by_two_bounces(p + Vector2d(-2.25, 0.5), v, kRailPlane, true, -16.0);
    by_two_bounces(p + Vector2d(-2.25, -0.5), v, kRailPlane, false, -12.0);
    by_three_bounces(p + Vector2d(-2.25, 0.5), v, kRailPlane);
    const std::uint32_t n = scan_->number_of_valid_detections;
    const auto turn = [&](auto& values) {
      if (turned) std::reverse(&values[0], &values[0] + n);
    };
    turn(scan_->x_vehicle_m);
    turn(scan_->y_vehicle_m);
    turn(scan_->range_m);
    turn(scan_->range_rate_over_ground_mps);
    turn(scan_->rcs_dbsm);
    classify();
    std::vector<float> told;
    for (std::uint32_t i = 0; i < n; ++i) told.push_back(out_->ghost_probability(i));
    if (turned) std::reverse(told.begin(), told.end());
    return told;
  };
  const std::vector<float> one = last_scan(false), other = last_scan(true);
  ASSERT_EQ(one.size(), 5U);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], other[i], 1e-5F) << i;
}

TEST_F(MirrorFilterTest, TheSideOfATruckMirrorsAndMovesItself) {
  std::size_t ghosts = 0, cars = 0, scans = 0;
  for (int k = 0; k < 60; ++k) {
    std::uint32_t car = 0, ghost = 0;
    drive(0.05, [&] {
      // The truck's left side is at y = −2.
      const Vector2d truck(12.0, -3.25), truck_v(21.0, 0.0), p(22.0, 1.5), v(26.0, 0.5);
      track(truck, truck_v, 16.0, 2.5);
      track(p, v);
      hand_over_tracks();
      car = direct(p + Vector2d(-2.0, 0.0), v);
      ghost = by_three_bounces(p + Vector2d(-2.0, 0.0), v, {{12.0, -2.0}, {1.0, 0.0}, truck_v});
    });
    if (t_s_ < 0.5) continue;
    ++scans;
    cars += label(car) == Provenance::kMoving ? 1U : 0U;
    ghosts += label(ghost) == Provenance::kGhostType2 ? 1U : 0U;
  }
  EXPECT_GE(cars, scans - 1);
  EXPECT_GE(ghosts, scans * 9 / 10);
}

TEST_F(MirrorFilterTest, TheRearOfAVehicleAheadMayMirrorThoughItsLengthIsNotSeen) {
  for (const double length : {4.5, 1.8}) {
    std::size_t ghosts = 0, scans = 0;
    filter_ = std::make_unique<MirrorFilter>(MirrorConfig{});
    for (int k = 0; k < 40; ++k) {
      std::uint32_t ghost = 0;
      drive(0.05, [&] {
        // The way back from its rear to the vehicle behind passes beside the own vehicle.
        const Vector2d ahead(15.0, 0.0), ahead_v(10.0, 0.0), behind(-15.0, 2.5), v(12.0, 0.0);
        track(ahead, ahead_v, length);
        track(behind, v);
        hand_over_tracks();
        direct(ahead + Vector2d(-0.5 * length, 0.0), ahead_v);
        const Plane rear{ahead - Vector2d(0.5 * length, 0.0), {0.0, 1.0}, ahead_v};
        // Again and again: what is rather an image stays one.
        ghost = by_three_bounces(behind + Vector2d(2.25, 0.0), v, rear);
      });
      ++scans;
      ghosts += label(ghost) == Provenance::kGhostType2 ? 1U : 0U;
    }
    if (length > 3.0) {
      EXPECT_GE(ghosts, scans * 9 / 10);
    } else {
      EXPECT_EQ(ghosts, 0U) << "a cycle does not mirror";
    }
  }
}

TEST_F(MirrorFilterTest, AnArcMirrorsAsItsTangentAtTheReflectionDoes) {
  // A wall bends to the left, radius 90 m, about a vehicle that stands; the ghost by Fermat's principle.
  speed_mps_ = 0.0;
  const Vector2d centre(0.0, 83.0);
  const double radius = 90.0;
  const auto on_wall = [&](double angle) {
    return Vector2d(centre + radius * Vector2d(std::sin(angle), -std::cos(angle)));
  };
  const Vector2d p(25.0, 1.0), v(12.0, 3.0);
  double best = 1e9, at = 0.0;
  for (double angle = -0.2; angle < 0.6; angle += 1e-5) {
    const double length = (on_wall(angle) - sensor()).norm() + (on_wall(angle) - p).norm();
    // Inside a circle the way over the near wall is the shortest one as well, as long as it bends less than the sight.
    if (length < best) {
      best = length;
      at = angle;
    }
  }
  const Plane tangent{on_wall(at), {std::cos(at), std::sin(at)}};
  std::uint32_t ghost = 0, car = 0;
  std::bernoulli_distribution seen(0.6);
  drive(1.5, [&] {
    for (double angle = -0.3; angle < 0.75; angle += 0.02) {
      if (seen(random_)) still(on_wall(angle));
    }
    car = direct(p, v);
    ghost = by_three_bounces(p, v, tangent);
  });
  EXPECT_EQ(label(car), Provenance::kMoving);
  EXPECT_EQ(label(ghost), Provenance::kGhostType2);
  for (std::size_t i = 0; i < out_->number_of_reflector_segments; ++i) {
    for (const auto& end : {out_->reflector_segments[i].start_vehicle_m, out_->reflector_segments[i].end_vehicle_m}) {
      EXPECT_NEAR((Vector2d(end[0], end[1]) - centre).norm(), radius, 0.5);
    }
  }
  EXPECT_GE(out_->number_of_reflector_segments, 2u);
}

TEST_F(MirrorFilterTest, AMisalignedRadarsGhostsAreFoundBecauseItsMountingIsUncertain) {
  // The radar is crooked by 3.5°: everything is turned, the rail as well, and the own motion is taken out wrongly.
  speed_mps_ = 50.0;
  const Eigen::Rotation2Dd turn(3.5 * M_PI / 180.0);
  const auto ghosts_found = [&](double yaw_std) {
    filter_ = std::make_unique<MirrorFilter>(MirrorConfig{});
    std::size_t ghosts = 0;
    t_s_ = 0.0;
    for (int k = 0; k < 40; ++k) {
      std::uint32_t ghost = 0;
      drive(0.05, [&] {
        const Vector2d p(12.0, -1.0), v(51.0, 0.0);
        scan_->mounting_covariance[5] = static_cast<float>(yaw_std * yaw_std);
        rail(kRail);
        direct(p, v);
        ghost = by_three_bounces(p, v, kRailPlane);
        for (std::size_t i = 0; i < scan_->number_of_valid_detections; ++i) {
          const Vector2d sight = Vector2d(scan_->x_vehicle_m[i], scan_->y_vehicle_m[i]) - sensor();
          const Vector2d q = turn * sight;
          scan_->x_vehicle_m[i] = static_cast<float>(sensor().x() + q.x());
          scan_->y_vehicle_m[i] = static_cast<float>(sensor().y() + q.y());
          scan_->range_rate_over_ground_mps[i] +=
              static_cast<float>((q - sight).normalized().dot(sensor_velocity()) * (q - sight).norm() / sight.norm());
        }
      });
      if (t_s_ > 1.0) ghosts += label(ghost) == Provenance::kGhostType2 ? 1U : 0U;
    }
    return ghosts;
  };
  EXPECT_GE(ghosts_found(0.06), 17u) << "of 20";
  EXPECT_LE(ghosts_found(0.001), 10u) << "as sure of its mounting as an aligned radar";
}

TEST_F(MirrorFilterTest, AWeakDetectionAllAloneIsClutter) {
  std::uint32_t alone = 0;
  drive(1.0, [&] {
    rail(kRail);
    if (t_s_ > 0.99) alone = direct({40.0, 15.0}, {-20.0, 9.0}, -18.0);
  });
  EXPECT_EQ(label(alone), Provenance::kClutter);
  EXPECT_GT(out_->ghost_probability(alone), 0.5F);
}

TEST_F(MirrorFilterTest, WhatIsSeenNowAndThenMovesAsSoonAsItIsSeenAgain) {
  // Behind another car, at the end of the radar's range, twice a second.
  std::vector<Provenance> told;
  for (int k = 0; k < 40; ++k) {
    std::uint32_t far = 0;
    drive(0.05, [&] {
      const Vector2d lead(42.0, 0.0), v(20.5, 0.0);
      track(lead, {20.0, 0.0});
      hand_over_tracks();
      direct(lead - Vector2d(2.2, 0.0), {20.0, 0.0});
      if (k % 10 == 9) far = direct({102.0 + 0.5 * t_s_, 0.0}, v, -1.0);
    });
    if (k % 10 == 9) told.push_back(label(far));
  }
  ASSERT_EQ(told.size(), 4u);
  EXPECT_NE(told[0], Provenance::kMoving) << "as likely a ghost of the car in front";
  EXPECT_EQ(std::count(told.begin() + 1, told.end(), Provenance::kMoving), 3);
}

TEST_F(MirrorFilterTest, AWheelMovesThoughItsRangeRateIsNotTheCars) {
  std::size_t wheels = 0, beside = 0, scans = 0;
  for (int k = 0; k < 40; ++k) {
    std::uint32_t wheel = 0, other = 0;
    drive(0.05, [&] {
      const Vector2d p(20.0, 1.0), v(24.0, 0.0);
      track(p, v);
      hand_over_tracks();
      rail(kRail);
      direct(p + Vector2d(-2.2, 0.0), v);
      // The rim, at a part of its turn that no scan of the last second repeats; and the same without a car.
      const double rim = 0.8 + std::fmod(0.618034 * k, 1.0);
      wheel = direct(p + Vector2d(-1.3, -0.9), rim * v, -8.0);
      other = direct(p + Vector2d(25.0, 9.0), rim * v, -18.0);
    });
    if (t_s_ < 0.5) continue;
    ++scans;
    wheels += label(wheel) == Provenance::kMoving ? 1U : 0U;
    beside += label(other) == Provenance::kMoving ? 1U : 0U;
  }
  EXPECT_GE(wheels, scans * 9 / 10);
  EXPECT_LE(beside, scans / 2);
}

TEST_F(MirrorFilterTest, WhatStandsHighUpMayShowSomeRangeRate) {
  // On a wall, now and then: of its upper edge the road moves the elevation.
  const auto told_moving = [&](float height_m) {
    filter_ = std::make_unique<MirrorFilter>(MirrorConfig{});
    std::size_t moving = 0;
    for (int k = 0; k < 20; ++k) {
      std::uint32_t edge = 0;
      drive(0.25, [&] { rail(4.0); });
      drive(0.05, [&] {
        rail(4.0);
        const Vector2d sight = Vector2d(14.0, 4.0) - sensor();
        edge = add(sight.normalized(), sight.norm(), 1.2 - sight.normalized().dot(sensor_velocity()), 5.0,
                   corrected_flag::kMoving);
        scan_->z_vehicle_m[edge] = height_m;
      });
      moving += label(edge) == Provenance::kMoving ? 1U : 0U;
    }
    return moving;
  };
  EXPECT_GE(told_moving(0.5F), 15u);
  EXPECT_LE(told_moving(4.5F), 1u);
}

TEST_F(MirrorFilterTest, ErrorsThatAreAlikeAreNoCompany) {
  // Two points of a wall are wrong by the same three standard deviations in one scan: neither is why the other moves.
  std::size_t moving = 0;
  drive(1.0, [&] { rail(4.0); });
  for (int k = 0; k < 20; ++k) {
    std::uint32_t first = 0, second = 0;
    drive(0.25, [&] { rail(4.0); });
    drive(0.05, [&] {
      rail(4.0);
      const double post = 18.0 - std::fmod(t_s_ * speed_mps_, 2.0);
      const auto wrong = [&](const Vector2d& p) {
        const Vector2d sight = p - sensor();
        return add(sight.normalized(), sight.norm(), 0.3 - sight.normalized().dot(sensor_velocity()), 0.0,
                   corrected_flag::kMoving);
      };
      first = wrong({post, 4.0});
      second = wrong({post + 2.0, 4.0});
    });
    for (const std::uint32_t i : {first, second}) moving += label(i) == Provenance::kMoving ? 1U : 0U;
  }
  EXPECT_LE(moving, 10u) << "of 40";
}

TEST_F(MirrorFilterTest, RejectedUndecidedAndNotFiniteAreUnknown) {
  begin();
  const auto rejected = direct({20.0, 0.0}, {5.0, 0.0});
  scan_->detection_flags[rejected] |= corrected_flag::kOutsideRegion;
  const auto undecided = direct({20.0, 0.0}, {5.0, 0.0});
  scan_->detection_flags[undecided] = corrected_flag::kAmbiguous;
  const auto broken = direct({20.0, 0.0}, {5.0, 0.0});
  scan_->y_vehicle_m[broken] = std::numeric_limits<float>::quiet_NaN();
  classify();
  for (const auto i : {rejected, undecided, broken}) {
    EXPECT_EQ(label(i), Provenance::kUnknown);
    for (const Provenance origin : kOrigins) EXPECT_EQ(out_->probability(origin, i), 0.0F);
  }
  EXPECT_EQ(out_->number_of_valid_detections, 3u);
}

TEST_F(MirrorFilterTest, FullScansForAMinuteStayWithinBoundsAndAllocateNothing) {
  std::uniform_real_distribution<float> place(-80.0F, 80.0F);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (int round = 0; round < 160; ++round) {
      t_s_ += 0.0125;
      begin();
      scan_->number_of_valid_detections = kMaxDetections;
      for (std::size_t i = 0; i < kMaxDetections; ++i) {
        scan_->x_vehicle_m[i] = place(random_);
        scan_->y_vehicle_m[i] = i % 3 == 0 ? static_cast<float>(kRail) : place(random_);
        scan_->range_rate_over_ground_mps[i] = i % 5 == 0 ? place(random_) : 0.0F;
        scan_->detection_flags[i] = i % 5 == 0 ? corrected_flag::kMoving : corrected_flag::kStationary;
      }
      classify();
      ASSERT_LE(out_->number_of_reflector_segments, kMaxReflectorSegments);
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

TEST(GhostStrength, FallsWithEachBounceAndWithTheAngleAtTheObject) {
  const double ahead = strength_of_ghost(1, std::cos(0.03)).mean_db;
  EXPECT_LT(strength_of_ghost(1, std::cos(0.12)).mean_db, ahead - 2.5);
  EXPECT_LT(strength_of_ghost(1, std::cos(0.5)).mean_db, ahead - 12.0);
  EXPECT_LT(strength_of_ghost(2, 1.0).mean_db, ahead - 10.0);
  // From far aside it does not matter how far.
  EXPECT_DOUBLE_EQ(strength_of_ghost(1, -1.0).mean_db, strength_of_ghost(1, 0.0).mean_db);
}

}  // namespace
}  // namespace boresight::ghosts
