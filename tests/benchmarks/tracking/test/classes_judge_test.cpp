// Class figures on hand-made lists.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/benchmarks/tracking/classes/judge/class_judge.hpp"

namespace boresight::bench::tracking {
namespace {

constexpr std::size_t kPedestrian = 0, kTwoWheeler = 1, kCar = 2, kVan = 3, kTruck = 4;

ReportedClasses sure_of(std::size_t which) {
  ReportedClasses p{};
  p[which] = 1.0;
  return p;
}

/// One object of each class, each with one track and as many lists.
ClassJudge all_right() {
  ClassJudge judge;
  for (std::uint32_t k = 0; k < kClassNames.size(); ++k) {
    for (int list = 0; list < 4; ++list) judge.add(k, k, k, 2.0, sure_of(k));
  }
  judge.end_drive();
  return judge;
}

TEST(ClassJudge, RightAndSureIsPerfect) {
  const ClassFigures f = class_figures(all_right());
  EXPECT_EQ(f.balanced_accuracy, 1.0);
  EXPECT_EQ(f.calibration.largest, 0.0);
  EXPECT_EQ(f.confusion[kTruck][kTruck], 1.0);
  EXPECT_EQ(f.cases[kVan], 1U);
}

TEST(ClassJudge, EachTrackHasOneVoteAndEachClassTheSameWeight) {
  ClassJudge judge = all_right();
  // A second car, in view for much longer, is always taken for a truck; three more trucks are right.
  for (int list = 0; list < 100; ++list) judge.add(9, 9, kCar, 2.0, sure_of(kTruck));
  for (std::uint32_t truck = 20; truck < 23; ++truck) judge.add(truck, truck, kTruck, 2.0, sure_of(kTruck));
  const ClassFigures f = class_figures(judge);
  EXPECT_NEAR(f.balanced_accuracy, (1.0 + 1.0 + 0.5 + 1.0) / 4.0, 1e-12);
  EXPECT_NEAR(f.confusion[kCar][kTruck], 0.5, 1e-12);
}

TEST(ClassJudge, VansAreNotJudged) {
  ClassJudge judge = all_right();
  for (std::uint32_t van = 20; van < 30; ++van) judge.add(van, van, kVan, 2.0, sure_of(kPedestrian));
  EXPECT_EQ(class_figures(judge).balanced_accuracy, 1.0);
  EXPECT_EQ(class_figures(judge).calibration.largest, 0.0);
  // A car that may be a van is a car, if it is none.
  ClassJudge doubtful;
  for (const std::size_t k : {kPedestrian, kTwoWheeler, kTruck}) {
    doubtful.add(static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k), k, 2.0, sure_of(k));
  }
  doubtful.add(kCar, kCar, kCar, 2.0, {0.0, 0.0, 0.4, 0.6, 0.0});
  EXPECT_EQ(class_figures(doubtful).balanced_accuracy, 1.0);
  EXPECT_EQ(class_figures(doubtful).calibration.largest, 0.0);
}

TEST(ClassJudge, YoungTracksArePassedOver) {
  ClassJudge judge = all_right();
  judge.add(50, 50, kCar, ClassJudge::kLeastAge_s, sure_of(kTruck));
  EXPECT_EQ(class_figures(judge).balanced_accuracy, 1.0);
  EXPECT_EQ(judge.objects(), 5U);
}

TEST(ClassJudge, CalibrationErrorIsTheDifferenceOfStatedAndTrueShares) {
  // Half of the cars and half of the trucks are right, at a stated 0.9.
  ClassJudge judge;
  for (std::uint32_t i = 0; i < 8; ++i) {
    ReportedClasses p{};
    p[i < 4 ? kCar : kTruck] = 0.95;
    p[i < 4 ? kTruck : kCar] = 0.05;
    judge.add(i, i, i % 2 == 0 ? kCar : kTruck, 2.0, p);
  }
  const Calibration c = class_figures(judge).calibration;
  EXPECT_NEAR(c.largest, 0.45, 1e-12);
  // Of the four probabilities, three are near 0: 0, 0 and 0.05, and the last is true in half of the cases.
  EXPECT_NEAR(c.mean, 0.25 * 0.45 + 0.75 * (0.5 - 0.05) / 3.0, 1e-12);
}

TEST(ClassJudge, IdentitiesOfDrivesAreApart) {
  ClassJudge one = all_right();
  one.append(all_right());
  EXPECT_EQ(one.objects(), 10U);
  EXPECT_EQ(class_figures(one).cases[kCar], 2U);
  one.add(0, 0, kTruck, 2.0, sure_of(kTruck));
  EXPECT_EQ(one.objects(), 11U);
}

TEST(ClassJudge, WithoutACaseOfAClassThereIsNoFigure) {
  EXPECT_TRUE(std::isnan(class_figures(ClassJudge{}).balanced_accuracy));
  EXPECT_TRUE(std::isnan(class_figures(ClassJudge{}).calibration.largest));
  ClassJudge judge;
  judge.add(1, 1, kCar, 2.0, sure_of(kCar));
  EXPECT_TRUE(std::isnan(class_figures(judge).balanced_accuracy));
}

}  // namespace
}  // namespace boresight::bench::tracking
