#include "tests/benchmarks/ghosts/common/confusion.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/benchmarks/ghosts/common/load.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/runner.hpp"

namespace boresight::bench {
namespace {

TEST(Confusion, CountsByTruthAndLeavesOutWhatTheCorrectorRejected) {
  Confusion c;
  for (int i = 0; i < 3; ++i) c.add(Provenance::kGhostType1, Provenance::kGhostType1, false);
  for (int i = 0; i < 4; ++i) c.add(Provenance::kGhostType1, Provenance::kGhostType2, false);
  c.add(Provenance::kGhostType1, Provenance::kMoving, false);
  for (int i = 0; i < 5; ++i) c.add(Provenance::kGhostType1, Provenance::kUnknown, true);
  EXPECT_EQ(c.count(Provenance::kGhostType1), 8u);
  EXPECT_EQ(c.rejected(Provenance::kGhostType1), 5u);
  EXPECT_DOUBLE_EQ(c.percent(Provenance::kGhostType1, Provenance::kGhostType1), 37.5);
  EXPECT_DOUBLE_EQ(c.percent_ghost(Provenance::kGhostType1), 87.5);
  EXPECT_TRUE(std::isnan(c.percent(Provenance::kMoving, Provenance::kMoving)));
}

TEST(GhostRunner, ADriveIsTheSameWhateverTheThreads) {
  Options one, two;
  one.jobs = 1;
  const ghosts::Config config = ghost_methods().front().config;
  const auto a = run_ghost_drives("straight_rail", config, 2, 3.0, one);
  const auto b = run_ghost_drives("straight_rail", config, 2, 3.0, two);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GT(a[i].scans, 200u);
    for (const Provenance truth : kTruths) {
      EXPECT_GT(a[i].confusion.count(truth), 0u) << name_of(truth);
      for (const Provenance label : kTruths) {
        EXPECT_EQ(a[i].confusion.percent(truth, label), b[i].confusion.percent(truth, label));
      }
    }
    EXPECT_GT(a[i].object_seconds, 2u);
  }
  EXPECT_NE(a[0].confusion.count(Provenance::kStationary), a[1].confusion.count(Provenance::kStationary));
}

TEST(GhostMethods, NeverAllocate) {
  for (const NamedGhostMethod& named : ghost_methods()) {
    GhostLoad load(4, 300);
    const auto method = ghosts::make_method(named.config);
    EXPECT_EQ(measure_ghost_cycles(load, *method, 5).allocations, 0u) << named.name;
  }
}

}  // namespace
}  // namespace boresight::bench
