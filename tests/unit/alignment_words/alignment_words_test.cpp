#include "services/common/alignment_words/alignment_words.hpp"

#include <set>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"

namespace boresight::alignment_words {
namespace {

constexpr std::size_t kNumberOfReasons = 11, kNumberOfFindings = 14;

/// Four corner radars.
VehicleConfig four_corners() {
  VehicleConfig vehicle;
  const auto add = [&](std::uint32_t id, const char* name, double x_m, double y_m) {
    RadarConfig radar;
    radar.id = id;
    radar.name = name;
    radar.mounting_pose.position_m = {x_m, y_m, 0.5};
    vehicle.radars.push_back(radar);
  };
  add(1, "front_left", 3.6, 0.8);
  add(2, "front_right", 3.6, -0.8);
  add(3, "rear_left", -0.9, 0.8);
  return vehicle;
}

std::string sentence(AlignmentFinding kind, double value = 0.0, std::uint32_t other = 0) {
  return sentence_of({kind, value, other}, 1, four_corners());
}

TEST(FindingSentence, NamesBothRadarsAndSidesOfASwap) {
  EXPECT_EQ(sentence(AlignmentFinding::kRadarsSwapped, 0.0, 2),
            "left and right radars swapped: 'front_left' sees what 'front_right' should see");
  EXPECT_EQ(sentence(AlignmentFinding::kRadarsSwapped, 0.0, 3),
            "front and rear radars swapped: 'front_left' sees what 'rear_left' should see");
}

TEST(FindingSentence, NamesTheAngleOfAWrongNominalYaw) {
  EXPECT_EQ(sentence(AlignmentFinding::kNominalYawWrong, 89.8 * kRadiansPerDegree),
            "nominal yaw of 'front_left' is wrong by +90°");
}

TEST(FindingSentence, NamesTheUnitOfTheSpeedSignal) {
  EXPECT_EQ(sentence(AlignmentFinding::kSpeedUnit, 3.604), "speed signal in km/h (3.6 times too large)");
  EXPECT_EQ(sentence(AlignmentFinding::kSpeedUnit, 2.24), "speed signal in mph (2.24 times too large)");
  EXPECT_EQ(sentence(AlignmentFinding::kSpeedUnit, 0.5), "unit of the speed signal wrong: 0.5 times the true value");
  EXPECT_EQ(sentence(AlignmentFinding::kYawRateUnit, 57.3), "yaw rate in °/s (57.3 times too large)");
}

TEST(FindingSentence, IsDifferentForEachFindingAndEmptyWithoutOne) {
  std::set<std::string> sentences;
  std::set<std::string_view> keys;
  for (std::size_t i = 0; i < kNumberOfFindings; ++i) {
    const auto kind = static_cast<AlignmentFinding>(i);
    sentences.insert(sentence(kind, 3.6, 2));
    keys.insert(key_of(kind));
  }
  EXPECT_EQ(sentences.size(), kNumberOfFindings);
  EXPECT_EQ(sentences.count(""), 1U);
  EXPECT_EQ(keys.size(), kNumberOfFindings);
  EXPECT_EQ(keys.count("?"), 0U);
}

TEST(ReasonWords, AreDifferentForEachReasonAndEmptyWithoutOne) {
  std::set<std::string_view> words, keys;
  for (std::size_t i = 0; i < kNumberOfReasons; ++i) {
    words.insert(words_of(static_cast<AlignmentReason>(i)));
    keys.insert(key_of(static_cast<AlignmentReason>(i)));
  }
  EXPECT_EQ(words.size(), kNumberOfReasons);
  EXPECT_EQ(words_of(AlignmentReason::kNone), "");
  EXPECT_EQ(keys.size(), kNumberOfReasons);
  EXPECT_EQ(keys.count("?"), 0U);
}

TEST(ReasonWords, AreTheFindingIfThereIsOne) {
  AlignmentEstimate estimate{};
  estimate.header.source_id = 1;
  estimate.reason = AlignmentReason::kWrongInput;
  estimate.finding = AlignmentFinding::kSpeedZero;
  EXPECT_EQ(reason_of(estimate, four_corners()), "speed signal is zero although the vehicle moves");
  estimate.finding = AlignmentFinding::kNone;
  estimate.reason = AlignmentReason::kTooSlow;
  EXPECT_EQ(reason_of(estimate, four_corners()), "the vehicle is too slow");
}

TEST(AngleText, HasTwoSignificantDigitsOfTheStd) {
  EXPECT_EQ(angle_text(2.4903 * kRadiansPerDegree, 0.0213 * kRadiansPerDegree), "+2.490 ± 0.021°");
  EXPECT_EQ(angle_text(-0.004 * kRadiansPerDegree, 0.31 * kRadiansPerDegree), "+0.00 ± 0.31°");
}

AxisHealth axis(double error_deg, double std_deg, double tolerance_deg, bool beyond) {
  AxisHealth health{};
  health.error_rad = static_cast<float>(error_deg * kRadiansPerDegree);
  health.std_rad = static_cast<float>(std_deg * kRadiansPerDegree);
  health.tolerance_rad = static_cast<float>(tolerance_deg * kRadiansPerDegree);
  health.observable = 1;
  health.beyond_tolerance = beyond ? 1 : 0;
  return health;
}

TEST(BeyondTolerance, NamesTheAxisThatIsBeyondWithItsOwnTolerance) {
  EXPECT_EQ(beyond_tolerance(axis(0.0, 0.03, 1.5, false), axis(0.1, 0.05, 1.5, false), axis(4.2, 0.21, 3.0, true)),
            "roll +4.20 ± 0.21°, reduced: beyond 3°");
  EXPECT_EQ(beyond_tolerance(axis(1.7, 0.03, 1.5, true), axis(-2.0, 0.05, 1.5, true), axis(0.0, 0.2, 3.0, false)),
            "yaw +1.700 ± 0.030°, reduced: beyond 1.5°; pitch -2.000 ± 0.050°, reduced: beyond 1.5°");
}

TEST(BeyondTolerance, NamesTheLimitOfAnAxisThatIsBeyondIt) {
  AxisHealth yaw = axis(-3.4, 0.03, 1.5, true);
  yaw.limit_rad = static_cast<float>(3.0 * kRadiansPerDegree);
  yaw.effect = AxisEffect::kNotAvailable;
  EXPECT_EQ(beyond_tolerance(yaw, {}, {}), "yaw -3.400 ± 0.030°, not available: beyond 3°");
}

TEST(Consequences, NamesThoseThatDoNotRoundToZero) {
  SensorHealth sensor{};
  sensor.lateral_displacement_m = -4.36F;
  sensor.reference_range_m = 100.0F;
  sensor.velocity_error_mps = std::nanf("");  // the speed is not known
  EXPECT_EQ(consequences(sensor), "4.4 m at 100 m");
  sensor.lost_coverage_ratio = 0.031F;
  sensor.range_loss_ratio = 0.012F;
  sensor.velocity_error_mps = 0.87F;
  EXPECT_EQ(consequences(sensor),
            "4.4 m at 100 m, 3 % of the view lost, 1 % of the range lost, velocities wrong by 0.9 m/s");
}

TEST(ChangeSentence, NamesSizeAndDirection) {
  EXPECT_EQ(load_change_sentence({}), "");
  EXPECT_EQ(load_change_sentence({1, static_cast<float>(-0.8 * kRadiansPerDegree), 1}),
            "load changed the vehicle's pitch by -0.80° (nose down)");
  EXPECT_EQ(speed_change_sentence({1, 0.012F, 1}), "scale of the speed signal changed by +1.20 %");
}

TEST(DriftSentence, NamesTheAxesThatDrift) {
  constexpr auto kPerMinute = static_cast<float>(kRadiansPerDegree / 60.0);
  EXPECT_EQ(drift_sentence({}), "");
  EXPECT_EQ(drift_sentence({1, 0.13F * kPerMinute, 0.012F * kPerMinute, 0.01F * kPerMinute, 0.02F * kPerMinute}),
            "yaw drifts by +0.130 ± 0.012°/min");
  EXPECT_EQ(drift_sentence({1, 0.0F, 0.012F * kPerMinute, 0.2F * kPerMinute, 0.02F * kPerMinute}),
            "pitch drifts by +0.200 ± 0.020°/min");
}

TEST(Explanation, IsTheReasonOnlyIfNothingElseIsToBeSaid) {
  SensorHealth sensor{};
  sensor.radar_id = 1;
  sensor.reason = AlignmentReason::kLargeStd;
  EXPECT_EQ(explanation_of(sensor, four_corners()), "the standard deviation is still above the configured one");
  sensor.roll = axis(4.2, 0.21, 3.0, true);
  sensor.reference_range_m = 100.0F;
  sensor.lost_coverage_ratio = 0.02F;
  EXPECT_EQ(explanation_of(sensor, four_corners()),
            "roll +4.20 ± 0.21°, reduced: beyond 3°; 0.0 m at 100 m, 2 % of the view lost");
}

}  // namespace
}  // namespace boresight::alignment_words
