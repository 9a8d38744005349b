#include "tests/simulator/road.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::simulator {

namespace {

constexpr double kStep_m = 0.25;
constexpr double kSwingPeriod_s = 37.0;

double curvature_at(double arc_m, double scale) {
  return scale * (0.006 * std::sin(arc_m / 80.0) + 0.003 * std::sin(arc_m / 29.0));
}

}  // namespace

Road::Road(double begin_m, double end_m, double curvature) : begin_m_(begin_m) {
  const auto count = static_cast<std::size_t>((end_m - begin_m) / kStep_m) + 2;
  points_.reserve(count);
  RoadPoint point{{0.0, 0.0}, 0.0, curvature_at(begin_m, curvature)};
  for (std::size_t i = 0; i < count; ++i) {
    const double arc = begin_m + static_cast<double>(i) * kStep_m;
    point.curvature_per_m = curvature_at(arc, curvature);
    points_.push_back(point);
    const double middle = point.heading_rad + 0.5 * kStep_m * point.curvature_per_m;
    point.position_m += kStep_m * Eigen::Vector2d(std::cos(middle), std::sin(middle));
    point.heading_rad += kStep_m * curvature_at(arc + 0.5 * kStep_m, curvature);
  }
}

RoadPoint Road::at(double arc_m) const {
  const double position = (arc_m - begin_m_) / kStep_m;
  const auto last = static_cast<double>(points_.size() - 2);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(position), 0.0, last));
  const double w = position - static_cast<double>(i);
  const RoadPoint& a = points_[i];
  const RoadPoint& b = points_[i + 1];
  return {a.position_m + w * (b.position_m - a.position_m), a.heading_rad + w * (b.heading_rad - a.heading_rad),
          a.curvature_per_m + w * (b.curvature_per_m - a.curvature_per_m)};
}

Eigen::Vector2d Road::place(double arc_m, double lateral_m) const {
  const RoadPoint p = at(arc_m);
  return p.position_m + lateral_m * Eigen::Vector2d(-std::sin(p.heading_rad), std::cos(p.heading_rad));
}

double ego_arc_m(const Scenario& s, double t_s) {
  const double w = 2.0 * M_PI / kSwingPeriod_s;
  return s.mean_speed_mps * t_s + s.speed_swing_mps / w * (1.0 - std::cos(w * t_s));
}

double ego_speed_mps(const Scenario& s, double t_s) {
  return s.mean_speed_mps + s.speed_swing_mps * std::sin(2.0 * M_PI / kSwingPeriod_s * t_s);
}

EgoState ego_state(const Scenario& scenario, const Road& road, double t_s) {
  const double arc = ego_arc_m(scenario, t_s);
  const RoadPoint p = road.at(arc);
  const double speed = ego_speed_mps(scenario, t_s);
  return {arc, p.position_m, p.heading_rad, speed, speed * p.curvature_per_m};
}

}  // namespace boresight::simulator
