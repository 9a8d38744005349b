#include <gtest/gtest.h>

#include "tests/benchmarks/ghosts/common/load.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"

namespace boresight::bench {
namespace {

TEST(GhostMethods, NeverAllocate) {
  for (const NamedGhostMethod& named : ghost_methods()) {
    GhostLoad load(4, 300, Surroundings::kSame);
    const auto method = ghosts::make_method(named.config);
    EXPECT_EQ(measure_ghost_cycles(load, *method, 5).allocations, 0u) << named.name;
  }
}

}  // namespace
}  // namespace boresight::bench
