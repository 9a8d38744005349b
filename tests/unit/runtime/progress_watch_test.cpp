#include "services/common/runtime/progress_watch.hpp"

#include <gtest/gtest.h>

namespace boresight::runtime {
namespace {

constexpr std::int64_t kLook_ns = 100'000'000;
constexpr std::int64_t kLimit_ns = 250'000'000;

/// A watch that is asked every 100 ms, as the heartbeat does.
class Watchdog : public testing::Test {
 protected:
  bool is_due_with_input(bool waits, std::uint64_t handled, std::int64_t step_ns = kLook_ns) {
    watch_.begin_look(now_ns_ += step_ns);
    watch_.look_at(input_, waits, handled, kLimit_ns, "radar_scan");
    return watch_.stroke_is_due();
  }
  bool is_due_with_output(std::int64_t step_ns = kLook_ns) {
    watch_.begin_look(now_ns_ += step_ns);
    watch_.look_at(output_, kLimit_ns, "track_list");
    return watch_.stroke_is_due();
  }
  bool is_due_with_periodic_output(std::int64_t step_ns = kLook_ns) {
    watch_.begin_look(now_ns_ += step_ns);
    watch_.look_at_periodic(output_, kLimit_ns, "health_report");
    return watch_.stroke_is_due();
  }

  std::int64_t now_ns_ = 5'000'000'000;
  ProgressWatch watch_;
  WatchedInput input_;
  WatchedOutput output_;
};

TEST_F(Watchdog, IsStrokedWithoutAnyInput) {
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(is_due_with_input(false, 0));
}

TEST_F(Watchdog, IsWithheldWhenInputWaitsUnhandled) {
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(is_due_with_input(true, 7)) << i;
  EXPECT_FALSE(is_due_with_input(true, 7));
  EXPECT_FALSE(is_due_with_input(true, 7));
  EXPECT_EQ(watch_.reason(), "radar_scan: messages wait and none is handled");
}

TEST_F(Watchdog, IsStrokedAgainAfterOneHandledMessage) {
  for (int i = 0; i < 10; ++i) static_cast<void>(is_due_with_input(true, 7));
  EXPECT_TRUE(is_due_with_input(true, 8));
  EXPECT_EQ(watch_.reason(), "");
}

TEST_F(Watchdog, IsStrokedWhenASlowServiceNeverEmptiesItsQueue) {
  for (std::uint64_t handled = 0; handled < 100; ++handled) EXPECT_TRUE(is_due_with_input(true, handled));
}

TEST_F(Watchdog, IsStrokedWhenInputsAreRareAndEachIsSeenWaitingOnce) {
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(is_due_with_input(i % 2 == 0, 7));
}

TEST_F(Watchdog, IsStrokedAfterAStopOfTheProcess) {
  EXPECT_TRUE(is_due_with_input(true, 7));
  EXPECT_TRUE(is_due_with_input(true, 7, 60'000'000'000)) << "a minute in which nothing could be handled";
  EXPECT_TRUE(is_due_with_input(true, 8));
  output_.published();
  EXPECT_TRUE(is_due_with_periodic_output(60'000'000'000));
}

TEST_F(Watchdog, IsWithheldWhenEveryInputLacksItsOutput) {
  bool is_due = true;
  for (int i = 0; i < 10; ++i) {
    output_.missed(now_ns_ + 50'000'000, kLimit_ns);
    is_due = is_due_with_output();
    EXPECT_EQ(is_due, i < 3) << i;
  }
  EXPECT_EQ(watch_.reason(), "track_list: outputs are due and none is published");
  output_.published();
  EXPECT_TRUE(is_due_with_output());
}

TEST_F(Watchdog, IsStrokedWhenOneOutputInTwoIsMissing) {
  for (int i = 0; i < 100; ++i) {
    output_.missed(now_ns_, kLimit_ns);
    if (i % 2 == 0) output_.published();
    EXPECT_TRUE(is_due_with_output());
  }
}

TEST_F(Watchdog, IsStrokedWhenInputsEndAfterAMissedOutput) {
  for (int i = 0; i < 5; ++i) {
    output_.missed(now_ns_, kLimit_ns);
    static_cast<void>(is_due_with_output());
  }
  static_cast<void>(is_due_with_output());
  static_cast<void>(is_due_with_output());
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(is_due_with_output()) << "the radars are silent";
}

TEST_F(Watchdog, IsStrokedWhenMissedOutputsLieFarApart) {
  for (int i = 0; i < 100; ++i) {
    output_.missed(now_ns_, kLimit_ns);
    for (int k = 0; k < 10; ++k) EXPECT_TRUE(is_due_with_output()) << i;
  }
}

TEST_F(Watchdog, IsWithheldWhenAPeriodicOutputIsMissing) {
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(is_due_with_periodic_output()) << i;
  EXPECT_FALSE(is_due_with_periodic_output());
  EXPECT_EQ(watch_.reason(), "health_report: is due periodically and is not published");
  output_.published();
  EXPECT_TRUE(is_due_with_periodic_output());
}

TEST_F(Watchdog, IsWithheldForOneOfSeveralInputs) {
  WatchedInput stalls;
  for (std::uint64_t i = 0; i < 10; ++i) {
    static_cast<void>(is_due_with_input(true, i));
    watch_.look_at(stalls, true, 0, kLimit_ns, "ego_motion");
  }
  EXPECT_FALSE(watch_.stroke_is_due());
  EXPECT_EQ(watch_.reason(), "ego_motion: messages wait and none is handled");
}

}  // namespace
}  // namespace boresight::runtime
