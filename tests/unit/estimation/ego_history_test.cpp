#include "services/common/estimation/ego_history.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace boresight {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kStart = 1'000'000 * kMillisecond;

EgoMotion motion(std::int64_t time_ns, float speed, float yaw_rate = 0.1F) {
  EgoMotion m{};
  m.header.measurement_time_ns = time_ns;
  m.fields = ego_field::kSpeed | ego_field::kYawRate;
  m.speed_mps = speed;
  m.yaw_rate_radps = yaw_rate;
  return m;
}

TEST(EgoHistory, EmptyIsNotValid) {
  EXPECT_FALSE(EgoHistory().at(kStart).valid);
}

TEST(EgoHistory, IsLinearBetweenTwoMessages) {
  EgoHistory history;
  for (int i = 0; i <= 50; ++i) {
    history.add(motion(kStart + i * 10 * kMillisecond, static_cast<float>(i), 0.01F * static_cast<float>(i)));
  }
  const EgoSample sample = history.at(kStart + 123 * kMillisecond);
  EXPECT_TRUE(sample.valid);
  EXPECT_FALSE(sample.stale);
  EXPECT_NEAR(sample.speed_mps, 12.3, 1e-6);
  EXPECT_NEAR(sample.yaw_rate_radps, 0.123, 1e-6);
}

TEST(EgoHistory, HoldsTheEndsUntilTheyAreStale) {
  EgoHistory history(200 * kMillisecond);
  history.add(motion(kStart, 10.0F));
  EXPECT_FALSE(history.at(kStart + 200 * kMillisecond).stale);
  EXPECT_TRUE(history.at(kStart + 201 * kMillisecond).stale);
  EXPECT_TRUE(history.at(kStart - 201 * kMillisecond).stale);
  EXPECT_EQ(history.at(kStart + 900 * kMillisecond).speed_mps, 10.0);
}

TEST(EgoHistory, AGapIsNotInterpolated) {
  EgoHistory history(200 * kMillisecond);
  history.add(motion(kStart, 10.0F));
  history.add(motion(kStart + 1000 * kMillisecond, 20.0F));
  EXPECT_EQ(history.at(kStart + 100 * kMillisecond).speed_mps, 10.0);
  EXPECT_FALSE(history.at(kStart + 100 * kMillisecond).stale);
  EXPECT_TRUE(history.at(kStart + 500 * kMillisecond).stale);
  EXPECT_EQ(history.at(kStart + 900 * kMillisecond).speed_mps, 20.0);
}

TEST(EgoHistory, KeepsTheLatestOfManyAndForgetsOnARestart) {
  EgoHistory history;
  for (int i = 0; i < 1000; ++i) history.add(motion(kStart + i * 10 * kMillisecond, static_cast<float>(i)));
  EXPECT_NEAR(history.at(kStart + 9'505 * kMillisecond).speed_mps, 950.5, 1e-4);
  EXPECT_TRUE(history.at(kStart).stale) << "not in the ring any more";
  // A small step back is a late message and ignored; a large one is a restarted recording.
  history.add(motion(kStart + 9'900 * kMillisecond, -1.0F));
  EXPECT_EQ(history.at(kStart + 9'990 * kMillisecond).speed_mps, 999.0);
  history.add(motion(kStart, 5.0F));
  EXPECT_EQ(history.at(kStart).speed_mps, 5.0);
  EXPECT_FALSE(history.at(kStart).stale);
}

TEST(EgoHistory, IncompleteMessagesAndNaNAreIgnored) {
  EgoHistory history;
  EgoMotion without = motion(kStart, 10.0F);
  without.fields = ego_field::kSpeed;
  history.add(without);
  history.add(motion(kStart, std::numeric_limits<float>::quiet_NaN()));
  history.add(motion(kStart, 1.0F, std::numeric_limits<float>::infinity()));
  EXPECT_FALSE(history.at(kStart).valid);
}

}  // namespace
}  // namespace boresight
