#include "services/common/geometry/assignment.hpp"

#include <algorithm>

namespace boresight::geometry {

Assignment::Assignment() : cost_(std::make_unique<double[]>(kCapacity * kCapacity)) {}

void Assignment::reset(std::size_t rows, std::size_t columns, double cost_alone) {
  rows_ = std::min(rows, kCapacity);
  columns_ = std::min(columns, kCapacity);
  stride_ = kCapacity;
  cost_alone_ = cost_alone;
  for (std::size_t r = 0; r < rows_; ++r) std::fill_n(cost_.get() + r * stride_, columns_, kForbidden);
}

void Assignment::solve() {
  // Each row has an extra column for staying unassigned, so that a solution always exists.
  constexpr std::size_t kWidth = 2 * kCapacity + 1;
  const std::size_t width = columns_ + rows_;
  const auto cost = [&](std::size_t row, std::size_t column) {
    if (column < columns_) return cost_[row * stride_ + column];
    return column - columns_ == row ? cost_alone_ : kForbidden;
  };
  std::array<double, kCapacity + 1> row_price{};
  std::array<double, kWidth> column_price{};
  std::array<std::size_t, kWidth> row_of{};  // 1-based row of a 1-based column, 0: free
  for (std::size_t row = 1; row <= rows_; ++row) {
    std::array<double, kWidth> distance;
    std::array<std::size_t, kWidth> previous{};
    std::array<bool, kWidth> done{};
    distance.fill(kForbidden);
    row_of[0] = row;
    std::size_t column = 0;
    do {
      done[column] = true;
      const std::size_t at_row = row_of[column];
      double least = kForbidden;
      std::size_t next = 0;
      for (std::size_t c = 1; c <= width; ++c) {
        if (done[c]) continue;
        const double pair = cost(at_row - 1, c - 1);
        const double reduced = pair - row_price[at_row] - column_price[c];
        if (reduced < distance[c]) {
          distance[c] = reduced;
          previous[c] = column;
        }
        if (distance[c] < least) {
          least = distance[c];
          next = c;
        }
      }
      for (std::size_t c = 0; c <= width; ++c) {
        if (done[c]) {
          row_price[row_of[c]] += least;
          column_price[c] -= least;
        } else {
          distance[c] -= least;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    while (column != 0) {
      const std::size_t before = previous[column];
      row_of[column] = row_of[before];
      column = before;
    }
  }
  std::fill_n(column_of_.begin(), rows_, kNone);
  total_ = 0.0;
  for (std::size_t c = 1; c <= width; ++c) {
    if (row_of[c] == 0) continue;
    total_ += cost(row_of[c] - 1, c - 1);
    if (c <= columns_) column_of_[row_of[c] - 1] = static_cast<std::int32_t>(c - 1);
  }
}

}  // namespace boresight::geometry
