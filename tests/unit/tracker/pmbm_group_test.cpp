// Groups of hypotheses in work and in store, by hand-made tables.
#include <array>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/tracker/core/pmbm/group.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking::pmbm {
namespace {

using ::testing::ElementsAre;

Capacity small_capacity() {
  Capacity c;
  c.measurements = 16;
  c.objects = 8;
  c.local_hypotheses = 24;
  c.groups = 4;
  c.group_objects = 4;
  c.group_measurements = 8;
  c.rows = 4;
  c.candidates = 6;
  c.poisson_components = 4;
  return c;
}

/// An object at `x_m` with an existence and a number of detections.
LocalHypothesis local_at(double x_m, double existence, double detections = 0.0) {
  LocalHypothesis l;
  l.existence = existence;
  l.detections = detections;
  l.component.position_m = {x_m, 0.0};
  l.component.position_covariance = {1.0, 0.0, 1.0};
  l.component.velocity_covariance = {1.0, 0.0, 1.0};
  l.component.extent_scale = {4.0, 0.0, 4.0};
  l.component.rate_shape = 10.0;
  l.component.rate_inverse_scale = 2.0;
  return l;
}

/// Each inner list is a row: the weight, then a local hypothesis a column.
struct TableRow {
  double weight;
  std::vector<int> locals;
};
Group group_of(const Capacity& capacity, const std::vector<std::uint32_t>& ids,
               const std::vector<LocalHypothesis>& locals, const std::vector<TableRow>& rows) {
  Group g(capacity);
  for (const TableRow& row : rows) EXPECT_TRUE(g.add_row(std::log(row.weight)));
  for (const std::uint32_t id : ids) EXPECT_TRUE(g.add_column(id));
  for (const LocalHypothesis& l : locals) EXPECT_GE(g.add_local(l), 0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < ids.size(); ++c) g.at(r, c) = static_cast<std::int16_t>(rows[r].locals[c]);
  }
  return g;
}
std::vector<double> weights_of(std::span<const double> logs) {
  std::vector<double> w;
  for (const double l : logs) w.push_back(std::exp(l));
  return w;
}
double sum_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum;
}

TEST(Group, WeightsAddUpToOneWhenNormalisedWhateverTheirSize) {
  for (const double scale : {1.0, 1e-300, 1e300}) {
    Group g = group_of(small_capacity(), {1}, {local_at(0.0, 1.0)}, {{3.0 * scale, {0}}, {1.0 * scale, {-1}}});
    g.normalise();
    EXPECT_NEAR(std::exp(g.log_weights[0]), 0.75, 1e-12);
    EXPECT_NEAR(std::exp(g.log_weights[1]), 0.25, 1e-12);
  }
}

TEST(Group, ExistenceIsThatOfTheRowsThatNameTheObject) {
  const Group g = group_of(small_capacity(), {1, 2}, {local_at(0.0, 0.8), local_at(1.0, 0.5), local_at(9.0, 1.0)},
                           {{0.5, {0, 2}}, {0.3, {1, -1}}, {0.2, {-1, 2}}});
  EXPECT_NEAR(g.existence(0), 0.5 * 0.8 + 0.3 * 0.5, 1e-12);
  EXPECT_NEAR(g.existence(1), 0.7, 1e-12);
}

TEST(Group, TakesNoMoreRowsColumnsAndLocalsThanItHasRoomFor) {
  const Capacity capacity = small_capacity();
  Group g(capacity);
  std::size_t rows = 0, columns = 0, locals = 0;
  while (g.add_row(0.0)) ++rows;
  while (g.add_column(7)) ++columns;
  while (g.add_local(local_at(0.0, 1.0)) >= 0) ++locals;
  EXPECT_EQ(rows, capacity.rows * capacity.rows);
  EXPECT_EQ(columns, capacity.group_objects);
  EXPECT_EQ(locals, group_pool(capacity));
  EXPECT_EQ(g.at(rows - 1, columns - 1), -1) << "a row of nothing";
}

TEST(Group, ErasedRowIsGoneAndTheOthersKeepTheirOrder) {
  Group g = group_of(small_capacity(), {1, 2}, {local_at(0.0, 1.0), local_at(1.0, 1.0), local_at(2.0, 1.0)},
                     {{0.5, {0, 1}}, {0.3, {1, 2}}, {0.2, {2, 0}}});
  g.erase_row(1);
  ASSERT_EQ(g.rows(), 2U);
  EXPECT_NEAR(std::exp(g.log_weights[1]), 0.2, 1e-12);
  EXPECT_EQ(g.at(1, 0), 2);
  EXPECT_EQ(g.at(1, 1), 0);
}

