#include "services/ghost_filter/core/classify/recent_movers.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/messages/header.hpp"

namespace boresight::ghosts {

namespace {
constexpr double kSame_m = 2.0, kSame_mps = 1.0;
constexpr double kAcross_mps = 8.0;  // the part of a mover's velocity that its range rate does not show
}  // namespace

RecentMovers::RecentMovers() : moved_(kCapacity), newest_(kCapacity) {
  movers_.reserve(kCapacity);
}

void RecentMovers::clear() {
  movers_.clear();
  all_.clear();
  weighing_.clear();
  earlier_ = 0;
}

void RecentMovers::enter(std::uint32_t i, const Odometry& odometry) {
  const Mover& m = movers_[i];
  const double elapsed_s = static_cast<double>(odometry.now_ns() - m.time_ns) * 1e-9;
  const Eigen::Vector2d moved_m = m.position_m + elapsed_s * m.rate_mps * m.direction;
  all_.link(moved_m, i);
  if (!weighs(m)) return;
  weighing_.link(m.position_m, i);
  const double across_m = kAcross_mps * elapsed_s;
  moved_[i] = {odometry.point_to_vehicle(moved_m), odometry.vector_to_vehicle(m.direction),
               m.variance_m2 + across_m * across_m};
}

void RecentMovers::forget(std::int64_t oldest_ns, std::int64_t oldest_source_ns, const Odometry& odometry) {
  oldest_source_ns_ = oldest_source_ns;
  newest_.clear();
  const std::int64_t now_ns = movers_.empty() ? 0 : movers_.back().time_ns;
  // The scan to come finds room: where there is too much, the oldest go.
  constexpr std::size_t kMost = kCapacity - kMaxDetections;
  std::size_t kept = movers_.size();
  for (std::size_t i = movers_.size(); i-- > 0 && movers_.size() - kept < kMost;) {
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
  all_.clear();
  weighing_.clear();
  for (std::uint32_t i = 0; i < movers_.size(); ++i) enter(i, odometry);
}

void RecentMovers::add(const Mover& mover, const Odometry& odometry) {
  if (movers_.size() == kCapacity) return;
  movers_.push_back(mover);
  enter(static_cast<std::uint32_t>(movers_.size() - 1), odometry);
}

}  // namespace boresight::ghosts
