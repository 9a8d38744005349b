#include "services/replay/core/scan_window.hpp"

#include <gtest/gtest.h>

#include "services/replay/core/input_losses.hpp"

namespace boresight::replay {
namespace {

constexpr std::int64_t kTimeout_ns = 2'000'000'000;

TEST(ScanWindow, IsFullUntilTheTrackListOfAScanComes) {
  ScanWindow window(2, kTimeout_ns);
  window.publish({1, 10}, 0);
  EXPECT_FALSE(window.is_full());
  window.publish({2, 10}, 0);
  EXPECT_TRUE(window.is_full());
  window.take_back({1, 10}, 1);
  EXPECT_FALSE(window.is_full());
  window.take_back({2, 10}, 2);
  EXPECT_TRUE(window.is_empty());
  EXPECT_EQ(window.missing(), 0u);
}

TEST(ScanWindow, CountsAScanAsMissingWhenTheTrackListOfALaterOneOfItsRadarComes) {
  ScanWindow window(8, kTimeout_ns);
  for (const ScanId& scan : {ScanId{1, 10}, ScanId{2, 20}, ScanId{1, 30}, ScanId{1, 40}}) window.publish(scan, 0);
  window.take_back({1, 30}, 1);
  EXPECT_EQ(window.counts().at(1).missing, 1u);
  EXPECT_EQ(window.counts().at(1).returned, 1u);
  EXPECT_EQ(window.counts().at(2).missing, 0u) << "the stages may handle another radar's scan later";
  window.take_back({2, 20}, 2);
  window.take_back({1, 40}, 3);
  EXPECT_TRUE(window.is_empty());
  EXPECT_EQ(window.missing(), 1u);
}

TEST(ScanWindow, ADroppedScanDoesNotHoldTheReplayForever) {
  ScanWindow window(1, kTimeout_ns);
  window.publish({1, 10}, 0);  // dropped by a stage: no track list comes, and no later scan is sent
  window.expire(kTimeout_ns);
  EXPECT_FALSE(window.is_full());
  EXPECT_EQ(window.missing(), 1u);
}

TEST(ScanWindow, GivesUpScansWhenNoTrackListComesForTheTimeout) {
  ScanWindow window(1, kTimeout_ns);
  window.publish({1, 10}, 0);
  window.expire(kTimeout_ns - 1);
  EXPECT_TRUE(window.is_full());
  window.expire(kTimeout_ns);
  EXPECT_TRUE(window.is_silent());
  EXPECT_FALSE(window.is_answered());
  EXPECT_EQ(window.missing(), 1u);
}

TEST(ScanWindow, DoesNotHoldTheReplayWhileThePipelineIsSilent) {
  ScanWindow window(1, kTimeout_ns);
  window.publish({1, 10}, 0);
  window.expire(kTimeout_ns);
  for (std::int64_t i = 0; i < 100; ++i) window.publish({1, 20 + i}, kTimeout_ns);
  EXPECT_FALSE(window.is_full());
  window.take_back({1, 119}, kTimeout_ns);
  window.publish({1, 200}, kTimeout_ns);
  EXPECT_TRUE(window.is_full()) << "the pipeline answers again";
  EXPECT_EQ(window.missing(), 100u);
}

TEST(ScanWindow, MeasuresTheTimeoutFromTheLatestTrackList) {
  ScanWindow window(4, kTimeout_ns);
  window.publish({1, 10}, 0);
  window.publish({1, 20}, 0);
  window.take_back({1, 10}, kTimeout_ns - 1);
  window.expire(2 * kTimeout_ns - 2);
  EXPECT_FALSE(window.is_empty()) << "slow, not silent";
  window.expire(2 * kTimeout_ns - 1);
  EXPECT_TRUE(window.is_empty());
}

TEST(ScanWindow, IgnoresTrackListsOfScansThatItDoesNotKnow) {
  ScanWindow window(4, kTimeout_ns);
  window.publish({1, 10}, 0);
  window.take_back({1, 5}, 1);
  EXPECT_TRUE(window.is_answered());
  EXPECT_FALSE(window.is_empty());
  EXPECT_EQ(window.missing(), 0u);
}

TEST(ScanWindow, AcceptsATrackListThatIsTakenBeforeItsScan) {
  ScanWindow window(1, kTimeout_ns);
  window.take_back({1, 10}, 0);
  window.publish({1, 10}, 1);
  EXPECT_FALSE(window.is_full());
  EXPECT_EQ(window.counts().at(1).returned, 1u);
  window.publish({1, 10}, 2);
  EXPECT_TRUE(window.is_full()) << "a repeated scan has a list of its own";
}

TEST(ScanWindow, CountsAWaitForTheRadarOfTheOldestScan) {
  ScanWindow window(1, kTimeout_ns);
  window.begin_wait();
  window.publish({3, 10}, 0);
  window.publish({4, 10}, 0);
  window.begin_wait();
  EXPECT_EQ(window.counts().at(3).waits, 1u);
  EXPECT_EQ(window.counts().at(4).waits, 0u);
}

TEST(InputLosses, CountOnlyWhatWasLostSinceTheFirstHeartbeat) {
  InputLosses inputs;
  inputs.see(1, 100, 7);
  inputs.see(2, 100, 0);
  EXPECT_TRUE(inputs.losses().empty());
  inputs.see(1, 100, 9);
  inputs.see(1, 200, 3);  // restarted
  EXPECT_EQ(inputs.losses(), (std::map<std::uint32_t, std::uint64_t>{{1, 5}}));
}

}  // namespace
}  // namespace boresight::replay
