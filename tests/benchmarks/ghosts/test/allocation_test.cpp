#include <gtest/gtest.h>

#include "tests/benchmarks/ghosts/common/load.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"

namespace boresight::bench {
namespace {

TEST(GhostMethods, NeverAllocate) {
  for (const NamedMethod& named : kMethods) {
    GhostLoad load(4, 300);
    const auto method = ghosts::make_method(config_of(named, {}));
    EXPECT_EQ(measure_ghost_cycles(load, *method, 5).allocations, 0u) << named.name;
  }
}

}  // namespace
}  // namespace boresight::bench
