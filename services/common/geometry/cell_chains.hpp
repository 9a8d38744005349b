// Numbers to be found by place: the cells of a plane's grid repeat over a square of chains, like tiles on a floor, so
// that nothing is hashed and all of it stays in the cache. What is a period away in the same chain is met as well, and
// told apart by whoever looks at distances anyway.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/cell_table.hpp"

namespace boresight::geometry {

class CellChains {
 public:
  static constexpr std::int32_t kSide = 32;  ///< cells after which the plane repeats
  /// For numbers less than `capacity`.
  CellChains(std::size_t capacity, double cell_m)
      : cell_m_(cell_m), first_(static_cast<std::size_t>(kSide) * kSide, kNone), next_(capacity, kNone) {}

  void clear() {
    std::fill(first_.begin(), first_.end(), kNone);
    filled_.fill(0);
  }
  /// Enters a number at its place; numbers beyond the capacity are not entered. Once for each number after clear().
  void link(const Eigen::Vector2d& position_m, std::uint32_t number) {
    if (number >= next_.size()) return;
    const GridCell at = grid_cell(position_m.x(), position_m.y(), cell_m_);
    std::uint32_t& first = first_[chain_of(at.column, at.row)];
    filled_[within(at.column)] |= Rows{1} << within(at.row);
    next_[number] = first;
    first = number;
  }
  /// Calls `visit(number)` for those in the cell of a position and in the eight about it: all within `cell_m` of it.
  /// And for those that many times kSide cells away.
  template <typename Visit>
  void near(const Eigen::Vector2d& position_m, const Visit& visit) const {
    const GridCell at = grid_cell(position_m.x(), position_m.y(), cell_m_);
    for (std::int32_t column = at.column - 1; column <= at.column + 1; ++column) {
      // Most cells are empty: that is told of three at once.
      Rows left = std::rotr(filled_[within(column)], static_cast<int>(within(at.row - 1))) & 7U;
      for (; left != 0; left &= left - 1) {
        const std::int32_t row = at.row - 1 + std::countr_zero(left);
        for (std::uint32_t i = first_[chain_of(column, row)]; i != kNone; i = next_[i]) visit(i);
      }
    }
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  using Rows = std::uint32_t;  // a bit for each row of a column
  static_assert(kSide == std::numeric_limits<Rows>::digits);
  [[nodiscard]] static std::size_t within(std::int32_t cell) { return static_cast<std::size_t>(cell & (kSide - 1)); }
  [[nodiscard]] static std::size_t chain_of(std::int32_t column, std::int32_t row) {
    return within(column) * kSide + within(row);
  }
  double cell_m_;
  std::vector<std::uint32_t> first_, next_;
  std::array<Rows, kSide> filled_{};  // by column: in which rows there is anything
};

}  // namespace boresight::geometry
