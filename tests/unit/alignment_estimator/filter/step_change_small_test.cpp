// The detector of small changes alone: deviations of four radars as numbers.
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "services/alignment_estimator/core/filter/small_step_change_detector.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::alignment {
namespace {

constexpr double kScan_s = 0.05;

/// Scans of four radars with realistic information: σ over 2 s of 0.015° in yaw, 0.15° in pitch and 3° in roll.
struct Drive {
  explicit Drive(std::size_t radars = 4) : number(radars), detector(radars, FilterConfig{}) {
    const Eigen::Vector3d std_2s = Eigen::Vector3d(3.0, 0.15, 0.015) * kRadiansPerDegree;
    information = (std_2s.array().square() * 40.0).inverse().matrix().asDiagonal();
    covariance = (Eigen::Vector3d(0.3, 0.02, 0.003) * kRadiansPerDegree).array().square().matrix().asDiagonal();
  }

  struct Found {
    std::size_t radar;
    double after_s;
  };
  /// The first confirmed change within `seconds`, while the radars deviate by the columns of `off_rad`.
  std::optional<Found> run(double seconds, const Eigen::Matrix<double, 3, 4>& off_rad) {
    const double begin_s = time_s;
    for (; time_s < begin_s + seconds; time_s += kScan_s) {
      for (std::size_t r = 0; r < number; ++r) {
        Eigen::Vector3d noise;
        for (Eigen::Index i = 0; i < 3; ++i) noise(i) = std::sqrt(information(i, i)) * gauss(random);
        const Eigen::Vector3d score = information * off_rad.col(static_cast<Eigen::Index>(r)) + noise;
        const std::uint32_t changed =
            detector.add(r, static_cast<std::int64_t>(time_s * 1e9), information, score, covariance);
        for (std::size_t q = 0; q < number; ++q) {
          if ((changed >> q & 1u) != 0) return Found{q, time_s - begin_s};
        }
      }
    }
    return std::nullopt;
  }

  std::size_t number;
  SmallStepChangeDetector detector;
  Eigen::Matrix3d information, covariance;
  std::mt19937_64 random{7};
  std::normal_distribution<double> gauss;
  double time_s = 10.0;
};

Eigen::Matrix<double, 3, 4> only(Eigen::Index radar, const Eigen::Vector3d& off_deg) {
  Eigen::Matrix<double, 3, 4> off = Eigen::Matrix<double, 3, 4>::Zero();
  off.col(radar) = off_deg * kRadiansPerDegree;
  return off;
}
const Eigen::Matrix<double, 3, 4> kQuiet = Eigen::Matrix<double, 3, 4>::Zero();

TEST(SmallStepChange, SmallStepsOfOneRadarAreFoundWithTheirAxisAndSize) {
  struct Case {
    std::size_t axis;
    double off_deg, within_s;
  };
  for (const Case& one : {Case{2, 0.5, 8.0}, Case{2, -0.25, 8.0}, Case{1, 1.0, 8.0}, Case{1, -0.5, 40.0}}) {
    Drive drive;
    ASSERT_FALSE(drive.run(60.0, kQuiet));
    Eigen::Vector3d off = Eigen::Vector3d::Zero();
    off(static_cast<Eigen::Index>(one.axis)) = one.off_deg;
    const auto found = drive.run(60.0, only(2, off));
    ASSERT_TRUE(found) << one.off_deg;
    EXPECT_EQ(found->radar, 2u);
    EXPECT_LT(found->after_s, one.within_s);
    EXPECT_TRUE(drive.detector.changed(2, one.axis));
    EXPECT_FALSE(drive.detector.changed(2, 3 - one.axis));
    const double sigma_deg = one.axis == 1 ? 0.2 : 0.03;
    EXPECT_NEAR(drive.detector.change(2)(static_cast<Eigen::Index>(one.axis)), one.off_deg * kRadiansPerDegree,
                3.0 * sigma_deg * kRadiansPerDegree);
  }
}

TEST(SmallStepChange, RollIsFoundLaterBecauseItsDataAreWeaker) {
  Drive drive;
  ASSERT_FALSE(drive.run(60.0, kQuiet));
  const auto found = drive.run(600.0, only(1, {3.0, 0.0, 0.0}));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->radar, 1u);
  EXPECT_GT(found->after_s, 60.0);
  EXPECT_TRUE(drive.detector.changed(1, 0));
  EXPECT_FALSE(drive.detector.doubted(1));
}

TEST(SmallStepChange, NoiseAndCommonDeviationsAreNoChange) {
  Drive drive;
  EXPECT_FALSE(drive.run(3600.0, kQuiet));
  Eigen::Matrix<double, 3, 4> all;
  all.colwise() = Eigen::Vector3d(0.0, 1.0, -0.3) * kRadiansPerDegree;
  EXPECT_FALSE(drive.run(600.0, all));
}

TEST(SmallStepChange, ADeviationWithinTheCovarianceIsNoChange) {
  Drive drive;
  drive.covariance = (Eigen::Vector3d(4.0, 4.0, 0.5) * kRadiansPerDegree).array().square().matrix().asDiagonal();
  EXPECT_FALSE(drive.run(300.0, only(0, {3.0, 1.0, 0.25})));
}

TEST(SmallStepChange, OneLargeWindowOrAShortDeviationIsDropped) {
  Drive drive;
  drive.time_s = 10.0;
  EXPECT_FALSE(drive.run(2.0, only(0, {0.0, 0.0, 5.0})));
  EXPECT_FALSE(drive.run(60.0, kQuiet));
  EXPECT_FALSE(drive.detector.doubted(0));
  // Two windows: a suspicion, which the next one does not confirm.
  drive.time_s = 100.0;
  EXPECT_FALSE(drive.run(4.1, only(0, {0.0, 0.0, 0.3})));
  EXPECT_TRUE(drive.detector.doubted(0));
  EXPECT_FALSE(drive.run(60.0, kQuiet));
  EXPECT_FALSE(drive.detector.doubted(0));
}

TEST(SmallStepChange, ASingleRadarNeedsALargerDeviation) {
  Drive alone(1);
  EXPECT_FALSE(alone.run(300.0, only(0, {0.0, 0.2, 0.1})));
  EXPECT_TRUE(alone.run(30.0, only(0, {0.0, 0.0, 0.5})));
}

TEST(SmallStepChange, WithTwoRadarsTheDeviatingOneIsReported) {
  Drive two(2);
  const auto found = two.run(30.0, only(1, {0.0, 0.0, 0.25}));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->radar, 1u);
}

TEST(SmallStepChange, NotANumberSpoilsNothingElse) {
  Drive drive;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto found = drive.run(60.0, only(3, {nan, nan, nan}));
  EXPECT_FALSE(found);
  EXPECT_FALSE(drive.detector.doubted(3));
  const auto after = drive.run(60.0, only(3, {0.0, 0.0, 0.25}));
  ASSERT_TRUE(after);
  EXPECT_EQ(after->radar, 3u);
}

TEST(SmallStepChange, ANewEstimateClearsTheSums) {
  Drive drive;
  EXPECT_FALSE(drive.run(4.1, only(0, {0.0, 0.0, 0.3})));
  EXPECT_TRUE(drive.detector.doubted(0));
  drive.detector.clear(0);
  EXPECT_FALSE(drive.detector.doubted(0));
  EXPECT_EQ(drive.detector.sum(0, 2), 0.0);
}

}  // namespace
}  // namespace boresight::alignment
