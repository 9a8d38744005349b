#include "services/tracker/core/fixed_table.hpp"

#include <bit>
#include <limits>
#include <random>
#include <unordered_map>
#include <unordered_set>

#include <gtest/gtest.h>

namespace boresight::tracking {
namespace {

TEST(FixedTable, AnswersAsAnUnorderedMapOverManyClearings) {
  constexpr std::size_t kSize = 256;
  std::mt19937_64 random(1);
  FixedTable table(kSize);
  std::unordered_map<std::uint64_t, int> expected;
  for (int round = 0; round < 300; ++round) {
    table.clear();
    expected.clear();
    const int entries = static_cast<int>(random() % (kSize / 2 + 1));
    for (int i = 0; i < entries; ++i) {
      // Small keys come again in later rounds.
      const std::uint64_t key = round % 2 == 0 ? random() % 1000 : random();
      const auto found = expected.find(key);
      ASSERT_EQ(table.find(key), found == expected.end() ? -1 : found->second);
      if (found != expected.end()) continue;
      ASSERT_TRUE(table.insert(key, i));
      expected.emplace(key, i);
    }
    for (std::uint64_t key = 0; key < 1000; ++key) {
      const auto found = expected.find(key);
      ASSERT_EQ(table.find(key), found == expected.end() ? -1 : found->second);
    }
  }
}

TEST(FixedTable, TakesHalfItsSizeAndThenNothingNew) {
  constexpr int kSize = 16;
  FixedTable table(kSize);
  for (int i = 0; i < kSize / 2; ++i) EXPECT_TRUE(table.insert(static_cast<std::uint64_t>(i), i));
  EXPECT_FALSE(table.insert(99, 99));
  EXPECT_EQ(table.find(99), -1);
  for (int i = 0; i < kSize / 2; ++i) EXPECT_EQ(table.find(static_cast<std::uint64_t>(i)), i) << "forgets nothing";
  table.clear();
  EXPECT_EQ(table.find(0), -1);
  EXPECT_TRUE(table.insert(99, 7));
  EXPECT_EQ(table.find(99), 7);
}

TEST(FixedTable, HoldsTheKeyZeroLikeAnyOther) {
  FixedTable table(8);
  EXPECT_EQ(table.find(0), -1);
  EXPECT_TRUE(table.insert(0, 3));
  EXPECT_EQ(table.find(0), 3);
}

#ifndef BORESIGHT_SANITIZED  // where it takes half a minute
TEST(FixedTable, IsEmptyAfterAsManyClearingsAsItsCounterCounts) {
  // Five days of a filter that clears it 10,000 times a second.
  FixedTable table(8);
  EXPECT_TRUE(table.insert(5, 1));
  for (std::uint64_t i = 0; i <= std::numeric_limits<std::uint32_t>::max(); ++i) table.clear();
  EXPECT_EQ(table.find(5), -1);
  EXPECT_EQ(table.find(6), -1);
  EXPECT_TRUE(table.insert(5, 2));
  EXPECT_EQ(table.find(5), 2);
}
#endif

TEST(MixedKeys, DifferInHalfOfTheirBitsForNeighbours) {
  std::unordered_set<std::uint64_t> seen;
  constexpr std::uint64_t kKeys = 4000;
  int bits = 0;
  for (std::uint64_t i = 0; i < kKeys; ++i) {
    seen.insert(mixed(i));
    bits += std::popcount(mixed(i) ^ mixed(i + 1));
  }
  EXPECT_EQ(seen.size(), kKeys);
  EXPECT_NEAR(static_cast<double>(bits) / kKeys, 32.0, 0.5);
}

}  // namespace
}  // namespace boresight::tracking
