#include "services/ingest_gateway/core/silence.hpp"

#include <gtest/gtest.h>

namespace boresight::ingest {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

TEST(Silence, ReignsWhenNothingCameSinceItWasAskedLast) {
  Silence silence;
  std::int64_t now_ns = 1'000 * kMillisecond;
  EXPECT_FALSE(silence.reigns(now_ns)) << "nobody has looked before";
  EXPECT_TRUE(silence.reigns(now_ns += 5 * kMillisecond));
  silence.frame_came();
  EXPECT_FALSE(silence.reigns(now_ns += 5 * kMillisecond));
  EXPECT_TRUE(silence.reigns(now_ns += 5 * kMillisecond));
}

TEST(Silence, AfterAPauseOfTheProcessWhatWaitedIsReadFirst) {
  Silence silence;
  std::int64_t now_ns = 1'000 * kMillisecond;
  static_cast<void>(silence.reigns(now_ns));
  EXPECT_FALSE(silence.reigns(now_ns += 150 * kMillisecond));
  EXPECT_TRUE(silence.reigns(now_ns += 5 * kMillisecond));
}

}  // namespace
}  // namespace boresight::ingest