TEST(GroupReduction, JoinsRowsThatNameTheSameHypotheses) {
  Group g = group_of(small_capacity(), {1, 2}, {local_at(0.0, 1.0), local_at(1.0, 1.0)},
                     {{0.4, {0, 1}}, {0.3, {0, -1}}, {0.2, {0, 1}}, {0.1, {0, -1}}});
  g.join_equal_rows();
  EXPECT_THAT(weights_of(g.log_weights), ElementsAre(testing::DoubleNear(0.6, 1e-12), testing::DoubleNear(0.4, 1e-12)));
  EXPECT_EQ(g.at(0, 1), 1);
  EXPECT_EQ(g.at(1, 1), -1);
}

TEST(GroupReduction, MergesRowsWhoseHypothesesAreAlikeByTheirMoments) {
  // 0.2 m apart with 1 m of deviation: alike.
  Group g =
      group_of(small_capacity(), {1}, {local_at(0.0, 1.0, 3.0), local_at(0.2, 0.5, 1.0)}, {{0.6, {0}}, {0.4, {1}}});
  g.merge_similar_rows(1.0);
  ASSERT_EQ(g.rows(), 1U);
  EXPECT_NEAR(std::exp(g.log_weights[0]), 1.0, 1e-12);
  const LocalHypothesis& merged = g.pool[static_cast<std::size_t>(g.at(0, 0))];
  EXPECT_NEAR(merged.existence, 0.6 + 0.4 * 0.5, 1e-12);
  const double share = 0.6 / 0.8;
  EXPECT_NEAR(merged.component.position_m.x, (1.0 - share) * 0.2, 1e-12);
  EXPECT_NEAR(merged.component.position_covariance.xx, 1.0 + share * (1.0 - share) * 0.04, 1e-12);
  EXPECT_EQ(merged.detections, 3.0) << "of the likelier row";
}

TEST(GroupReduction, KeepsRowsWhoseHypothesesDiffer) {
  Group g = group_of(small_capacity(), {1}, {local_at(0.0, 1.0), local_at(5.0, 1.0)}, {{0.6, {0}}, {0.4, {1}}});
  g.merge_similar_rows(1.0);
  EXPECT_EQ(g.rows(), 2U);
}

TEST(GroupReduction, MergesRowsThatDifferInTheExistenceOfOneObjectOnly) {
  Group g =
      group_of(small_capacity(), {1, 2}, {local_at(0.0, 1.0), local_at(50.0, 0.9)}, {{0.7, {0, 1}}, {0.3, {0, -1}}});
  const double before = g.existence(1);
  g.merge_similar_rows(1.0);
  ASSERT_EQ(g.rows(), 1U);
  EXPECT_NEAR(g.existence(1), before, 1e-12);
  EXPECT_NEAR(g.pool[static_cast<std::size_t>(g.at(0, 1))].component.position_m.x, 50.0, 1e-12);
  // Not if two objects differ: their existences depend on each other.
  Group two =
      group_of(small_capacity(), {1, 2}, {local_at(0.0, 1.0), local_at(50.0, 1.0)}, {{0.5, {0, -1}}, {0.5, {-1, 1}}});
  two.merge_similar_rows(1.0);
  EXPECT_EQ(two.rows(), 2U);
}

TEST(GroupReduction, KeepsTheExistenceOfEachObjectWhenMerging) {
  support::Random random(1);
  for (int run = 0; run < 200; ++run) {
    std::vector<LocalHypothesis> locals;
    for (int i = 0; i < 6; ++i)
      locals.push_back(local_at(0.3 * support::normal(random), support::uniform(random, 0.2, 1.0)));
    std::vector<TableRow> rows;
    double total = 0.0;
    for (int r = 0; r < 4; ++r) {
      rows.push_back({support::uniform(random, 0.1, 1.0), {}});
      for (int c = 0; c < 3; ++c) rows.back().locals.push_back(static_cast<int>(random() % 7) - 1);
      total += rows.back().weight;
    }
    for (TableRow& row : rows) row.weight /= total;
    Group g = group_of(small_capacity(), {1, 2, 3}, locals, rows);
    const std::array<double, 3> before{g.existence(0), g.existence(1), g.existence(2)};
    g.join_equal_rows();
    g.merge_similar_rows(1.0);
    EXPECT_NEAR(sum_of(weights_of(g.log_weights)), 1.0, 1e-12);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(g.existence(c), before[c], 1e-12);
  }
}

