// Shares of objects that others hide: against sampling, and in hand-made scenes.
#include "services/tracker/core/model/radar_occlusion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "services/common/extended_object/oriented_box.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking {
namespace {

constexpr Vector2<double> kOccludedFrom_m{2.0, 1.0};

/// A box of which nothing but the place is uncertain.
Box box_at(const Eigen::Vector2d& centre_m, double length_m, double width_m, double std_m = 0.05,
           double heading_rad = 0.0) {
  Box b;
  b.centre_m = centre_m;
  b.covariance_m2 = std_m * std_m * Eigen::Matrix2d::Identity();
  b.heading_rad = heading_rad;
  b.length_m = length_m;
  b.width_m = width_m;
  return b;
}

/// Hidden share of `back` behind `front`; and the reverse, which must be none in most scenes.
struct TwoShares {
  double back = 0.0, front = 0.0;
};
TwoShares shares_of(const Box& front, const Box& back, double existence = 1.0) {
  Occlusion occlusion(8);
  occlusion.begin_scan(kOccludedFrom_m);
  occlusion.add(1, existence, front);
  occlusion.add(2, 1.0, back);
  return {occlusion.hidden_share(2), occlusion.hidden_share(1)};
}

TEST(Occlusion, ObjectInTheShadowIsHiddenAndTheOneInFrontIsNot) {
  const TwoShares s = shares_of(box_at({20.0, 1.0}, 12.0, 2.5), box_at({50.0, 1.0}, 4.6, 1.8));
  EXPECT_GT(s.back, 0.99);
  EXPECT_LT(s.front, 0.01);
}

TEST(Occlusion, ObjectBesideTheShadowIsNotHidden) {
  EXPECT_LT(shares_of(box_at({20.0, 1.0}, 12.0, 2.5), box_at({50.0, 12.0}, 4.6, 1.8)).back, 0.01);
}

TEST(Occlusion, ObjectBesideALongVehicleIsHiddenAlthoughItsCentreIsNearer) {
  // The truck reaches from 5 m to 25 m in the next lane, the car drives in the lane beyond.
  const TwoShares s = shares_of(box_at({15.0, 4.5}, 20.0, 2.5), box_at({11.0, 9.0}, 4.6, 1.8));
  EXPECT_GT(s.back, 0.95);
  EXPECT_LT(s.front, 0.05);
}

TEST(Occlusion, ExistenceOfTheOneInFrontWeighsTheShare) {
  EXPECT_NEAR(shares_of(box_at({20.0, 1.0}, 12.0, 2.5), box_at({50.0, 1.0}, 4.6, 1.8), 0.4).back, 0.4, 0.01);
}

TEST(Occlusion, TwoInFrontHideAsIndependentOnes) {
  Occlusion occlusion(8);
  occlusion.begin_scan(kOccludedFrom_m);
  occlusion.add(1, 0.5, box_at({15.0, 1.0}, 4.6, 1.8));
  occlusion.add(2, 0.5, box_at({25.0, 1.0}, 4.6, 1.8));
  occlusion.add(3, 1.0, box_at({80.0, 1.0}, 4.6, 1.8));
  EXPECT_NEAR(occlusion.hidden_share(2), 0.5, 0.1) << "nearly all of it";
  EXPECT_NEAR(occlusion.hidden_share(3), 0.75, 0.01);
}

TEST(Occlusion, BoxesThatLieInEachOtherDoNotHideEachOther) {
  const TwoShares s = shares_of(box_at({30.0, 1.0}, 4.6, 1.8), box_at({31.0, 1.2}, 4.6, 1.8));
  EXPECT_LT(s.back, 0.01);
  EXPECT_LT(s.front, 0.01);
}

TEST(Occlusion, UnknownHeadingOfTheOneInFrontCoversItsWidthOnly) {
  // Abeam a truck would cover 12 m.
  Box abeam = box_at({30.0, 1.0}, 12.0, 2.5, 0.05, 0.5 * std::numbers::pi);
  const Box beside = box_at({60.0, 9.0}, 4.6, 1.8);
  EXPECT_GT(shares_of(abeam, beside).back, 0.95);
  abeam.heading_variance_rad2 = 10.0;
  EXPECT_LT(shares_of(abeam, beside).back, 0.05);
}

TEST(Occlusion, ShareIsTheMeanOverPlacesAndLinesOfSight) {
  support::Random random(3);
  for (int run = 0; run < 20; ++run) {
    const double std_m = support::uniform(random, 0.1, 1.0);
    const auto azimuths = [](const Box& b, const Eigen::Vector2d& off_m) {
      const extended_object::OrientedBox box{b.centre_m + off_m, b.heading_rad, b.length_m, b.width_m};
      double least_rad = 10.0, most_rad = -10.0;
      for (const Eigen::Vector2d& corner : box.corners()) {
        const double rad = std::atan2(corner.y() - kOccludedFrom_m.y, corner.x() - kOccludedFrom_m.x);
        least_rad = std::min(least_rad, rad);
        most_rad = std::max(most_rad, rad);
      }
      return std::pair(least_rad, most_rad);
    };
    const Box front = box_at({support::uniform(random, 15.0, 30.0), 1.0}, 4.6, 1.8, std_m, 0.3),
              back = box_at({60.0, support::uniform(random, -4.0, 6.0)}, 4.6, 1.8, std_m, 0.6);
    const auto moved = [&](const Box& b) {
      const double x = support::normal(random), y = support::normal(random);
      return azimuths(b, std_m * Eigen::Vector2d(x, y));
    };
    constexpr int kSamples = 10000;
    double share = 0.0;
    for (int k = 0; k < kSamples; ++k) {
      const auto near = moved(front), far = moved(back);
      const double sight_rad = support::uniform(random, far.first, far.second);
      share += sight_rad > near.first && sight_rad < near.second ? 1.0 / kSamples : 0.0;
    }
    EXPECT_NEAR(shares_of(front, back).back, share, 0.03);
  }
}

TEST(Occlusion, TurnedSceneGivesTheSameShare) {
  const Box front = box_at({20.0, 1.5}, 4.6, 1.8), back = box_at({50.0, 2.0}, 4.6, 1.8);
  const double share = shares_of(front, back).back;
  EXPECT_GT(share, 0.2);
  for (const double turn_rad : {1.0, 2.0, 3.0, 3.14, -2.5}) {
    const auto turned = [turn_rad](Box b) {
      const Eigen::Vector2d from = support::eigen(kOccludedFrom_m);
      b.centre_m = from + support::rotation(turn_rad) * (b.centre_m - from);
      b.heading_rad += turn_rad;
      return b;
    };
    EXPECT_NEAR(shares_of(turned(front), turned(back)).back, share, 1e-9) << turn_rad;
  }
}

TEST(Occlusion, ObjectsBeyondTheCapacityAndAroundTheSensorAreLeftOutAndNothingIsAllocated) {
  Occlusion occlusion(2);
  const auto before = runtime::counted_allocations();
  for (int scan = 0; scan < 3; ++scan) {
    const runtime::CountAllocations counting;
    occlusion.begin_scan(kOccludedFrom_m);
    occlusion.add(1, 1.0, box_at({2.5, 1.0}, 4.6, 1.8));
    occlusion.add(2, 1.0, box_at({20.0, 1.0}, 4.6, 1.8));
    occlusion.add(3, 1.0, box_at({60.0, 1.0}, 4.6, 1.8));
    occlusion.add(4, 1.0, box_at({10.0, 1.0}, 4.6, 1.8));
    EXPECT_EQ(occlusion.hidden_share(1), 0.0);
    EXPECT_LT(occlusion.hidden_share(2), 0.01) << "the fourth has no room";
    EXPECT_GT(occlusion.hidden_share(3), 0.95);
    EXPECT_EQ(occlusion.hidden_share(4), 0.0);
    EXPECT_EQ(occlusion.hidden_share(99), 0.0);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::tracking
