#include "services/boresight/track/gospa_score.hpp"

#include <cmath>

#include <gmock/gmock.h>

namespace boresight::track {
namespace {

using judge::GospaBase;
using ::testing::HasSubstr;

/// A circle of radius r_m.
ExtendedObject circle(double x_m, double y_m, double r_m = 1.0) {
  ExtendedObject object;
  object.ellipse = {{x_m, y_m}, r_m * r_m * Eigen::Matrix2d::Identity()};
  return object;
}

/// Means over the steps, in the order total, localisation, missed, false.
void expect_mean(const GospaScore& score, double localisation, double missed, double false_tracks) {
  const judge::GospaParts mean = score.mean();
  EXPECT_NEAR(mean.localisation, localisation, 1e-9);
  EXPECT_NEAR(mean.missed, missed, 1e-9);
  EXPECT_NEAR(mean.false_tracks, false_tracks, 1e-9);
  EXPECT_NEAR(mean.total(), localisation + missed + false_tracks, 1e-9);
}

TEST(GospaOfTables, IsTheDistanceOfCentresForEqualExtents) {
  const ObjectsByStep truth = {{circle(0, 0)}}, estimates = {{circle(3, 0)}};
  expect_mean(score_gospa(truth, estimates, GospaBase::kSquared), 9.0, 0.0, 0.0);
  expect_mean(score_gospa(truth, estimates, GospaBase::kRoot), 3.0, 0.0, 0.0);
}

TEST(GospaOfTables, ContainsTheDifferenceOfExtents) {
  // Circles of radii 2 and 1: tr(4 I + I − 2 · 2 I) = 2.
  const ObjectsByStep truth = {{circle(0, 0, 2)}}, estimates = {{circle(0, 1, 1)}};
  expect_mean(score_gospa(truth, estimates, GospaBase::kSquared), 3.0, 0.0, 0.0);
  expect_mean(score_gospa(truth, estimates, GospaBase::kRoot), std::sqrt(3.0), 0.0, 0.0);
}

TEST(GospaOfTables, CutOffDependsOnTheBaseDistance) {
  // 5 m apart: 25 m² is beyond 20 m², 5 m is within 20 m.
  const ObjectsByStep truth = {{circle(0, 0)}}, estimates = {{circle(3, 4)}};
  expect_mean(score_gospa(truth, estimates, GospaBase::kSquared), 0.0, 10.0, 10.0);
  expect_mean(score_gospa(truth, estimates, GospaBase::kRoot), 5.0, 0.0, 0.0);
}

TEST(GospaOfTables, AssignsTheCheapestPairs) {
  // Crosswise pairs cost 9 + 1, straight ones 1 + 1.
  const ObjectsByStep truth = {{circle(0, 0), circle(2, 0)}}, estimates = {{circle(3, 0), circle(1, 0)}};
  expect_mean(score_gospa(truth, estimates, GospaBase::kSquared), 2.0, 0.0, 0.0);
}

TEST(GospaOfTables, IsTheMeanOverTheStepsOfTheTruth) {
  // Step 1: a pair of 1 m; step 2: an object without estimate; step 3: an estimate only; step 4: nothing at all.
  const ObjectsByStep truth = {{circle(0, 0)}, {circle(0, 0)}, {}, {}};
  const ObjectsByStep estimates = {{circle(1, 0)}, {}, {circle(0, 0)}};
  expect_mean(score_gospa(truth, estimates, GospaBase::kSquared), 0.25, 2.5, 2.5);
  // Steps after the last of the truth do not count.
  const ObjectsByStep shorter = {{circle(0, 0)}};
  expect_mean(score_gospa(shorter, estimates, GospaBase::kSquared), 1.0, 0.0, 0.0);
}

TEST(GospaText, HasARowForEachBaseAndOnRequestForEachStep) {
  const ObjectsByStep truth = {{circle(0, 0)}, {circle(0, 0)}}, estimates = {{circle(3, 0)}, {}};
  const std::vector<GospaScore> scores = {score_gospa(truth, estimates, GospaBase::kSquared),
                                          score_gospa(truth, estimates, GospaBase::kRoot)};
  EXPECT_EQ(gospa_text(scores, false),
            "step  base distance     GOSPA   localisation   missed    false\n"
            "mean  squared (m²)      9.500          4.500    5.000    0.000\n"
            "mean  true (m)          6.500          1.500    5.000    0.000\n");
  EXPECT_THAT(gospa_text(scores, true), HasSubstr("\n1     squared (m²)      9.000          9.000    0.000    0.000\n"
                                                  "1     true (m)          3.000          3.000    0.000    0.000\n"
                                                  "2     squared (m²)     10.000          0.000   10.000    0.000\n"));
}

}  // namespace
}  // namespace boresight::track
