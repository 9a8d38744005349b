#include "services/simulator/road.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::simulator {

namespace {

constexpr double kStep_m = 0.25;

/// The point `along_m` further, by the midpoint rule: the error is of third order in the step.
RoadPoint advance(const RoadPoint& p, double along_m) {
  const double middle = p.heading_rad + 0.5 * along_m * (p.curvature_per_m + 0.25 * along_m * p.curvature_slope_per_m2);
  RoadPoint q = p;
  q.position_m += along_m * Eigen::Vector2d(std::cos(middle), std::sin(middle));
  q.heading_rad += along_m * (p.curvature_per_m + 0.5 * along_m * p.curvature_slope_per_m2);
  q.curvature_per_m += along_m * p.curvature_slope_per_m2;
  return q;
}

}  // namespace

double curvature_at(const RoadSpec& spec, double arc_m) {
  double curvature = 0.0;
  for (const RoadWave& wave : spec.waves) curvature += wave.curvature_per_m * std::sin(arc_m / wave.length_m);
  // Each border of segments adds its change of curvature, spread over its clothoid.
  double border_m = 0.0;
  for (std::size_t i = 0; i < spec.segments.size(); ++i) {
    const RoadSegment& segment = spec.segments[i];
    const double before = i == 0 ? 0.0 : spec.segments[i - 1].curvature_per_m;
    const double shortest = i == 0 ? segment.length_m : std::min(segment.length_m, spec.segments[i - 1].length_m);
    const double width = std::max(1e-3, std::min(spec.transition_m, shortest));
    const double share = std::clamp((arc_m - border_m) / width + 0.5, 0.0, 1.0);
    curvature += (segment.curvature_per_m - before) * share;
    border_m += segment.length_m;
  }
  return curvature;
}

Road::Road(const RoadSpec& spec, double begin_m, double end_m) {
  const auto before = static_cast<std::size_t>(std::ceil(std::max(0.0, -begin_m) / kStep_m));
  const auto after = static_cast<std::size_t>(std::ceil(std::max(0.0, end_m) / kStep_m)) + 1;
  begin_m_ = -static_cast<double>(before) * kStep_m;
  points_.resize(before + after + 1);
  const auto arc = [&](std::size_t i) { return begin_m_ + static_cast<double>(i) * kStep_m; };
  for (std::size_t i = 0; i < points_.size(); ++i) points_[i].curvature_per_m = curvature_at(spec, arc(i));
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double next = i + 1 < points_.size() ? points_[i + 1].curvature_per_m : points_[i].curvature_per_m;
    points_[i].curvature_slope_per_m2 = (next - points_[i].curvature_per_m) / kStep_m;
  }
  const auto link = [&](const RoadPoint& from, RoadPoint& to) {
    to.position_m = from.position_m;
    to.heading_rad = from.heading_rad;
  };
  points_[before].position_m.setZero();
  points_[before].heading_rad = 0.0;
  for (std::size_t i = before; i + 1 < points_.size(); ++i) link(advance(points_[i], kStep_m), points_[i + 1]);
  for (std::size_t i = before; i > 0; --i) {
    // Backwards by the step that leads from i − 1 to i.
    RoadPoint& p = points_[i - 1];
    p.position_m.setZero();
    p.heading_rad = 0.0;
    p.heading_rad = points_[i].heading_rad - advance(p, kStep_m).heading_rad;
    p.position_m = points_[i].position_m - advance(p, kStep_m).position_m;
  }
}

RoadPoint Road::at(double arc_m) const {
  const double position = (arc_m - begin_m_) / kStep_m;
  const auto last = static_cast<double>(points_.size() - 1);
  const double i = std::clamp(std::floor(position), 0.0, last);
  const double beyond_m = (position - i) * kStep_m;
  RoadPoint from = points_[static_cast<std::size_t>(i)];
  if (beyond_m < 0.0) from.curvature_slope_per_m2 = 0.0;
  return advance(from, beyond_m);
}

Eigen::Vector2d Road::place(double arc_m, double lateral_m) const {
  const RoadPoint p = at(arc_m);
  return p.position_m + lateral_m * Eigen::Vector2d(-std::sin(p.heading_rad), std::cos(p.heading_rad));
}

}  // namespace boresight::simulator
