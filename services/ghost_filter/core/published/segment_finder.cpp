#include "services/ghost_filter/core/published/segment_finder.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ghosts::published {

namespace {

constexpr int kMaxDepth = 6;

}  // namespace

SegmentFinder::SegmentFinder(const Config& config, std::size_t capacity)
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
  if (line.residual_m > config_.max_segment_residual_m) {
    if (depth == kMaxDepth) return;
    const auto middle = std::partition(points.begin(), points.end(),
                                       [&](const CellMean& p) { return line.along_m(p.position_m) < 0.0; });
    const auto split = static_cast<std::size_t>(middle - points.begin());
    if (split == 0 || split == points.size()) return;
    fit(points.first(split), depth + 1);
    fit(points.subspan(split), depth + 1);
    return;
  }
  const Segment segment = segment_of(line, points);
  if (segment.length_m() >= config_.min_segment_length_m) add(segment);
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

}  // namespace boresight::ghosts::published
