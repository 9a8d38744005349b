#include "services/ghost_filter/core/reflectors/line_search.hpp"

#include <algorithm>

namespace boresight::ghosts {

LineSearch::LineSearch(const LineConfig& config, std::size_t capacity) : config_(config), cell_means_(capacity) {
  cells_.reserve(capacity);
  segments_.reserve(config.most_lines);
}

std::optional<Line> LineSearch::draw(std::span<const CellMean> cells) {
  const auto random = [this, &cells] {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<std::size_t>(state_ % cells.size());
  };
  std::optional<Line> best;
  std::size_t most = config_.min_cells - 1;
  for (std::size_t k = 0; k < config_.draws; ++k) {
    const Eigen::Vector2d a = cells[random()].position_m, chord = cells[random()].position_m - a;
    const double length = chord.norm();
    if (length < 0.5 * config_.min_length_m) continue;
    const Line line{a, chord / length, 0.0};
    std::size_t on = 0;
    for (const CellMean& c : cells) on += line.distance_m(c.position_m) < config_.tolerance_m ? 1U : 0U;
    if (on <= most) continue;
    most = on;
    best = line;
  }
  return best;
}

std::span<CellMean> LineSearch::take_stretch(const Line& line, std::span<CellMean> cells) const {
  const auto on = std::partition(cells.begin(), cells.end(), [&](const CellMean& c) {
    return line.distance_m(c.position_m) >= config_.tolerance_m;
  });
  std::sort(on, cells.end(), [&](const CellMean& a, const CellMean& b) {
    return line.along_m(a.position_m) < line.along_m(b.position_m);
  });
  auto best_begin = on, best_end = on, begin = on;
  for (auto at = on; at != cells.end(); ++at) {
    if (at != on && line.along_m(at->position_m) - line.along_m((at - 1)->position_m) > config_.max_gap_m) begin = at;
    const auto length = [&](auto first, auto last) {
      return first == last ? -1.0 : line.along_m((last - 1)->position_m) - line.along_m(first->position_m);
    };
    if (length(begin, at + 1) > length(best_begin, best_end)) best_begin = begin, best_end = at + 1;
  }
  std::rotate(best_begin, best_end, cells.end());
  return cells.last(static_cast<std::size_t>(best_end - best_begin));
}

std::optional<Segment> LineSearch::find_one(std::span<CellMean> cells) {
  constexpr int kRounds = 3;  // of fitting and choosing the cells anew
  if (cells.size() < config_.min_cells) return std::nullopt;
  std::optional<Line> line = draw(cells);
  if (!line) return std::nullopt;
  std::span<CellMean> taken;
  for (int round = 0; round < kRounds; ++round) {
    taken = take_stretch(*line, cells);
    if (taken.size() < config_.min_cells) return std::nullopt;
    line = fit_line(taken);
  }
  const Segment segment = segment_of(*line, taken);
  if (segment.length_m() < config_.min_length_m) return std::nullopt;
  // Bushes have lines through them as well, but most of their cells lie off these lines.
  const double first = line->along_m(segment.start_m), last = line->along_m(segment.end_m);
  const auto beside = std::count_if(cells.begin(), cells.end(), [&](const CellMean& c) {
    const double along = line->along_m(c.position_m);
    return along >= first && along <= last && line->distance_m(c.position_m) < config_.beside_m;
  });
  if (static_cast<double>(taken.size()) < config_.min_purity * static_cast<double>(beside)) return std::nullopt;
  return segment;
}

std::span<const Segment> LineSearch::find(std::span<const Eigen::Vector2d> points) {
  segments_.clear();
  const std::span<const CellMean> means = cell_means_.find(points, config_.cell_m);
  cells_.assign(means.begin(), means.end());
  std::span<CellMean> rest = cells_;
  while (segments_.size() < config_.most_lines) {
    const std::optional<Segment> segment = find_one(rest);
    if (!segment) break;
    segments_.push_back(*segment);
    rest = rest.first(rest.size() - segment->cells);
  }
  return segments_;
}

}  // namespace boresight::ghosts
