#include "services/ghost_filter/core/classify/recent_movers.hpp"

namespace boresight::ghosts {

RecentMovers::RecentMovers() : first_in_cell_(kCapacity), next_in_cell_(kCapacity, kNone) {
  movers_.reserve(kCapacity);
}

void RecentMovers::clear() {
  movers_.clear();
  first_in_cell_.clear();
  earlier_ = 0;
}

void RecentMovers::link(std::uint32_t i) {
  const Eigen::Vector2d& p = movers_[i].position_m;
  std::uint32_t& first = first_in_cell_.at(geometry::grid_cell(p.x(), p.y(), kCell_m), kNone);
  next_in_cell_[i] = first;
  first = i;
}

void RecentMovers::forget(std::int64_t oldest_ns) {
  std::erase_if(movers_, [oldest_ns](const Mover& m) { return m.time_ns < oldest_ns || m.weight < kLeastWeight; });
  earlier_ = movers_.size();
  first_in_cell_.clear();
  for (std::uint32_t i = 0; i < movers_.size(); ++i) link(i);
}

void RecentMovers::add(const Mover& mover) {
  if (movers_.size() == kCapacity) return;
  movers_.push_back(mover);
  link(static_cast<std::uint32_t>(movers_.size() - 1));
}

}  // namespace boresight::ghosts
