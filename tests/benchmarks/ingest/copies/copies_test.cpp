// Detections are decoded directly into the memory that leaves the process, without intermediate copies.
#include <bit>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "tests/benchmarks/ingest/copies/count_copies.hpp"
#include "tests/benchmarks/ingest/copies/find_sentinels.hpp"

namespace boresight::bench {
namespace {

class CopiesTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!kCanFindSentinels) GTEST_SKIP() << "skipped: not in a sanitized build";
  }
};

TEST_F(CopiesTest, Ars548ListIsDecodedFromItsDatagramIntoTheScan) {
  const Copies copies = count_ars548_copies();
  EXPECT_EQ(copies.intermediate, 0);
  EXPECT_EQ(copies.decoded, 1);
  EXPECT_TRUE(copies.into_the_sinks_memory);
}

TEST_F(CopiesTest, SegmentsAreAssembledOnceAndDecodedFromThere) {
  const Copies copies = count_someip_copies();
  EXPECT_EQ(copies.intermediate, 1);
  EXPECT_EQ(copies.decoded, 1);
  EXPECT_TRUE(copies.into_the_sinks_memory);
}

TEST_F(CopiesTest, CopiesAreFoundAnywhereInMemory) {
  constexpr std::size_t kDetections = 700;
  // Allocate first: reused memory may hold sentinels of an earlier test.
  std::vector<float> numbers(kDetections), same_numbers(kDetections);
  std::vector<std::uint8_t> unaligned(1 + 4 * kDetections);
  const SentinelPlaces before = find_sentinels();
  for (std::size_t i = 0; i < kDetections; ++i) {
    numbers[i] = same_numbers[i] = sentinel_range_m(i);
    const auto bits = __builtin_bswap32(std::bit_cast<std::uint32_t>(numbers[i]));
    std::memcpy(unaligned.data() + 1 + 4 * i, &bits, sizeof(bits));
  }
  const NewPlaces more = new_places(before, find_sentinels(), kDetections);
  EXPECT_EQ(more.as_float, 2);
  EXPECT_EQ(more.on_wire_order, 1);
}

}  // namespace
}  // namespace boresight::bench
