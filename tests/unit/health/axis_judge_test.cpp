#include "services/health/core/axis_judge.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"

namespace boresight::health {
namespace {

constexpr double kTolerance_rad = 1.5 * kRadiansPerDegree;
constexpr double kLimit_rad = 3.0 * kRadiansPerDegree;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
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
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad, kLimit_rad);
  feed(judge, 1.4, 0.01, 60.0, kSecond);
  EXPECT_FALSE(judge.tolerance().is_beyond());
}

TEST(AxisJudge, IsBeyondAfterItsTimeAndNotBefore) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad, kLimit_rad);
  const std::int64_t t = feed(judge, -2.5, 0.02, 0.8, kSecond);
  EXPECT_FALSE(judge.tolerance().is_beyond());
  feed(judge, -2.5, 0.02, 0.4, t);
  EXPECT_TRUE(judge.tolerance().is_beyond());
  EXPECT_EQ(judge.health().beyond_tolerance, 1);
  EXPECT_NEAR(judge.health().error_rad, -2.5 * kRadiansPerDegree, 1e-6);
}

TEST(AxisJudge, UncertainEstimateChangesNoVerdict) {
  AxisJudge judge(Config{.confidence = 0.99, .set_s = 1.0, .faults = {}}, kTolerance_rad, kLimit_rad);
  feed(judge, 2.5, 0.5, 60.0, kSecond);  // P = Φ(1.0/0.5) = 97.7 %
  EXPECT_FALSE(judge.tolerance().is_beyond());
  feed(judge, 2.5, 0.42, 60.0, 100 * kSecond);  // P = Φ(1.0/0.42) = 99.1 %
  EXPECT_TRUE(judge.tolerance().is_beyond());
}

TEST(AxisJudge, ShortExcursionChangesNoVerdict) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad, kLimit_rad);
  std::int64_t t = kSecond;
  for (int i = 0; i < 20; ++i) {
    t = feed(judge, 2.5, 0.02, 0.8, t);
    t = feed(judge, 1.0, 0.02, 0.2, t);
  }
  EXPECT_FALSE(judge.tolerance().is_beyond());
}

TEST(AxisJudge, HysteresisKeepsTheVerdictAtTheTolerance) {
  AxisJudge judge(Config{.set_s = 1.0, .clear_s = 5.0, .clear_ratio = 0.9, .faults = {}}, kTolerance_rad, kLimit_rad);
  std::int64_t t = feed(judge, 2.0, 0.02, 2.0, kSecond);
  ASSERT_TRUE(judge.tolerance().is_beyond());
  t = feed(judge, 1.4, 0.02, 60.0, t);  // within, but over 0.9 · 1.5°
  EXPECT_TRUE(judge.tolerance().is_beyond());
  t = feed(judge, 1.2, 0.02, 4.5, t);
  EXPECT_TRUE(judge.tolerance().is_beyond());
  feed(judge, 1.2, 0.02, 1.0, t);
  EXPECT_FALSE(judge.tolerance().is_beyond());
}

TEST(AxisJudge, UnobservableEstimateChangesNothing) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad, kLimit_rad);
  std::int64_t t = feed(judge, 2.5, 0.02, 2.0, kSecond);
  ASSERT_TRUE(judge.tolerance().is_beyond());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 100; ++i) {
    t += kSecond;
    judge.update(0.0, 1e-4, false, t);
    judge.update(nan, 1e-4, true, t);
    judge.update(0.0, nan, true, t);
    judge.update(0.0, -1.0, true, t);
  }
  EXPECT_TRUE(judge.tolerance().is_beyond());
  EXPECT_EQ(judge.health().observable, 0);
  EXPECT_NEAR(judge.health().error_rad, 2.5 * kRadiansPerDegree, 1e-6);
}

TEST(AxisJudge, EffectNamesToleranceAndLimitAfterTheirTime) {
  AxisJudge judge(Config{.set_s = 1.0, .clear_s = 1.0, .faults = {}}, kTolerance_rad, kLimit_rad);
  EXPECT_EQ(judge.health().effect, AxisEffect::kUnknown);
  std::int64_t t = feed(judge, 1.0, 0.02, 2.0, kSecond);
  EXPECT_EQ(judge.health().effect, AxisEffect::kCompensated);
  t = feed(judge, 2.9, 0.02, 2.0, t);
  EXPECT_EQ(judge.health().effect, AxisEffect::kReduced);
  t = feed(judge, 3.1, 0.02, 0.8, t);
  EXPECT_EQ(judge.health().effect, AxisEffect::kReduced) << "set_s has not passed";
  t = feed(judge, 3.1, 0.02, 0.4, t);
  EXPECT_EQ(judge.health().effect, AxisEffect::kNotAvailable);
  EXPECT_NEAR(judge.health().limit_rad, kLimit_rad, 1e-6);
}

TEST(AxisJudge, LimitHasHysteresisAndNeedsConfidence) {
  AxisJudge judge(Config{.set_s = 1.0, .clear_s = 5.0, .clear_ratio = 0.9, .faults = {}}, kTolerance_rad, kLimit_rad);
  std::int64_t t = feed(judge, 3.2, 0.15, 10.0, kSecond);  // P = Φ(0.2/0.15) = 91 %
  EXPECT_FALSE(judge.limit().is_beyond());
  t = feed(judge, 3.2, 0.02, 2.0, t);
  ASSERT_TRUE(judge.limit().is_beyond());
  t = feed(judge, 2.8, 0.02, 60.0, t);  // within, but over 0.9 · 3°
  EXPECT_EQ(judge.health().effect, AxisEffect::kNotAvailable);
  t = feed(judge, 2.5, 0.02, 4.5, t);
  EXPECT_EQ(judge.health().effect, AxisEffect::kNotAvailable);
  feed(judge, 2.5, 0.02, 1.0, t);
  EXPECT_EQ(judge.health().effect, AxisEffect::kReduced) << "the tolerance is still exceeded";
}

