#include "services/common/geometry/cluster_runs.hpp"

#include <random>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::geometry {
namespace {

TEST(ClusterRuns, HoldsEachClustersItemsInTheirOrder) {
  std::mt19937 random(1);
  ClusterRuns<int> runs(200);
  for (int round = 0; round < 300; ++round) {
    const std::size_t clusters = random() % 12;
    std::vector<int> items(random() % 201);
    std::vector<std::int32_t> labels(items.size());
    std::vector<std::vector<int>> expected(clusters);
    for (std::size_t i = 0; i < items.size(); ++i) {
      items[i] = static_cast<int>(random() % 1000);
      labels[i] = static_cast<std::int32_t>(random() % (clusters + 1)) - 1;
      if (labels[i] >= 0) expected[static_cast<std::size_t>(labels[i])].push_back(items[i]);
    }
    runs.sort(items, labels, clusters);
    ASSERT_EQ(runs.size(), clusters);
    for (std::size_t c = 0; c < clusters; ++c) {
      EXPECT_EQ(std::vector<int>(runs[c].begin(), runs[c].end()), expected[c]) << "round " << round;
    }
  }
}

TEST(ClusterRuns, SkipsNoiseAndItemsBeyondTheCapacity) {
  ClusterRuns<int> runs(4);
  EXPECT_EQ(runs.size(), 0U);
  const std::vector<int> items{10, 11, 12, 13, 14, 15};
  const std::vector<std::int32_t> labels{0, -1, 7, 1, 0};
  runs.sort(items, labels, 2);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(std::vector<int>(runs[0].begin(), runs[0].end()), std::vector<int>{10}) << "the fifth exceeds the capacity";
  EXPECT_EQ(std::vector<int>(runs[1].begin(), runs[1].end()), std::vector<int>{13});
  runs.sort(items, labels, 1000);
  EXPECT_EQ(runs.size(), 4U);
  runs.sort({}, {}, 0);
  EXPECT_EQ(runs.size(), 0U);
}

TEST(ClusterRuns, DoesNotAllocate) {
  ClusterRuns<double> runs(64);
  const std::vector<double> items(64, 1.0);
  std::vector<std::int32_t> labels(64);
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = static_cast<std::int32_t>(i);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (std::size_t clusters = 0; clusters <= 64; ++clusters) runs.sort(items, labels, clusters);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_EQ(runs.size(), 64U);
}

}  // namespace
}  // namespace boresight::geometry
