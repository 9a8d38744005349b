#include "services/ghost_filter/core/reflector_map/reflector_index.hpp"

namespace boresight::ghosts {

ReflectorIndex::ReflectorIndex() : cells_(kCapacity) {
  entries_.reserve(kCapacity);
}

void ReflectorIndex::clear() {
  cells_.clear();
  entries_.clear();
}

void ReflectorIndex::enter(geometry::GridCell cell, std::uint32_t reflector) {
  if (entries_.size() == kCapacity) return;
  std::uint32_t& first = cells_.at(cell, kNone);
  // A cell's entries of one reflector follow each other.
  if (first != kNone && entries_[first].reflector == reflector) return;
  entries_.push_back({reflector, first});
  first = static_cast<std::uint32_t>(entries_.size() - 1);
}

void ReflectorIndex::build(std::span<const Reflector> reflectors, double beyond_m) {
  clear();
  for (std::uint32_t i = 0; i < reflectors.size(); ++i) add(reflectors[i], i, beyond_m);
}

void ReflectorIndex::add(const Reflector& r, std::uint32_t number, double beyond_m) {
  // A square narrower than a cell lies in the cells of its corners. About steps of kStep_m such squares hold all that
  // is within kBeside_m of the line, however it runs.
  static_assert(2.0 * kHalf_m < kCell_m && kBeside_m * kBeside_m + 0.25 * kStep_m * kStep_m <= kHalf_m * kHalf_m);
  const double begin = r.begin_m() - beyond_m, end = r.end_m() + beyond_m;
  geometry::GridCell low_before{}, high_before{};
  for (double arc = begin; arc < end + kStep_m; arc += kStep_m) {
    const Eigen::Vector2d p = r.curve.at(arc);
    const geometry::GridCell low = geometry::grid_cell(p.x() - kHalf_m, p.y() - kHalf_m, kCell_m);
    const geometry::GridCell high = geometry::grid_cell(p.x() + kHalf_m, p.y() + kHalf_m, kCell_m);
    // Along a road most steps stay in the cells of the one before.
    if (arc > begin && low == low_before && high == high_before) continue;
    low_before = low;
    high_before = high;
    enter(low, number);
    if (high.row != low.row) enter({low.column, high.row}, number);
    if (high.column == low.column) continue;
    enter({high.column, low.row}, number);
    if (high.row != low.row) enter(high, number);
  }
}

}  // namespace boresight::ghosts
