#include "services/ghost_filter/core/reflectors/segment_finder.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ghosts {

namespace {

constexpr int kMaxDepth = 6;

/// Total least squares: the line through the centroid along the principal axis, each cell by the number of its points.
struct Line {
  Eigen::Vector2d centre;
  Eigen::Vector2d direction;
  double residual_m;  // rms distance of the points
};

Line fit_line(std::span<const CellMean> points) {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double total = 0.0;
  for (const CellMean& p : points) {
    centre += p.number_of_points * p.position_m;
    total += p.number_of_points;
  }
  centre /= total;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const CellMean& p : points) {
    const Eigen::Vector2d d = p.position_m - centre;
    xx += p.number_of_points * d.x() * d.x();
    xy += p.number_of_points * d.x() * d.y();
    yy += p.number_of_points * d.y() * d.y();
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  const double across = xx * direction.y() * direction.y() - 2.0 * xy * direction.x() * direction.y() +
                        yy * direction.x() * direction.x();
  return {centre, direction, std::sqrt(std::max(0.0, across) / total)};
}

}  // namespace

SegmentFinder::SegmentFinder(const SegmentConfig& config, std::size_t capacity)
    : config_(config), cell_means_(capacity), dbscan_(capacity), clusters_(capacity) {
  positions_.reserve(capacity);
}

std::span<const Segment> SegmentFinder::find(std::span<const Eigen::Vector2d> points) {
  number_of_segments_ = 0;
  const std::span<const CellMean> means = cell_means_.find(points, config_.cell_m);
  positions_.clear();
  // The neighbourhood is an ellipse: a circle in a plane that is stretched across.
  const double stretch = config_.cluster_length_m / config_.cluster_width_m;
  for (const CellMean& mean : means) positions_.push_back({mean.position_m.x(), stretch * mean.position_m.y()});
  const std::size_t clusters = dbscan_.cluster(positions_, config_.cluster_length_m, config_.cluster_min_points);
  clusters_.sort(means, dbscan_.labels(), clusters);
  for (std::size_t c = 0; c < clusters_.size(); ++c) fit(clusters_[c], 0);
  return {segments_.data(), number_of_segments_};
}

void SegmentFinder::fit(std::span<CellMean> points, int depth) {
  if (points.size() < config_.min_segment_points) return;
  const Line line = fit_line(points);
  const auto along = [&](const CellMean& p) { return line.direction.dot(p.position_m - line.centre); };
  if (line.residual_m > config_.max_segment_residual_m) {
    if (depth == kMaxDepth) return;
    const auto middle = std::partition(points.begin(), points.end(), [&](const auto& p) { return along(p) < 0.0; });
    const auto split = static_cast<std::size_t>(middle - points.begin());
    if (split == 0 || split == points.size()) return;
    fit(points.first(split), depth + 1);
    fit(points.subspan(split), depth + 1);
    return;
  }
  double first = along(points.front()), last = first;
  std::uint32_t detections = 0;
  for (const CellMean& p : points) {
    first = std::min(first, along(p));
    last = std::max(last, along(p));
    detections += p.number_of_points;
  }
  if (last - first < config_.min_segment_length_m) return;
  add({line.centre + first * line.direction, line.centre + last * line.direction, line.residual_m,
       static_cast<std::uint32_t>(points.size()), detections});
}

void SegmentFinder::add(const Segment& segment) {
  if (number_of_segments_ < segments_.size()) {
    segments_[number_of_segments_++] = segment;
    return;
  }
  const auto shortest = std::min_element(segments_.begin(), segments_.end(),
                                         [](const auto& a, const auto& b) { return a.length_m() < b.length_m(); });
  if (shortest->length_m() < segment.length_m()) *shortest = segment;
}

}  // namespace boresight::ghosts
