#include "services/health/core/axis_judge.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"

namespace boresight::health {
namespace {

constexpr double kTolerance_rad = 1.5 * kRadiansPerDegree;
constexpr std::int64_t kSecond = 1'000'000'000;

/// Feeds the same estimate five times a second.
std::int64_t feed(AxisJudge& judge, double error_deg, double std_deg, double seconds, std::int64_t from_ns) {
  const std::int64_t end_ns = from_ns + static_cast<std::int64_t>(seconds * 1e9);
  std::int64_t t = from_ns;
  for (; t <= end_ns; t += kSecond / 5)
    judge.update(error_deg * kRadiansPerDegree, std_deg * kRadiansPerDegree, true, t);
  return t;
}

TEST(AxisJudge, IsNotBeyondWithinTolerance) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad);
  feed(judge, 1.4, 0.01, 60.0, kSecond);
  EXPECT_FALSE(judge.is_beyond());
}

TEST(AxisJudge, IsBeyondAfterItsTimeAndNotBefore) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad);
  const std::int64_t t = feed(judge, -2.5, 0.02, 0.8, kSecond);
  EXPECT_FALSE(judge.is_beyond());
  feed(judge, -2.5, 0.02, 0.4, t);
  EXPECT_TRUE(judge.is_beyond());
  EXPECT_EQ(judge.health().beyond_tolerance, 1);
  EXPECT_NEAR(judge.health().error_rad, -2.5 * kRadiansPerDegree, 1e-6);
}

TEST(AxisJudge, UncertainEstimateChangesNoVerdict) {
  AxisJudge judge(Config{.confidence_sigma = 2.33, .set_s = 1.0, .faults = {}}, kTolerance_rad);
  feed(judge, 2.5, 0.5, 60.0, kSecond);  // 2.5° − 2.33 · 0.5° < 1.5°
  EXPECT_FALSE(judge.is_beyond());
  feed(judge, 2.5, 0.42, 60.0, 100 * kSecond);  // 1.52° > 1.5°
  EXPECT_TRUE(judge.is_beyond());
}

TEST(AxisJudge, ShortExcursionChangesNoVerdict) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad);
  std::int64_t t = kSecond;
  for (int i = 0; i < 20; ++i) {
    t = feed(judge, 2.5, 0.02, 0.8, t);
    t = feed(judge, 1.0, 0.02, 0.2, t);
  }
  EXPECT_FALSE(judge.is_beyond());
}

TEST(AxisJudge, HysteresisKeepsTheVerdictAtTheTolerance) {
  AxisJudge judge(Config{.set_s = 1.0, .clear_s = 5.0, .clear_ratio = 0.9, .faults = {}}, kTolerance_rad);
  std::int64_t t = feed(judge, 2.0, 0.02, 2.0, kSecond);
  ASSERT_TRUE(judge.is_beyond());
  t = feed(judge, 1.4, 0.02, 60.0, t);  // within, but over 0.9 · 1.5°
  EXPECT_TRUE(judge.is_beyond());
  t = feed(judge, 1.2, 0.02, 4.5, t);
  EXPECT_TRUE(judge.is_beyond());
  feed(judge, 1.2, 0.02, 1.0, t);
  EXPECT_FALSE(judge.is_beyond());
}

TEST(AxisJudge, UnobservableEstimateChangesNothing) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad);
  std::int64_t t = feed(judge, 2.5, 0.02, 2.0, kSecond);
  ASSERT_TRUE(judge.is_beyond());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 100; ++i) {
    t += kSecond;
    judge.update(0.0, 1e-4, false, t);
    judge.update(nan, 1e-4, true, t);
    judge.update(0.0, nan, true, t);
    judge.update(0.0, -1.0, true, t);
  }
  EXPECT_TRUE(judge.is_beyond());
  EXPECT_EQ(judge.health().observable, 0);
  EXPECT_NEAR(judge.health().error_rad, 2.5 * kRadiansPerDegree, 1e-6);
}

TEST(AxisJudge, IsInhibitedFarBeyondTolerance) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad);
  feed(judge, 7.2, 0.02, 2.0, kSecond);
  EXPECT_TRUE(judge.is_beyond());
  EXPECT_FALSE(judge.is_inhibited());
  feed(judge, 7.4, 0.02, 2.0, 10 * kSecond);
  EXPECT_TRUE(judge.is_inhibited());
}

TEST(AxisJudge, ClockThatJumpedBackDelaysNothing) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad);
  feed(judge, 2.5, 0.02, 0.6, 1000 * kSecond);
  feed(judge, 2.5, 0.02, 1.2, kSecond);
  EXPECT_TRUE(judge.is_beyond());
}

}  // namespace
}  // namespace boresight::health
