#include "services/health/dds/pace.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

namespace boresight::dds {
namespace {

constexpr std::int64_t kPeriod_ns = 50'000'000;
constexpr double kPeriod_s = 0.05;

TEST(Pace, LetsOneSampleOfEightRadarsPassInEachPeriod) {
  Pace pace(kPeriod_s);
  int sent = 0;
  constexpr int kSamples = 1600;  // 10 s of 160 Hz
  for (int i = 0; i < kSamples; ++i) sent += pace.take(i * kPeriod_ns / 8) ? 1 : 0;
  EXPECT_NEAR(sent, 200, 1);
}

TEST(Pace, KeepsTheRateOfOneRadarWithJitter) {
  Pace pace(kPeriod_s);
  int sent = 0;
  std::srand(1);
  for (int i = 0; i < 1000; ++i) sent += pace.take(i * kPeriod_ns + std::rand() % 20'000'000) ? 1 : 0;
  EXPECT_EQ(sent, 1000);
}

TEST(Pace, LetsEverySamplePassWithoutAPeriod) {
  Pace pace(0.0);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(pace.take(1'000));
}

TEST(Pace, LetsAnUrgentSamplePassAndBeginsThePeriodAnew) {
  Pace pace(kPeriod_s);
  EXPECT_TRUE(pace.take(0));
  EXPECT_FALSE(pace.take(10'000'000));
  EXPECT_TRUE(pace.take(20'000'000, true));
  EXPECT_FALSE(pace.take(40'000'000));
  EXPECT_TRUE(pace.take(70'000'000));
}

TEST(Pace, BeginsAnewAfterAPause) {
  Pace pace(kPeriod_s);
  EXPECT_TRUE(pace.take(0));
  EXPECT_TRUE(pace.take(10 * kPeriod_ns));
  EXPECT_FALSE(pace.take(10 * kPeriod_ns + 1)) << "missed turns are not caught up";
}

}  // namespace
}  // namespace boresight::dds