TEST(GroupReduction, StopsMergingWhereThePoolIsFull) {
  const Capacity capacity = small_capacity();
  std::vector<LocalHypothesis> locals(group_pool(capacity), local_at(0.0, 1.0));
  Group g = group_of(capacity, {1}, locals, {{0.6, {0}}, {0.4, {1}}});
  g.merge_similar_rows(1.0);
  EXPECT_EQ(g.rows(), 2U);
}

TEST(GroupReduction, PrunesUnlikelyRowsAndThoseBeyondTheMost) {
  Group g = group_of(small_capacity(), {1}, {local_at(0.0, 1.0), local_at(1.0, 1.0)},
                     {{0.1, {0}}, {0.5, {1}}, {1e-4, {0}}, {0.3999, {-1}}});
  g.prune_rows(1e-3, 4);
  ASSERT_EQ(g.rows(), 3U);
  EXPECT_NEAR(std::exp(g.log_weights[0]), 0.5 / 0.9999, 1e-9) << "the likeliest first";
  EXPECT_EQ(g.at(0, 0), 1);
  EXPECT_EQ(g.at(1, 0), -1);
  EXPECT_EQ(g.at(2, 0), 0);
  EXPECT_NEAR(sum_of(weights_of(g.log_weights)), 1.0, 1e-12);
  g.prune_rows(1e-3, 2);
  ASSERT_EQ(g.rows(), 2U);
  EXPECT_EQ(g.at(1, 0), -1);
  EXPECT_NEAR(sum_of(weights_of(g.log_weights)), 1.0, 1e-12);
  g.prune_rows(2.0, 2);
  EXPECT_EQ(g.rows(), 1U) << "one always stays";
}

TEST(GroupStore, GivesBackTheColumnsThatWereStored) {
  const Capacity capacity = small_capacity();
  const Group g =
      group_of(capacity, {11, 12, 13}, {local_at(0.0, 1.0), local_at(1.0, 0.9), local_at(2.0, 0.8), local_at(3.0, 0.7)},
               {{0.6, {3, 0, 1}}, {0.4, {2, 0, -1}}});
  GroupStore store(capacity);
  const std::array<std::size_t, 2> columns{0, 2};
  ASSERT_TRUE(store.store(g, columns));
  ASSERT_EQ(store.size(), 1U);
  EXPECT_THAT(store.ids(0), ElementsAre(11U, 13U));
  EXPECT_THAT(weights_of(store.log_weights(0)), ElementsAre(testing::DoubleEq(0.6), testing::DoubleEq(0.4)));
  ASSERT_EQ(store.pool(0).size(), 3U) << "only the locals that are named";
  const auto place = [&](std::size_t row, std::size_t column) {
    return store.pool(0)[static_cast<std::size_t>(store.at(0, row, column))].component.position_m.x;
  };
  EXPECT_EQ(place(0, 0), 3.0);
  EXPECT_EQ(place(0, 1), 1.0);
  EXPECT_EQ(place(1, 0), 2.0);
  EXPECT_EQ(store.at(0, 1, 1), -1);

  Group back(capacity);
  ASSERT_TRUE(store.join_into(back, 0, capacity.rows));
  EXPECT_THAT(back.ids, ElementsAre(11U, 13U));
  ASSERT_EQ(back.rows(), 2U);
  EXPECT_NEAR(back.existence(0), 0.6 * 0.7 + 0.4 * 0.8, 1e-12);
  EXPECT_NEAR(back.existence(1), 0.6 * 0.9, 1e-12);
}

