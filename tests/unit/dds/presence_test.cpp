#include "services/health/dds/presence.hpp"

#include <gtest/gtest.h>

namespace boresight::dds {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class PresenceWatchTest : public testing::Test {
 protected:
  PresenceWatch<int> watch_{"topic", 3};
};

TEST_F(PresenceWatchTest, ANewSourceIsNoChange) {
  EXPECT_FALSE(watch_.received(1, "front", "car", 0));
  EXPECT_FALSE(watch_.received(1, "front", "car", kSecond_ns));
}

TEST_F(PresenceWatchTest, SilenceIsToldOnceWithItsLength) {
  EXPECT_FALSE(watch_.received(1, "front", "car", kSecond_ns));
  const auto change = watch_.absent(1, Absence::kDeadline, 3 * kSecond_ns);
  ASSERT_TRUE(change);
  EXPECT_EQ(change->topic, "topic");
  EXPECT_EQ(change->source, "front");
  EXPECT_EQ(change->vehicle, "car");
  EXPECT_EQ(change->absence, Absence::kDeadline);
  EXPECT_EQ(change->silent_ns, 2 * kSecond_ns);
  EXPECT_FALSE(watch_.absent(1, Absence::kDeadline, 4 * kSecond_ns)) << "the middleware repeats it in each period";
  EXPECT_FALSE(watch_.absent(1, Absence::kLiveliness, 4 * kSecond_ns));
}

TEST_F(PresenceWatchTest, ReturnIsToldOnceWithTheLengthOfTheSilence) {
  EXPECT_FALSE(watch_.received(1, "front", "car", kSecond_ns));
  EXPECT_TRUE(watch_.absent(1, Absence::kEnded, 2 * kSecond_ns));
  const auto change = watch_.received(1, "front", "car", 5 * kSecond_ns);
  ASSERT_TRUE(change);
  EXPECT_EQ(change->absence, Absence::kNone);
  EXPECT_EQ(change->silent_ns, 4 * kSecond_ns);
  EXPECT_FALSE(watch_.received(1, "front", "car", 6 * kSecond_ns));
}

TEST_F(PresenceWatchTest, ALostWriterConcernsEverySourceThatWasPresent) {
  EXPECT_FALSE(watch_.received(1, "front", "car", 0));
  EXPECT_FALSE(watch_.received(2, "rear", "car", 0));
  EXPECT_TRUE(watch_.absent(2, Absence::kEnded, kSecond_ns));
  const auto changes = watch_.all_absent(Absence::kLiveliness, 2 * kSecond_ns);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].source, "front");
}

TEST_F(PresenceWatchTest, AnUnknownSourceIsNeverAbsent) {
  EXPECT_FALSE(watch_.absent(7, Absence::kDeadline, 0));
  EXPECT_TRUE(watch_.all_absent(Absence::kNoWriter, 0).empty());
}

TEST_F(PresenceWatchTest, SourcesBeyondItsCapacityAreNotWatched) {
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(watch_.received(i, "x", "car", 0));
  EXPECT_EQ(watch_.all_absent(Absence::kNoWriter, 1).size(), 3u);
}

TEST_F(PresenceWatchTest, AnIncompatibleWriterIsToldOnce) {
  const auto change = watch_.refused();
  ASSERT_TRUE(change);
  EXPECT_EQ(change->absence, Absence::kRefused);
  EXPECT_FALSE(watch_.refused());
}

}  // namespace
}  // namespace boresight::dds