TEST(AxisJudge, RestoredLimitStandsUntilTheAxisIsClearlyWithin) {
  const Config config{.set_s = 1.0, .clear_s = 1.0, .clear_ratio = 0.9, .faults = {}};
  AxisJudge judge(config, kTolerance_rad, kLimit_rad);
  judge.restore_beyond_tolerance();
  judge.restore_beyond_limit();
  std::int64_t t = feed(judge, 2.8, 0.02, 10.0, kSecond);
  EXPECT_EQ(judge.limit().verdict(), TestResult::kNone) << "within the limit, but over 0.9 · 3°";
  t = feed(judge, 2.5, 0.02, 2.0, t);
  EXPECT_EQ(judge.limit().verdict(), TestResult::kPassed);
  AxisJudge fresh(config, kTolerance_rad, kLimit_rad);
  feed(fresh, 2.8, 0.02, 10.0, kSecond);
  EXPECT_EQ(fresh.limit().verdict(), TestResult::kPassed) << "without an earlier verdict";
}

TEST(AxisJudge, FirstVerdictOfWithinNeedsAnEstimateThatCanTell) {
  AxisJudge judge(Config{.set_s = 1.0, .clear_s = 1.0, .faults = {}}, kTolerance_rad, kLimit_rad);
  std::int64_t t = feed(judge, 0.0, 0.7, 10.0, kSecond);
  EXPECT_EQ(judge.tolerance().verdict(), TestResult::kNone) << "P(|e| > 1.5°) = 3.2 %";
  EXPECT_EQ(judge.limit().verdict(), TestResult::kPassed) << "P(|e| > 3°) = 0.002 %";
  EXPECT_EQ(judge.health().effect, AxisEffect::kUnknown);
  feed(judge, 0.0, 0.5, 2.0, t);
  EXPECT_EQ(judge.health().effect, AxisEffect::kCompensated);
}

TEST(AxisJudge, InfiniteThresholdGivesNoVerdict) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kInfinity, kInfinity);
  feed(judge, 45.0, 0.02, 60.0, kSecond);
  EXPECT_EQ(judge.health().effect, AxisEffect::kUnknown);
  EXPECT_EQ(judge.health().beyond_tolerance_probability, 0.0F);
}

TEST(AngleJudge, VerdictIsThatOfEitherAxisAndTheWorseAxisIsNamed) {
  const Config config{.set_s = 1.0, .clear_s = 1.0, .faults = {}};
  AngleJudge angle{{config, kTolerance_rad, kLimit_rad}, {config, 2.0 * kTolerance_rad, 2.0 * kLimit_rad}};
  std::int64_t t = feed(angle.sensor, 2.0, 0.02, 2.0, kSecond);
  feed(angle.vehicle, 1.0, 0.02, 2.0, kSecond);
  EXPECT_EQ(angle.health().effect, AxisEffect::kReduced);
  EXPECT_EQ(angle.health().about_vehicle_axis, 0);
  feed(angle.vehicle, 6.5, 0.02, 2.0, t);
  EXPECT_EQ(angle.health().effect, AxisEffect::kNotAvailable);
  EXPECT_EQ(angle.health().about_vehicle_axis, 1);
  EXPECT_NEAR(angle.health().error_rad, 6.5 * kRadiansPerDegree, 1e-6);
}

// The expected numbers are the normal distribution function in 50 digits, computed by another program.
TEST(ExceedanceProbability, AgreesWithIndependentNumbers) {
  EXPECT_NEAR(exceedance_probability(0.0, 1.0, 1.0), 0.317310507862914, 1e-12);
  EXPECT_NEAR(exceedance_probability(1.5, 1.0, 1.0), 0.697672126599789, 1e-12);
  EXPECT_NEAR(exceedance_probability(-1.5, 1.0, 1.0), 0.697672126599789, 1e-12);
  EXPECT_NEAR(exceedance_probability(4.0, 1.0, 1.5), 0.993790353663786, 1e-12);
  EXPECT_NEAR(exceedance_probability(1.0, 0.25, 2.0), 3.16712418331199e-05, 1e-15);
}

TEST(ExceedanceProbability, IsThatOfACertainErrorWithoutStdAndZeroForAnInfiniteThreshold) {
  EXPECT_EQ(exceedance_probability(2.0, 0.0, 1.5), 1.0);
  EXPECT_EQ(exceedance_probability(-1.0, 0.0, 1.5), 0.0);
  EXPECT_EQ(exceedance_probability(5.0, 0.1, kInfinity), 0.0);
}

TEST(AxisJudge, ClockThatJumpedBackDelaysNothing) {
  AxisJudge judge(Config{.set_s = 1.0, .faults = {}}, kTolerance_rad, kLimit_rad);
  feed(judge, 2.5, 0.02, 0.6, 1000 * kSecond);
  feed(judge, 2.5, 0.02, 1.2, kSecond);
  EXPECT_TRUE(judge.tolerance().is_beyond());
}

}  // namespace
}  // namespace boresight::health
