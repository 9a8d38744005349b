// Whether the body is believed to pitch: only what radars see together is the body's.
#include "services/alignment_estimator/core/filter/common_pitch.hpp"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace boresight::alignment {
namespace {

constexpr double kPrior = 0.005 * 0.005, kNoise = 0.003;

/// What a filter makes of a body at `measured` that it has no opinion on but the prior.
void say(CommonPitch& pitch, std::size_t radar, double t_s, double measured) {
  const double gain = kPrior / (kPrior + kNoise * kNoise);
  pitch.add(radar, static_cast<std::int64_t>(1e9 * t_s), 0.0, kPrior, gain * measured, (1.0 - gain) * kPrior);
}

/// 40 s of radars that take turns. Of the Ornstein–Uhlenbeck processes (0.3 s) one is the body's, one each radar's own.
double share(std::size_t radars, double body_std, double own_std, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  constexpr double kStep_s = 0.0125;
  const double keep = std::exp(-kStep_s / 0.3), added = std::sqrt(1.0 - keep * keep);
  double body = body_std * normal(random);
  std::array<double, kMaxRadars> own{};
  CommonPitch pitch;
  for (std::size_t i = 0; i < 3200; ++i) {
    body = keep * body + added * body_std * normal(random);
    for (std::size_t r = 0; r < radars; ++r) own[r] = keep * own[r] + added * own_std * normal(random);
    const std::size_t radar = i % radars;
    say(pitch, radar, 1.0 + kStep_s * static_cast<double>(i), body + own[radar] + kNoise * normal(random));
  }
  return pitch.share();
}

TEST(CommonPitch, IsWhatRadarsSeeTogether) {
  for (unsigned seed = 0; seed < 8; ++seed) EXPECT_GT(share(4, 0.005, 0.0, seed), 0.9) << seed;
}

TEST(CommonPitch, WhatMovesTheElevationsOfEachRadarAloneIsNotTheBodys) {
  double mean = 0.0;
  for (unsigned seed = 0; seed < 8; ++seed) mean += share(4, 0.0, 0.005, seed) / 8.0;
  EXPECT_LT(mean, 0.1);
}

TEST(CommonPitch, OneRadarCannotTell) {
  EXPECT_EQ(share(1, 0.005, 0.0, 1), 0.0);
}

TEST(CommonPitch, ErrorsOfMountingsAreNotTheBodys) {
  CommonPitch pitch;
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (std::size_t i = 0; i < 3200; ++i) {
    say(pitch, i % 4, 1.0 + 0.0125 * static_cast<double>(i), 0.01 + kNoise * normal(random));
  }
  EXPECT_LT(pitch.share(), 0.3);
}

TEST(CommonPitch, NothingThatIsNoNumberComesIn) {
  CommonPitch pitch;
  pitch.add(0, 0, 0.0, 0.0, 0.0, 0.0);
  pitch.add(1, 10'000'000, 0.0, kPrior, std::nan(""), 0.5 * kPrior);
  pitch.add(kMaxRadars, 20'000'000, 0.0, kPrior, 0.0, 0.5 * kPrior);
  EXPECT_EQ(pitch.share(), 0.0);
}

}  // namespace
}  // namespace boresight::alignment
