#include "services/ghost_filter/core/reflectors/segment.hpp"

#include <algorithm>

namespace boresight::ghosts {

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

Segment segment_of(const Line& line, std::span<const CellMean> points) {
  double first = line.along_m(points.front().position_m), last = first;
  Segment s{.residual_m = line.residual_m, .cells = static_cast<std::uint32_t>(points.size())};
  for (const CellMean& p : points) {
    first = std::min(first, line.along_m(p.position_m));
    last = std::max(last, line.along_m(p.position_m));
    s.detections += p.number_of_points;
  }
  s.start_m = line.centre_m + first * line.direction;
  s.end_m = line.centre_m + last * line.direction;
  return s;
}

}  // namespace boresight::ghosts
