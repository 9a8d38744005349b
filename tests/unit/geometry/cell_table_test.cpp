#include "services/common/geometry/cell_table.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace boresight::geometry {
namespace {

TEST(GridCell, BordersBelongToTheCellAbove) {
  EXPECT_EQ(grid_cell(0.0, 0.0, 2.0), (GridCell{0, 0}));
  EXPECT_EQ(grid_cell(-1e-9, 1.999, 2.0), (GridCell{-1, 0}));
  EXPECT_EQ(grid_cell(2.0, -2.0, 2.0), (GridCell{1, -1}));
  EXPECT_EQ(grid_cell(1e30, -1e30, 1.0), (GridCell{1'000'000, -1'000'000})) << "a distant position has a defined cell";
  EXPECT_EQ(grid_cell(std::numeric_limits<double>::quiet_NaN(), 3.0, 2.0), (GridCell{-500'000, 1}));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1000.0, 1000.0);
  for (int i = 0; i < 1000; ++i) {
    const double x = place(random), size = 0.1 + 0.01 * i;
    ASSERT_EQ(grid_cell(0.0, x, size).row, static_cast<std::int32_t>(std::floor(x / size))) << x << ", " << size;
  }
}

TEST(CellTable, IsAMapThatForgetsAtOnce) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int32_t> place(-40, 40);
  constexpr std::size_t kCapacity = 500;
  CellTable table(kCapacity);
  for (int round = 0; round < 200; ++round) {
    table.clear();
    std::map<std::pair<std::int32_t, std::int32_t>, std::uint32_t> reference;
    for (std::uint32_t i = 0; i < kCapacity; ++i) {
      const GridCell cell{place(random), place(random)};
      const auto expected = reference.try_emplace({cell.column, cell.row}, i).first->second;
      ASSERT_EQ(table.at(cell, i), expected) << "round " << round;
    }
    for (std::int32_t column = -40; column <= 40; ++column) {
      for (std::int32_t row = -40; row <= 40; ++row) {
        const auto known = reference.find({column, row});
        const std::uint32_t* const found = table.find({column, row});
        ASSERT_EQ(found != nullptr, known != reference.end()) << column << ", " << row;
        if (found != nullptr) {
          ASSERT_EQ(*found, known->second);
        }
      }
    }
  }
}

TEST(CellTable, ForgetsSingleCells) {
  std::mt19937 random(2);
  // Few slots for many cells: the largest fill, with long runs of displaced cells.
  std::uniform_int_distribution<std::int32_t> place(0, 24);
  constexpr std::size_t kCapacity = 256;
  CellTable table(kCapacity);
  std::map<std::pair<std::int32_t, std::int32_t>, std::uint32_t> reference;
  for (std::uint32_t step = 0; step < 20000; ++step) {
    const GridCell cell{place(random), place(random)};
    if (reference.size() == kCapacity || random() % 2 == 0) {
      table.erase(cell);
      reference.erase({cell.column, cell.row});
    } else {
      const auto expected = reference.try_emplace({cell.column, cell.row}, step).first->second;
      ASSERT_EQ(table.at(cell, step), expected) << "step " << step;
    }
    if (step % 97 != 0) continue;
    for (std::int32_t column = 0; column <= 24; ++column) {
      for (std::int32_t row = 0; row <= 24; ++row) {
        const auto known = reference.find({column, row});
        const std::uint32_t* const found = table.find({column, row});
        ASSERT_EQ(found != nullptr, known != reference.end()) << "step " << step;
        if (found != nullptr) {
          ASSERT_EQ(*found, known->second);
        }
      }
    }
  }
}

}  // namespace
}  // namespace boresight::geometry
