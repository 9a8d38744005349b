// Finds numbers by position: the cells of a plane's grid repeat periodically over a square of chains, like tiles on a
// floor. This needs no hashing, and all data stay in the cache. A search also visits numbers a multiple of the period
// away in the same chain; the caller rejects them by their distance.
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
  static constexpr std::int32_t kSide = 32;  ///< period in cells
  /// For numbers below `capacity`.
  CellChains(std::size_t capacity, double cell_m)
      : cell_m_(cell_m), first_(static_cast<std::size_t>(kSide) * kSide, kNone), next_(capacity, kNone) {}

  void clear() {
    std::fill(first_.begin(), first_.end(), kNone);
    filled_.fill(0);
  }
  /// Enters a number at its position; ignores numbers beyond the capacity. At most once per number after clear().
  void link(const Eigen::Vector2d& position_m, std::uint32_t number) {
    if (number >= next_.size()) return;
    const GridCell at = grid_cell(position_m.x(), position_m.y(), cell_m_);
    std::uint32_t& first = first_[chain_of(at.column, at.row)];
    filled_[within(at.column)] |= Rows{1} << within(at.row);
    next_[number] = first;
    first = number;
  }
  /// Calls `visit(number)` for the numbers in the cell of a position and in its eight neighbours, which include all
  /// within `cell_m`. Also visits numbers in the same chains a multiple of kSide cells away.
  template <typename Visit>
  void near(const Eigen::Vector2d& position_m, const Visit& visit) const {
    const GridCell at = grid_cell(position_m.x(), position_m.y(), cell_m_);
    for (std::int32_t column = at.column - 1; column <= at.column + 1; ++column) {
      // Most cells are empty; one comparison finds this for three cells.
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
  std::array<Rows, kSide> filled_{};  // by column: the rows with entries
};

}  // namespace boresight::geometry
