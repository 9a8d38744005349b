// The memory of the likelihoods of cells.
#include <cstdint>

#include <gtest/gtest.h>

#include "services/tracker/core/pmbm/cell_memory.hpp"

namespace boresight::tracking::pmbm {
namespace {

TEST(CellMemory, ComputesEachValueOnceUntilItIsCleared) {
  CellMemory memory(64);
  int computed = 0;
  const auto compute = [&computed] { return static_cast<double>(++computed); };
  EXPECT_EQ(memory.value(mixed(1), 5, compute), 1.0);
  EXPECT_EQ(memory.value(mixed(1), 5, compute), 1.0);
  EXPECT_EQ(memory.value(mixed(1), 6, compute), 2.0);
  memory.clear();
  EXPECT_EQ(memory.value(mixed(1), 5, compute), 3.0);
}

TEST(CellMemory, CellsThatDifferByTheKeysOfMeasurementsAreKeptApartForEverySource) {
  CellMemory memory(1U << 16U);
  for (std::uint64_t a = 0; a < 8; ++a) {
    for (std::uint64_t b = 0; b < 8; ++b) {
      for (std::uint64_t source = 0; source < 8; ++source) {
        const double expected = static_cast<double>(64 * a + 8 * b + source);
        if (a < b) {
          EXPECT_EQ(memory.value(mixed(a) ^ mixed(b), source, [&] { return expected; }), expected);
        }
      }
    }
  }
}

}  // namespace
}  // namespace boresight::tracking::pmbm
