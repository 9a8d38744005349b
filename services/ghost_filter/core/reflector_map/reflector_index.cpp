#include "services/ghost_filter/core/reflector_map/reflector_index.hpp"

namespace boresight::ghosts {

ReflectorIndex::ReflectorIndex() : cells_(kCapacity) {
  entries_.reserve(kCapacity);
}

void ReflectorIndex::clear() {
  cells_.clear();
  entries_.clear();
}

void ReflectorIndex::enter(const Eigen::Vector2d& position_m, std::uint32_t reflector) {
  if (entries_.size() == kCapacity) return;
  std::uint32_t& first = cells_.at(geometry::grid_cell(position_m.x(), position_m.y(), kCell_m), kNone);
  // A cell's entries of one reflector follow each other.
  if (first != kNone && entries_[first].reflector == reflector) return;
  entries_.push_back({reflector, first});
  first = static_cast<std::uint32_t>(entries_.size() - 1);
}

void ReflectorIndex::build(std::span<const Reflector> reflectors, double beyond_m) {
  clear();
  // A square narrower than a cell lies in the cells of its corners. About steps of kStep_m such squares hold all that
  // is within kBeside_m of the line, however it runs.
  static_assert(2.0 * kHalf_m < kCell_m && kBeside_m * kBeside_m + 0.25 * kStep_m * kStep_m <= kHalf_m * kHalf_m);
  for (std::uint32_t i = 0; i < reflectors.size(); ++i) {
    const Reflector& r = reflectors[i];
    const double end = r.end_m() + beyond_m;
    for (double arc = r.begin_m() - beyond_m; arc < end + kStep_m; arc += kStep_m) {
      const Eigen::Vector2d p = r.curve.at(arc);
      for (const double x : {-kHalf_m, kHalf_m}) {
        for (const double y : {-kHalf_m, kHalf_m}) enter(p + Eigen::Vector2d(x, y), i);
      }
    }
  }
}

}  // namespace boresight::ghosts
