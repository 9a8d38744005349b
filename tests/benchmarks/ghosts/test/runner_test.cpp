#include "tests/benchmarks/ghosts/common/runner.hpp"

#include <gtest/gtest.h>

#include "tests/benchmarks/ghosts/common/methods.hpp"

namespace boresight::bench {
namespace {

TEST(GhostRunner, ADriveIsTheSameWhateverTheThreads) {
  Options one, two;
  one.jobs = 1;
  const std::vector<NamedGhostMethod> methods = ghost_methods();
  const auto a = run_ghost_drives("straight_rail", {methods.data(), 1}, 2, 3.0, one).front();
  const auto b = run_ghost_drives("straight_rail", {methods.data(), 1}, 2, 3.0, two).front();
  // A second method on the same drive does not change the first one's result.
  const auto c = run_ghost_drives("straight_rail", methods, 2, 3.0, one).front();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GT(a[i].scans, 200u);
    for (const Provenance truth : kTruths) {
      EXPECT_GT(a[i].confusion.count(truth), 0u) << name_of(truth);
      for (const Provenance label : kTruths) {
        EXPECT_EQ(a[i].confusion.percent(truth, label), b[i].confusion.percent(truth, label));
        EXPECT_EQ(a[i].confusion.percent(truth, label), c[i].confusion.percent(truth, label));
      }
    }
    EXPECT_GT(a[i].lost.object_seconds, 0u);
    EXPECT_GT(a[i].reliability.count(), 100u);
  }
  EXPECT_NE(a[0].confusion.count(Provenance::kStationary), a[1].confusion.count(Provenance::kStationary));
  one.first_seed = 2;
  const auto second = run_ghost_drives("straight_rail", {methods.data(), 1}, 1, 3.0, one).front();
  EXPECT_EQ(second[0].confusion.count(Provenance::kStationary), a[1].confusion.count(Provenance::kStationary));
}

}  // namespace
}  // namespace boresight::bench
