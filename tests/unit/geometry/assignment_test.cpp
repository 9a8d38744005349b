#include "services/common/geometry/assignment.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::geometry {
namespace {

using Costs = std::vector<std::vector<double>>;  // [row][column]

/// The least total over all assignments of rows to distinct columns, or to none.
double least(const Costs& costs, double alone, std::size_t row = 0, unsigned used = 0) {
  if (row == costs.size()) return 0.0;
  double best = alone + least(costs, alone, row + 1, used);
  for (std::size_t c = 0; c < costs[row].size(); ++c) {
    if ((used >> c & 1u) != 0 || costs[row][c] == Assignment::kForbidden) continue;
    best = std::min(best, costs[row][c] + least(costs, alone, row + 1, used | 1u << c));
  }
  return best;
}

TEST(Assignment, IsTheBestOfAllOnRandomProblems) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> cost(0.0, 20.0);
  std::uniform_int_distribution<std::size_t> size(0, 6);
  Assignment assignment;
  for (int round = 0; round < 2000; ++round) {
    const std::size_t rows = size(random), columns = size(random);
    const double alone = 10.0;
    Costs costs(rows, std::vector<double>(columns, Assignment::kForbidden));
    assignment.reset(rows, columns, alone);
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < columns; ++c) {
        if (cost(random) < 6.0) continue;
        // Round costs give ties.
        costs[r][c] = round % 2 == 0 ? cost(random) : std::floor(cost(random) / 4.0);
        assignment.set(r, c, costs[r][c]);
      }
    }
    assignment.solve();
    double total = 0.0;
    std::vector<int> users(columns, 0);
    for (std::size_t r = 0; r < rows; ++r) {
      const std::int32_t c = assignment.column_of(r);
      if (c == Assignment::kNone) {
        total += alone;
        continue;
      }
      ASSERT_LT(static_cast<std::size_t>(c), columns);
      ASSERT_NE(costs[r][static_cast<std::size_t>(c)], Assignment::kForbidden) << "a forbidden pair";
      ++users[static_cast<std::size_t>(c)];
      total += costs[r][static_cast<std::size_t>(c)];
    }
    EXPECT_TRUE(std::all_of(users.begin(), users.end(), [](int n) { return n <= 1; }));
    ASSERT_NEAR(total, least(costs, alone), 1e-9) << "round " << round;
    EXPECT_NEAR(assignment.total_cost(), total, 1e-9);
  }
}

TEST(Assignment, NaNIsNoPair) {
  Assignment assignment;
  assignment.reset(2, 2, 10.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  assignment.set(0, 0, nan);
  assignment.set(0, 1, 4.0);
  assignment.set(1, 0, nan);
  assignment.set(1, 1, 3.0);
  assignment.solve();
  EXPECT_EQ(assignment.column_of(0), Assignment::kNone);
  EXPECT_EQ(assignment.column_of(1), 1);
  EXPECT_EQ(assignment.total_cost(), 13.0);
}

TEST(Assignment, IsIndependentOfThePreviousProblem) {
  Assignment assignment;
  assignment.reset(3, 3, 10.0);
  for (std::size_t i = 0; i < 3; ++i) assignment.set(i, i, 1.0);
  assignment.solve();
  assignment.reset(2, 3, 10.0);
  assignment.solve();
  EXPECT_EQ(assignment.column_of(0), Assignment::kNone);
  EXPECT_EQ(assignment.column_of(1), Assignment::kNone);
  EXPECT_EQ(assignment.total_cost(), 20.0);
}

TEST(Assignment, FullSizeIsSolvedAndAllocatesNothing) {
  Assignment assignment;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> cost(0.0, 1.0);
  constexpr std::size_t n = Assignment::kCapacity;
  // Only the diagonal is cheap: there is one best assignment.
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  std::shuffle(order.begin(), order.end(), random);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    assignment.reset(n, n, 100.0);
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < n; ++c) assignment.set(r, c, c == order[r] ? 0.1 * cost(random) : 5.0 + cost(random));
    }
    assignment.solve();
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  for (std::size_t r = 0; r < n; ++r) EXPECT_EQ(assignment.column_of(r), static_cast<std::int32_t>(order[r]));
}

}  // namespace
}  // namespace boresight::geometry
