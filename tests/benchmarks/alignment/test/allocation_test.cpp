// No method allocates on the heap after construction, whatever the number of radars.
#include <gtest/gtest.h>

#include "tests/benchmarks/alignment/common/load.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {
namespace {

TEST(Allocation, NoMethodAllocatesPerScan) {
  std::vector<NamedMethod> methods = published_methods();
  methods.push_back(own_method());
  for (const NamedMethod& named : methods) {
    for (const std::size_t radars : {1u, 4u, 16u}) {
      Load load(radars, 60.0, 5.0);
      const auto method = named.make(load.vehicle());
      EXPECT_EQ(measure_cycles(load, *method, 100).allocations, 0u) << named.name << ", " << radars << " radars";
    }
  }
}

TEST(Allocation, NoneFromTheFirstScanOn) {
  Load load(4, 60.0, 5.0);
  const auto method = own_method().make(load.vehicle());
  EXPECT_EQ(count_allocations(load, *method, 100), 0u);
}

}  // namespace
}  // namespace boresight::bench