TEST(GroupStore, JoinsGroupsToTheProductOfTheirRows) {
  const Capacity capacity = small_capacity();
  GroupStore store(capacity);
  const std::array<std::size_t, 1> first{0};
  ASSERT_TRUE(
      store.store(group_of(capacity, {1}, {local_at(0.0, 1.0), local_at(1.0, 1.0)}, {{0.7, {0}}, {0.3, {1}}}), first));
  ASSERT_TRUE(store.store(group_of(capacity, {2}, {local_at(8.0, 0.9)}, {{0.6, {0}}, {0.4, {-1}}}), first));
  ASSERT_TRUE(store.store_alone(3, local_at(20.0, 0.5)));
  Group g(capacity);
  for (std::size_t i = 0; i < 3; ++i) ASSERT_TRUE(store.join_into(g, i, capacity.rows));
  EXPECT_THAT(g.ids, ElementsAre(1U, 2U, 3U));
  ASSERT_EQ(g.rows(), 4U);
  EXPECT_NEAR(sum_of(weights_of(g.log_weights)), 1.0, 1e-12);
  for (std::size_t r = 0; r < 4; ++r) {
    const auto& one = g.pool[static_cast<std::size_t>(g.at(r, 0))];
    const double of_first = one.component.position_m.x == 0.0 ? 0.7 : 0.3;
    const double of_second = g.at(r, 1) >= 0 ? 0.6 : 0.4;
    EXPECT_NEAR(std::exp(g.log_weights[r]), of_first * of_second, 1e-12);
    EXPECT_EQ(g.pool[static_cast<std::size_t>(g.at(r, 2))].component.position_m.x, 20.0);
  }
  // With room for two rows, the two likeliest products stay.
  Group few(capacity);
  for (std::size_t i = 0; i < 2; ++i) ASSERT_TRUE(store.join_into(few, i, 2));
  EXPECT_THAT(weights_of(few.log_weights),
              ElementsAre(testing::DoubleNear(0.42, 1e-12), testing::DoubleNear(0.28, 1e-12)));
}

TEST(GroupStore, RefusesToJoinWhatHasNoRoomAndLeavesTheGroupAsItIs) {
  const Capacity capacity = small_capacity();
  GroupStore store(capacity);
  const std::array<std::size_t, 3> all{0, 1, 2};
  ASSERT_TRUE(store.store(group_of(capacity, {1, 2, 3}, {local_at(0.0, 1.0)}, {{1.0, {0, 0, 0}}}), all));
  Group g(capacity);
  ASSERT_TRUE(store.join_into(g, 0, 4));
  EXPECT_FALSE(store.join_into(g, 0, 4)) << "six columns of four";
  EXPECT_EQ(g.columns(), 3U);
  EXPECT_EQ(g.rows(), 1U);
}

TEST(GroupStore, KeepsNothingOfAGroupThatHasNoRoom) {
  Capacity capacity = small_capacity();
  capacity.local_hypotheses = 5;
  GroupStore store(capacity);
  ASSERT_TRUE(store.store_alone(1, local_at(0.0, 1.0)));
  Capacity large = small_capacity();
  std::vector<LocalHypothesis> locals;
  for (int i = 0; i < 6; ++i) locals.push_back(local_at(i, 1.0));
  const Group g = group_of(large, {2, 3, 4}, locals, {{0.5, {0, 1, 2}}, {0.5, {3, 4, 5}}});
  const std::array<std::size_t, 3> all{0, 1, 2};
  EXPECT_FALSE(store.store(g, all)) << "one and six locals of five";
  EXPECT_EQ(store.size(), 1U);
  for (std::uint32_t id = 2; id <= 4; ++id) EXPECT_TRUE(store.store_alone(id, local_at(5.0, 1.0)));
  EXPECT_EQ(store.ids(3)[0], 4U);
  EXPECT_FALSE(store.store_alone(5, local_at(5.0, 1.0))) << "five groups of four";
}

TEST(GroupStore, RefusesMoreObjectsGroupsAndRowsThanItHasRoomFor) {
  const Capacity capacity = small_capacity();
  GroupStore store(capacity);
  const std::array<std::size_t, 3> all{0, 1, 2};
  const Group g = group_of(capacity, {1, 2, 3}, {local_at(0.0, 1.0)}, {{1.0, {0, 0, 0}}});
  EXPECT_TRUE(store.store(g, all));
  EXPECT_TRUE(store.store(g, all));
  EXPECT_FALSE(store.store(g, all)) << "nine objects of eight";
  store.clear();
  EXPECT_EQ(store.size(), 0U);
  EXPECT_TRUE(store.store(g, all));
}

}  // namespace
}  // namespace boresight::tracking::pmbm
