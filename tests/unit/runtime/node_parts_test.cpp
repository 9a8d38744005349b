#include <cstdlib>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/common/runtime/node_impl.hpp"
#include "services/common/runtime/queueing.hpp"

namespace boresight::runtime {
namespace {

MessageHeader message(std::uint64_t sequence, std::uint32_t source = 0, std::uint64_t source_sequence = 0) {
  MessageHeader header{};
  header.sequence = sequence;
  header.source_id = source;
  header.source_sequence = source_sequence;
  return header;
}

TEST(GapDetector, CountsMissingMessagesBetweenTwoMessages) {
  GapDetector gaps(false);
  EXPECT_EQ(gaps.observe(message(7)), 0u) << "the first message of a late reader is no loss";
  EXPECT_EQ(gaps.observe(message(8)), 0u);
  EXPECT_EQ(gaps.observe(message(12)), 3u);
}

TEST(GapDetector, ARestartedWriterIsNoLoss) {
  GapDetector gaps(false);
  static_cast<void>(gaps.observe(message(100)));
  EXPECT_EQ(gaps.observe(message(1)), 0u);
  EXPECT_EQ(gaps.observe(message(2)), 0u);
}

TEST(GapDetector, DistinguishesSeveralWriters) {
  GapDetector gaps(true);
  static_cast<void>(gaps.observe(message(1, 0, 1)));
  static_cast<void>(gaps.observe(message(1, 3, 1)));
  EXPECT_EQ(gaps.observe(message(2, 0, 2)), 0u);
  EXPECT_EQ(gaps.observe(message(4, 3, 4)), 2u);
}

TEST(Queueing, IsTheTimeFromTheEndOfTheStageBeforeToTheBeginOfThisOne) {
  MessageHeader scan = message(1);
  EXPECT_EQ(queueing_ns(scan, 900), 0) << "no stage has stamped it";
  scan.stage(Stage::kIngest) = {100, 150};
  EXPECT_EQ(queueing_ns(scan, 190), 40);
  scan.stage(Stage::kCorrector) = {190, 260};
  EXPECT_EQ(queueing_ns(scan, 900), 640);
  EXPECT_EQ(queueing_ns(scan, 200), 0) << "a stamp of the future is no waiting";
}

#ifndef BORESIGHT_SANITIZED
// The call uses a volatile pointer, as the compiler would otherwise remove the pair without effect.
void allocate_once() {
  void* (*volatile allocate)(std::size_t) = std::malloc;
  std::free(allocate(16));
}

TEST(AllocationCounter, CountsOnlyInsideItsScope) {
  const std::uint64_t before = counted_allocations();
  allocate_once();
  EXPECT_EQ(counted_allocations(), before);
  {
    const CountAllocations counting;
    allocate_once();
    const auto pointer = std::make_unique<double>(1.0);
    EXPECT_EQ(*pointer, 1.0);
    {
      const AllowAllocations allowed;
      allocate_once();
    }
  }
  EXPECT_EQ(counted_allocations(), before + 2);
}
#endif

}  // namespace
}  // namespace boresight::runtime
