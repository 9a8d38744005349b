#include "services/ghost_filter/core/reflectors/reflector_map.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ghosts {

namespace {

/// Beyond a tile's borders, so that what runs along them is seen whole.
constexpr double kMargin_m = 2.0;
/// Points of a tile and of the margin about it.
constexpr std::size_t kMostPoints = 4 * StationaryTiles::kMostPoints;

/// Calls `visit(place)` for the tile and those around it.
template <typename Visit>
void visit_block(geometry::GridCell middle, const Visit& visit) {
  for (std::int32_t column = middle.column - 1; column <= middle.column + 1; ++column) {
    for (std::int32_t row = middle.row - 1; row <= middle.row + 1; ++row) visit(geometry::GridCell{column, row});
  }
}

/// How far other segments continue one, before its start and after its end.
struct Continuation {
  double before_m = 0.0, after_m = 0.0;
  void add(const Segment& own, const Segment& other, const LineConfig& config) {
    const double own_m = own.length_m();
    const Eigen::Vector2d along = (own.end_m - own.start_m) / own_m, across(-along.y(), along.x());
    const Eigen::Vector2d a = other.start_m - own.start_m, b = other.end_m - own.start_m;
    const double first = std::min(along.dot(a), along.dot(b)), last = std::max(along.dot(a), along.dot(b));
    const Eigen::Vector2d nearer = std::abs(along.dot(a) - 0.5 * own_m) < std::abs(along.dot(b) - 0.5 * own_m) ? a : b;
    if (std::abs(across.dot(nearer)) > 2.0 * config.tolerance_m) return;
    if (std::abs(first - own_m) < config.max_gap_m) after_m = std::max(after_m, last - first);
    if (std::abs(last) < config.max_gap_m) before_m = std::max(before_m, last - first);
  }
};

}  // namespace

ReflectorMap::ReflectorMap(const MapConfig& config)
    : config_(config), lines_(config.lines, kMostPoints), found_(StationaryTiles::kTiles) {
  for (Found& found : found_) found.segments.reserve(config.lines.most_lines);
  reflectors_.reserve(kMaxReflectorSegments);
  points_.reserve(9 * StationaryTiles::kMostPoints);
}

void ReflectorMap::clear() {
  tiles_.clear();
  for (Found& found : found_) found.begin({});
  reflectors_.clear();
  updated_ns_ = 0;
}

void ReflectorMap::add(const Eigen::Vector2d& position_m, double std_m, std::int64_t time_ns) {
  if (std_m <= config_.most_std_m) tiles_.add(position_m, time_ns);
}

double ReflectorMap::with_continuations_m(const Segment& segment, geometry::GridCell place) const {
  Continuation continuation;
  visit_block(place, [&](geometry::GridCell at) {
    const Found& beside = found_[StationaryTiles::number_of(at)];
    if (at == place || !(beside.place == at)) return;
    for (const Segment& other : beside.segments) continuation.add(segment, other, config_.lines);
  });
  return continuation.before_m + segment.length_m() + continuation.after_m;
}

std::size_t ReflectorMap::search(std::size_t number, std::int64_t oldest_ns) {
  const StationaryTiles::Tile& tile = tiles_.tiles()[number];
  Found& found = found_[number];
  found.begin(tile.place);
  found.added = tile.added;
  const Eigen::Vector2d low = tile.low_m(), high = low + Eigen::Vector2d::Constant(StationaryTiles::kTile_m);
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kMargin_m);
  points_.clear();
  visit_block(tile.place, [&](geometry::GridCell at) {
    tiles_.collect(StationaryTiles::number_of(at), oldest_ns, low - margin, high + margin, points_);
  });
  for (const Segment& segment : lines_.find(points_)) {
    const Eigen::Vector2d middle = 0.5 * (segment.start_m + segment.end_m);
    if ((middle.array() < low.array()).any() || (middle.array() >= high.array()).any()) continue;
    found.segments.push_back(segment);
    found.segments.back().continued_m = with_continuations_m(segment, tile.place);
  }
  return points_.size();
}

void ReflectorMap::update(std::int64_t time_ns) {
  const double elapsed_s = std::clamp(static_cast<double>(time_ns - updated_ns_) * 1e-9, 0.0, 1.0);
  updated_ns_ = std::max(updated_ns_, time_ns);
  const std::int64_t oldest_ns = time_ns - static_cast<std::int64_t>(config_.memory_s * 1e9);
  const double share = std::min(1.0, elapsed_s / std::max(1e-3, config_.search_period_s));
  auto turns = static_cast<std::size_t>(std::ceil(share * static_cast<double>(StationaryTiles::kTiles)));
  bool is_changed = false;
  for (std::size_t looks = 0; turns > 0 && looks < config_.most_points; --turns) {
    const std::size_t number = next_++ % StationaryTiles::kTiles;
    const StationaryTiles::Tile& tile = tiles_.tiles()[number];
    Found& found = found_[number];
    if (tile.newest_ns < oldest_ns || !(found.place == tile.place)) {
      is_changed = is_changed || !found.segments.empty();
      found.begin(tile.place);
    }
    if (tile.newest_ns < oldest_ns ||
        tile.added - found.added <
            config_.least_new_share * std::min<double>(tile.added, StationaryTiles::kMostPoints)) {
      continue;
    }
    looks += search(number, oldest_ns);
    is_changed = true;
  }
  if (!is_changed) return;
  reflectors_.clear();
  for (const Found& found : found_) {
    for (const Segment& segment : found.segments) {
      if (reflectors_.size() < reflectors_.capacity()) reflectors_.push_back(segment);
    }
  }
}

void write_segments(std::span<const Segment> segments, const Odometry& odometry, ClassifiedScan& out) {
  const auto in_vehicle = [&odometry](const Eigen::Vector2d& p) -> std::array<float, 2> {
    const Eigen::Vector2f q = odometry.point_to_vehicle(p).cast<float>();
    return {q.x(), q.y()};
  };
  out.number_of_reflector_segments = 0;
  for (const Segment& s : segments.first(std::min(segments.size(), kMaxReflectorSegments))) {
    out.reflector_segments[out.number_of_reflector_segments++] = {in_vehicle(s.start_m), in_vehicle(s.end_m),
                                                                  static_cast<float>(s.residual_m), s.detections};
  }
}

}  // namespace boresight::ghosts
