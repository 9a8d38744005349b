// The rows of the planar filter: derivatives, and a score with zero mean at the truth.
#include "services/alignment_estimator/core/planar/planar_sums.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "services/alignment_estimator/core/published/planar_model.hpp"

namespace boresight::alignment::planar {
namespace {

const MountingPose kPose{{3.65, 0.75, 0.5}, 0.8, 0.05, 0.1};
const Setting kSetting{kPose, 9.0, 0.4};

Parameters example() {
  Parameters at;
  at << 1.01, 0.003, -0.02, 0.03, 0.04;
  return at;
}

TEST(PlanarRow, IsThatOfTheEquationsAndItsGradientTheNumericOne) {
  const Parameters at = example();
  for (const double azimuth : {-1.1, 0.0, 0.7}) {
    for (const double elevation : {-0.2, 0.0, 0.15}) {
      const Row row = row_of(kSetting, at, azimuth, elevation);
      const Eigen::Vector4d b(at(0), at(2), at(3), at(4));
      const published::PlanarModel model(kPose, b, kSetting.speed_mps, kSetting.yaw_rate_radps - at(1));
      const published::RangeRate expected = model(azimuth, elevation);
      EXPECT_NEAR(row.value_mps, expected.value_mps, 1e-12);
      EXPECT_NEAR(row.gradient(0), expected.gradient(0), 1e-12);
      for (int i = 1; i < 4; ++i) EXPECT_NEAR(row.gradient(i + 1), expected.gradient(i), 1e-12);
      for (Eigen::Index i = 0; i < 5; ++i) {
        constexpr double kStep = 1e-5;
        Parameters up = at, down = at;
        up(i) += kStep;
        down(i) -= kStep;
        const double slope = (row_of(kSetting, up, azimuth, elevation).value_mps -
                              row_of(kSetting, down, azimuth, elevation).value_mps) /
                             (2.0 * kStep);
        EXPECT_NEAR(row.gradient(i), slope, 1e-7) << i;
      }
    }
  }
}

TEST(PlanarSums, ScoreHasNoBiasByTheNoiseOfTheAngles) {
  // At the truth the corrected score has zero mean; the uncorrected one, Σ g·e/s², is many stds away.
  constexpr std::size_t kCount = 400'000;
  constexpr double kAngleStd = 0.01, kRateStd = 0.02;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> wide(-1.0, 1.0);
  std::vector<double> a(kCount), e(kCount), rate(kCount), std_angle(kCount, kAngleStd), std_rate(kCount, kRateStd);
  const Parameters at = example();
  Parameters plain = Parameters::Zero();
  for (std::size_t i = 0; i < kCount; ++i) {
    const double azimuth = 1.1 * wide(random), elevation = 0.13 + 0.15 * wide(random);
    rate[i] = row_of(kSetting, at, azimuth, elevation).value_mps + kRateStd * normal(random);
    a[i] = azimuth + kAngleStd * normal(random);
    e[i] = elevation + kAngleStd * normal(random);
  }
  const Rows rows{a.data(), e.data(), rate.data(), std_angle.data(), std_angle.data(), std_rate.data(), kCount, 0.0};
  for (const double gate : {5.0, 1e3}) {
    Judgement judgement;
    judgement.gate = gate;
    const Sums sums = sum_rows(rows, kSetting, at, judgement);
    for (const Eigen::Index i : {parameter::kSpeedScale, parameter::kAlpha, parameter::kBeta, parameter::kGamma}) {
      EXPECT_LT(std::abs(sums.score(i)), 4.0 * std::sqrt(sums.information(i, i))) << i << ", gate " << gate;
    }
  }
  Parameters variance = Parameters::Zero();
  for (std::size_t i = 0; i < kCount; ++i) {
    const Row row = row_of(kSetting, at, a[i], e[i]);
    const double by_azimuth = (row_of(kSetting, at, a[i] + 1e-6, e[i]).value_mps - row.value_mps) / 1e-6;
    const double by_elevation = (row_of(kSetting, at, a[i], e[i] + 1e-6).value_mps - row.value_mps) / 1e-6;
    const double s2 =
        kRateStd * kRateStd + kAngleStd * kAngleStd * (by_azimuth * by_azimuth + by_elevation * by_elevation);
    plain += row.gradient * ((rate[i] - row.value_mps) / s2);
    variance += row.gradient.cwiseAbs2() / s2;
  }
  EXPECT_GT((plain.array() / variance.array().sqrt()).abs().maxCoeff(), 5.0);
}

TEST(PlanarSums, FromNoiseIsTheInformationThatNoiseAddsToTheGradients) {
  constexpr std::size_t kCount = 100'000;
  constexpr double kAngleStd = 0.02;
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  std::vector<double> a(kCount), e(kCount), rate(kCount), std_angle(kCount, kAngleStd), std_rate(kCount, 1.0);
  const Parameters at = example();
  const double azimuth = -at(2) - kPose.yaw_rad + 0.3, elevation = -at(3) - kPose.pitch_rad;
  for (std::size_t i = 0; i < kCount; ++i) {
    a[i] = azimuth + kAngleStd * normal(random);
    e[i] = elevation + kAngleStd * normal(random);
    rate[i] = row_of(kSetting, at, a[i], e[i]).value_mps;
  }
  const Rows rows{a.data(), e.data(), rate.data(), std_angle.data(), std_angle.data(), std_rate.data(), kCount, 0.0};
  const Sums sums = sum_rows(rows, kSetting, at, {});
  const Parameters g = row_of(kSetting, at, azimuth, elevation).gradient;
  const double real = g(parameter::kBeta) * g(parameter::kBeta) * static_cast<double>(kCount);
  EXPECT_NEAR(
      (sums.information(parameter::kBeta, parameter::kBeta) - sums.from_noise(parameter::kBeta, parameter::kBeta)),
      real / (1.0 + kAngleStd * kAngleStd * 81.0),
      0.05 * real + 0.05 * sums.from_noise(parameter::kBeta, parameter::kBeta));
}

}  // namespace
}  // namespace boresight::alignment::planar
