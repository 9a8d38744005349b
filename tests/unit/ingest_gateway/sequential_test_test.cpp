#include "services/ingest_gateway/core/sequential_test.hpp"

#include <random>

#include <gtest/gtest.h>

#include "services/ingest_gateway/core/stationary_share.hpp"

namespace boresight::ingest {
namespace {

SequentialTest sequential_test() {
  const ContradictionConfig config;
  return SequentialTest(config.false_alarm, config.false_return);
}

/// Scans until the test decides otherwise, at most `most`. The log ratios are those of a normal quantity whose mean is
/// 0 if the radar is sound, and 1 if it is not.
int scans_until_change(double mean, bool begins_contradicting, int most, std::uint64_t seed) {
  SequentialTest test = sequential_test();
  while (begins_contradicting && !test.contradicts()) test.add(100.0, 1.0, 1.0);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(mean, 1.0);
  for (int scan = 1; scan <= most; ++scan) {
    test.add(noise(random) - 0.5, 1.0, 1.0);
    if (test.contradicts() != begins_contradicting) return scan;
  }
  return most;
}

TEST(SequentialTest, FindsAChangeWithinTheScansThatItsErrorProbabilityNeeds) {
  // ln 10⁵ / ½ = 23 scans on average, ln 10² / ½ = 9 for the return.
  double to_contradiction = 0.0, to_sound = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    to_contradiction += scans_until_change(1.0, false, 1000, seed) / 200.0;
    to_sound += scans_until_change(0.0, true, 1000, seed) / 200.0;
  }
  EXPECT_NEAR(to_contradiction, 23.0, 3.0);
  EXPECT_NEAR(to_sound, 9.2, 2.0);
}

TEST(SequentialTest, ASoundRadarIsAccusedLessThanOnceIn100000Scans) {
  int accused = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) accused += scans_until_change(0.0, false, 100'000, seed) < 100'000;
  EXPECT_LT(accused, 10);
}

TEST(SequentialTest, TheFirstSoundScansDoNotDelayTheDecision) {
  SequentialTest fresh = sequential_test(), old = fresh;
  for (int i = 0; i < 100'000; ++i) old.add(-50.0, 3.0, 3.0);
  int scans = 0;
  for (; !fresh.contradicts() && scans < 100; ++scans) {
    fresh.add(2.0, 3.0, 3.0);
    old.add(2.0, 3.0, 3.0);
  }
  EXPECT_EQ(scans, 18) << "3 · ln 10⁵ / 2";
  EXPECT_TRUE(old.contradicts());
}

TEST(SequentialTest, FewerScansThanASceneNeverDecide) {
  SequentialTest test = sequential_test();
  int scans = 0;
  for (; !test.contradicts() && scans < 100; ++scans) test.add(1e6, 2.0, 20.0);
  EXPECT_GE(scans, 20);
  EXPECT_LE(scans, 21);
}

TEST(StationaryShare, IsThatOfTheLeastStationaryScenes) {
  constexpr double kCycle_s = 0.05;
  StationaryShare share({}, kCycle_s);
  for (int scan = 0; scan < 20 * 120; ++scan) share.learn(scan / 40 % 2 == 0 ? 0.3 : 0.2, 1.0, 0.1, 100);
  EXPECT_GT(share.least(), 0.13);
  EXPECT_LT(share.least(), 0.21);
  EXPECT_NEAR(share.by_chance(), 0.1, 1e-9);
}

TEST(StationaryShare, OfARadarThatReportsMovingObjectsOnlyIsZero) {
  StationaryShare few({}, 0.05), many({}, 0.05);
  for (int scan = 0; scan < 20 * 60; ++scan) {
    few.learn(0.0, 0.8, 0.05, 10);
    many.learn(0.0, 0.8, 0.05, 100);
  }
  EXPECT_EQ(few.least(), 0.0);
  EXPECT_GT(many.least(), 0.05) << "a radar of many detections sees the road";
}

}  // namespace
}  // namespace boresight::ingest
