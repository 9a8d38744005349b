// A number for each cell of a plane's grid: a hash table without allocation, emptied in constant time.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boresight::geometry {

struct GridCell {
  std::int32_t column;
  std::int32_t row;
  [[nodiscard]] bool operator==(const GridCell&) const = default;
};

/// The cell of a position in a grid of `size_m`; positions beyond 1000 km, and NaN, are set to 1000 km.
[[nodiscard]] inline GridCell grid_cell(double x_m, double y_m, double size_m) {
  static constexpr double kFarthest_m = 1e6;
  const auto index = [size_m](double v) {
    // With this order of the arguments, NaN becomes the other argument.
    const double cells = std::min(kFarthest_m, std::max(-kFarthest_m, v)) / size_m;
    const auto towards_zero = static_cast<std::int32_t>(cells);  // std::floor costs twice as much
    return towards_zero - (cells < towards_zero ? 1 : 0);
  };
  return {index(x_m), index(y_m)};
}

class CellTable {
 public:
  /// For at most `capacity` cells, which is not checked.
  explicit CellTable(std::size_t capacity) : slots_(std::bit_ceil(2 * std::max<std::size_t>(capacity, 1))) {}

  void clear() {
    if (++round_ != 0) return;
    std::fill(slots_.begin(), slots_.end(), Slot{});
    round_ = 1;
  }

  /// The cell's number; a cell without a number gets `fresh`.
  [[nodiscard]] std::uint32_t& at(GridCell cell, std::uint32_t fresh) {
    Slot& slot = slots_[find_slot(cell)];
    if (slot.round != round_) slot = {round_, fresh, cell};
    return slot.value;
  }
  /// Forgets one cell, if it had a number.
  void erase(GridCell cell) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t hole = find_slot(cell);
    if (slots_[hole].round != round_) return;
    // Displaced entries move up, so that searches meet no empty slot before their goal (Knuth 6.4, algorithm R).
    for (std::size_t at = (hole + 1) & mask; slots_[at].round == round_; at = (at + 1) & mask) {
      if (((at - home(slots_[at].cell)) & mask) < ((at - hole) & mask)) continue;
      slots_[hole] = slots_[at];
      hole = at;
    }
    slots_[hole].round = 0;
  }
  /// Nullptr for a cell without a number.
  [[nodiscard]] const std::uint32_t* find(GridCell cell) const {
    const Slot& slot = slots_[find_slot(cell)];
    return slot.round == round_ ? &slot.value : nullptr;
  }

 private:
  struct Slot {
    std::uint32_t round = 0;  // slots of earlier rounds count as empty
    std::uint32_t value = 0;
    GridCell cell{};
  };
  [[nodiscard]] std::size_t home(GridCell cell) const {
    // Fibonacci hashing of both halves: neighbouring cells get distant slots.
    const std::uint64_t key = static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.column)) << 32 |
                              static_cast<std::uint32_t>(cell.row);
    return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ULL) >> 32) & (slots_.size() - 1);
  }
  [[nodiscard]] std::size_t find_slot(GridCell cell) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = home(cell);
    while (slots_[at].round == round_ && slots_[at].cell != cell) at = (at + 1) & mask;
    return at;
  }

  std::vector<Slot> slots_;  // open addressing, at most half full
  std::uint32_t round_ = 1;
};

}  // namespace boresight::geometry
