#include <gtest/gtest.h>

#include "services/tracker/core/ggiw/cell.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking {
namespace {

support::Detections cell_detections(support::Random& random, std::size_t n) {
  const support::Reference object = support::random_object(random);
  support::Detections z =
      support::draw_detections(random, object.mean, object.extent(), support::random_view(random, true), n, -5.0);
  for (auto& m : z) {
    m.log_clutter = support::uniform(random, -9.0, -3.0);
    m.side_lobe_share = support::uniform(random, 0.0, 1.0);
    m.partner = support::uniform(random, 0.0, 1.0);
    m.strength_db = support::uniform(random, -20.0, 20.0);
    m.strengths = support::uniform(random, 0.0, 1.0) < 0.7 ? 1.0 : 0.0;
    m.mirror = support::uniform(random, 0.0, 1.0);
  }
  return z;
}

void expect_equal_cells(const Cell<double>& a, const Cell<double>& b) {
  EXPECT_EQ(a.n, b.n);
  EXPECT_EQ(a.key, b.key);
  EXPECT_NEAR(a.sum.x, b.sum.x, 1e-9);
  EXPECT_NEAR(a.sum.y, b.sum.y, 1e-9);
  EXPECT_LT((support::eigen(a.sum_squares) - support::eigen(b.sum_squares)).norm(), 1e-9);
  EXPECT_LT((support::eigen(a.sight_squares) - support::eigen(b.sight_squares)).norm(), 1e-12);
  EXPECT_LT((support::eigen(a.sight_rate) - support::eigen(b.sight_rate)).norm(), 1e-11);
  EXPECT_NEAR(a.rate_squares, b.rate_squares, 1e-9);
  EXPECT_NEAR(a.log_clutter, b.log_clutter, 1e-12);
  EXPECT_NEAR(a.side_lobe_share, b.side_lobe_share, 1e-12);
  EXPECT_NEAR(a.partner, b.partner, 1e-12);
  EXPECT_NEAR(a.strength_sum, b.strength_sum, 1e-12);
  EXPECT_EQ(a.strengths, b.strengths);
  EXPECT_NEAR(a.mirror, b.mirror, 1e-12);
}

TEST(Cell, HasMeanAndScatterOfItsMeasurements) {
  support::Random random(1);
  for (int run = 0; run < 200; ++run) {
    const support::Detections z = cell_detections(random, 1 + static_cast<std::size_t>(run % 12));
    const Cell<double> cell = support::cell_of(z);
    const support::Sums expected = support::sums_of(z);
    EXPECT_EQ(cell.n, expected.n);
    EXPECT_LT((support::eigen(cell.mean()) - expected.mean).norm(), 1e-12);
    EXPECT_LT((support::eigen(cell.scatter()) - expected.scatter).norm(), 1e-9);
    EXPECT_LT((support::eigen(cell.sight_squares) - expected.sights.transpose() * expected.sights).norm(), 1e-12);
    EXPECT_LT((support::eigen(cell.sight_rate) - expected.sights.transpose() * expected.rates).norm(), 1e-11);
    EXPECT_NEAR(cell.rate_squares, expected.rates.squaredNorm(), 1e-9);
  }
}

TEST(Cell, IsAsBeforeWhenAMeasurementWasAddedAndRemoved) {
  support::Random random(2);
  const support::Detections z = cell_detections(random, 6);
  const Cell<double> before = support::cell_of(z);
  Cell<double> cell = before;
  const Measurement<double> other = cell_detections(random, 1).front();
  cell.add(other, std::uint64_t{1} << 40U);
  EXPECT_NE(cell.key, before.key);
  cell.remove(other, std::uint64_t{1} << 40U);
  expect_equal_cells(cell, before);
}

TEST(Cell, OfTwoJoinedEqualsTheCellOfAllInAnyOrder) {
  support::Random random(3);
  const support::Detections z = cell_detections(random, 9);
  Cell<double> first, second, reversed;
  for (std::size_t i = 0; i < z.size(); ++i) (i < 4 ? first : second).add(z[i], std::uint64_t{1} << i);
  for (std::size_t i = z.size(); i-- > 0;) reversed.add(z[i], std::uint64_t{1} << i);
  first.join(second);
  expect_equal_cells(first, support::cell_of(z));
  expect_equal_cells(reversed, support::cell_of(z));
}

TEST(Cell, SharesOfOneMeasurementAddUpToIt) {
  support::Random random(4);
  const Measurement<double> z = cell_detections(random, 1).front();
  Cell<double> shared, whole;
  for (const double share : {0.5, 0.25, 0.125, 0.125}) shared.add(z, share);
  whole.add(z, 1.0);
  expect_equal_cells(shared, whole);
}

TEST(Cell, ScatterIsNeverIndefiniteWhateverTheRounding) {
  support::Random random(5);
  for (int run = 0; run < 20'000; ++run) {
    // All at nearly one place, far from the origin: the sums cancel.
    const Eigen::Vector2d place(support::uniform(random, 100.0, 1000.0), support::uniform(random, 100.0, 1000.0));
    Cell<float> cell;
    for (int i = 0; i < 2 + run % 9; ++i) {
      Measurement<float> z;
      z.position_m = {static_cast<float>(place.x() + 1e-3 * support::normal(random)),
                      static_cast<float>(place.y() + 1e-3 * support::normal(random))};
      cell.add(z, 1.0F);
    }
    const Symmetric2<float> s = cell.scatter();
    ASSERT_GE(s.xx, 0.0F);
    ASSERT_GE(s.yy, 0.0F);
    ASSERT_LE(std::abs(s.xy), std::sqrt(s.xx * s.yy) * 1.000001F);
  }
}

TEST(Cell, OfOneMeasurementHasNoScatter) {
  Cell<double> cell;
  Measurement<double> z;
  z.position_m = {123.456, -78.9};
  cell.add(z, std::uint64_t{1});
  EXPECT_NEAR(trace(cell.scatter()), 0.0, 1e-11);
  EXPECT_EQ(cell.mean().x, 123.456);
}

}  // namespace
}  // namespace boresight::tracking
