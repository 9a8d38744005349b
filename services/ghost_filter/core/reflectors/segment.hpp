// A straight reflector, and the line through its points.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "services/ghost_filter/core/reflectors/cell_means.hpp"

namespace boresight::ghosts {

struct Segment {
  Eigen::Vector2d start_m{0.0, 0.0}, end_m{0.0, 0.0};
  double residual_m = 0.0;       ///< rms distance of the points
  std::uint32_t cells = 0;       ///< cells of the grid with points, and
  std::uint32_t detections = 0;  ///< the points
  double continued_m = 0.0;      ///< length with the segments that continue it; set by ReflectorMap

  [[nodiscard]] double length_m() const { return (end_m - start_m).norm(); }
};

struct Line {
  Eigen::Vector2d centre_m{0.0, 0.0};
  Eigen::Vector2d direction{1.0, 0.0};  ///< unit
  double residual_m = 0.0;              ///< rms distance of the points

  [[nodiscard]] double along_m(const Eigen::Vector2d& p) const { return direction.dot(p - centre_m); }
  [[nodiscard]] double distance_m(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d d = p - centre_m;
    return std::abs(direction.x() * d.y() - direction.y() * d.x());
  }
};

/// Total least squares: the line through the centroid along the principal axis, each cell by the number of its points.
[[nodiscard]] Line fit_line(std::span<const CellMean> points);
/// The stretch of a line on which the points lie.
[[nodiscard]] Segment segment_of(const Line& line, std::span<const CellMean> points);

}  // namespace boresight::ghosts
