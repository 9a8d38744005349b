// Which reflectors run past a place: a coarse grid in which they are entered.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/cell_table.hpp"
#include "services/ghost_filter/core/reflector_map/reflector.hpp"

namespace boresight::ghosts {

class ReflectorIndex {
 public:
  /// What is within this of a curve finds it.
  static constexpr double kBeside_m = 1.5;
  ReflectorIndex();
  /// Enters all, and as far beyond their ends as `beyond_m`. What finds no room any more is not entered.
  void build(std::span<const Reflector> reflectors, double beyond_m);
  /// Enters one more.
  void add(const Reflector& reflector, std::uint32_t number, double beyond_m);
  void clear();
  /// Calls `visit(number)` for each reflector that runs past the place, and for some that run a few metres away.
  template <typename Visit>
  void visit(const Eigen::Vector2d& position_m, const Visit& visit) const {
    const std::uint32_t* const first = cells_.find(geometry::grid_cell(position_m.x(), position_m.y(), kCell_m));
    for (std::uint32_t i = first == nullptr ? kNone : *first; i != kNone; i = entries_[i].next) {
      visit(entries_[i].reflector);
    }
  }

 private:
  static constexpr double kCell_m = 4.0;
  static constexpr double kStep_m = 2.0;
  static constexpr double kHalf_m = 1.9;
  static constexpr std::size_t kCapacity = 8192;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Entry {
    std::uint32_t reflector, next;
  };
  void enter(geometry::GridCell cell, std::uint32_t reflector);
  geometry::CellTable cells_;
  std::vector<Entry> entries_;
};

}  // namespace boresight::ghosts
