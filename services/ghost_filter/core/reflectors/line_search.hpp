// Straight reflectors among points: RANSAC (Fischler and Bolles 1981) with seeded draws, so that equal input gives
// equal output.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/reflectors/cell_means.hpp"
#include "services/ghost_filter/core/reflectors/config.hpp"
#include "services/ghost_filter/core/reflectors/segment.hpp"

namespace boresight::ghosts {

class LineSearch {
 public:
  /// For at most `capacity` points; those beyond are ignored.
  LineSearch(const LineConfig& config, std::size_t capacity);

  /// The segments on which most points lie, one after another, each without the points of those before.
  [[nodiscard]] std::span<const Segment> find(std::span<const Eigen::Vector2d> points);

 private:
  /// Moves the cells of the segment to the end of `cells`.
  [[nodiscard]] std::optional<Segment> find_one(std::span<CellMean> cells);
  [[nodiscard]] std::optional<Line> draw(std::span<const CellMean> cells);
  /// Moves the cells on the longest stretch of the line without a gap to the end; returns them.
  [[nodiscard]] std::span<CellMean> take_stretch(const Line& line, std::span<CellMean> cells) const;
  LineConfig config_;
  CellMeans cell_means_;
  std::vector<CellMean> cells_;
  std::vector<Segment> segments_;
  std::uint64_t state_ = 0x9E3779B97F4A7C15ULL;
};

}  // namespace boresight::ghosts
