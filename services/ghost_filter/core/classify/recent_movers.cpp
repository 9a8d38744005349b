#include "services/ghost_filter/core/classify/recent_movers.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ghosts {

namespace {
constexpr double kSame_m = 1.0, kSame_mps = 1.0;
}  // namespace

RecentMovers::RecentMovers() : first_in_cell_(kCapacity), newest_(kCapacity), next_in_cell_(kCapacity, kNone) {
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
  newest_.clear();
  const std::int64_t now_ns = movers_.empty() ? 0 : movers_.back().time_ns;
  std::size_t kept = movers_.size();
  for (std::size_t i = movers_.size(); i-- > 0;) {
    const Mover& m = movers_[i];
    if (m.time_ns < oldest_ns) continue;
    const double elapsed_s = static_cast<double>(now_ns - m.time_ns) * 1e-9;
    const Eigen::Vector2d p = m.position_m + elapsed_s * m.rate_mps * m.direction;
    geometry::GridCell place = geometry::grid_cell(p.x(), p.y(), kSame_m);
    // Range rates of up to 64 m/s apart are told apart.
    const auto rate = static_cast<std::int32_t>(std::lround(std::clamp(m.rate_mps, -500.0, 500.0) / kSame_mps));
    place.row = place.row * 64 + (rate & 63);
    const auto number = static_cast<std::uint32_t>(i);
    if (newest_.at(place, number) == number) movers_[--kept] = m;
  }
  movers_.erase(movers_.begin(), movers_.begin() + static_cast<std::ptrdiff_t>(kept));
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
