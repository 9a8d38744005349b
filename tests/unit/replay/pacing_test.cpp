#include "services/replay/core/pacing.hpp"

#include <gtest/gtest.h>

namespace boresight::replay {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(Pacing, RealTimeFasterAndAtOnce) {
  Pacing real(1.0), fast(4.0), at_once(0.0);
  for (Pacing* p : {&real, &fast, &at_once}) EXPECT_EQ(p->due_ns(500 * kSecond, 7 * kSecond), 7 * kSecond);
  EXPECT_EQ(real.due_ns(502 * kSecond, 7 * kSecond), 9 * kSecond);
  EXPECT_EQ(fast.due_ns(502 * kSecond, 7 * kSecond), 7 * kSecond + kSecond / 2);
  EXPECT_EQ(at_once.due_ns(502 * kSecond, 8 * kSecond), 8 * kSecond);
}

TEST(Pacing, DoesNotDriftWhenItIsLate) {
  Pacing pacing(1.0);
  EXPECT_EQ(pacing.due_ns(0, kSecond), kSecond);
  for (int i = 1; i < 100; ++i) EXPECT_EQ(pacing.due_ns(i * kSecond / 20, 50 * kSecond), kSecond + i * kSecond / 20);
}

TEST(Pacing, AJumpBackOrALongPauseStartsAgain) {
  Pacing pacing(1.0);
  static_cast<void>(pacing.due_ns(1000 * kSecond, 0));
  EXPECT_EQ(pacing.due_ns(900 * kSecond, 5 * kSecond), 5 * kSecond);
  EXPECT_EQ(pacing.due_ns(901 * kSecond, 5 * kSecond), 6 * kSecond);
  EXPECT_EQ(pacing.due_ns(2000 * kSecond, 7 * kSecond), 7 * kSecond);
  // A frame that is a little out of order is no jump.
  EXPECT_EQ(pacing.due_ns(2000 * kSecond - kSecond / 2, 8 * kSecond), 7 * kSecond - kSecond / 2);
}

}  // namespace
}  // namespace boresight::replay
