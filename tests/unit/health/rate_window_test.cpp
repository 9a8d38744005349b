#include "services/health/core/rate_window.hpp"

#include <gtest/gtest.h>

namespace boresight::health {
namespace {

constexpr std::int64_t kWindowMillisecond = 1'000'000;

TEST(RateWindow, KnowsTheRateFromTheSecondEventOn) {
  RateWindow window(2.0);
  std::int64_t t = 123 * kWindowMillisecond;
  window.add(t);
  EXPECT_EQ(window.rate_hz(t), 0.0);
  for (int i = 0; i < 200; ++i) {
    t += 50 * kWindowMillisecond;
    window.add(t);
    EXPECT_NEAR(window.rate_hz(t), 20.0, 1.01) << i;
  }
  EXPECT_TRUE(window.is_full(t));
}

TEST(RateWindow, ForgetsWhatIsOlderThanTheWindow) {
  RateWindow window(2.0);
  for (int i = 0; i < 100; ++i) window.add(i * 20 * kWindowMillisecond);
  EXPECT_GE(window.sum(2000 * kWindowMillisecond), 90u);
  EXPECT_EQ(window.sum(4300 * kWindowMillisecond), 0u);
  EXPECT_EQ(window.rate_hz(4300 * kWindowMillisecond), 0.0);
  // The same after a jump of far more than the window.
  window.add(1'000'000 * kWindowMillisecond, 7);
  EXPECT_EQ(window.sum(1'000'300 * kWindowMillisecond), 7u);
}

TEST(RateWindow, HalfTheRateShowsWithinAWindow) {
  RateWindow window(2.0);
  std::int64_t t = 0;
  for (int i = 0; i < 100; ++i) window.add(t += 50 * kWindowMillisecond);
  for (int i = 0; i < 22; ++i) window.add(t += 100 * kWindowMillisecond);
  EXPECT_NEAR(window.rate_hz(t), 10.0, 0.6);
}

TEST(RateWindow, ClearForgetsAllEvents) {
  RateWindow window(2.0);
  for (int i = 0; i < 100; ++i) window.add(i * 20 * kWindowMillisecond);
  window.clear();
  EXPECT_EQ(window.rate_hz(2000 * kWindowMillisecond), 0.0);
  EXPECT_FALSE(window.is_full(2000 * kWindowMillisecond));
}

}  // namespace
}  // namespace boresight::health
