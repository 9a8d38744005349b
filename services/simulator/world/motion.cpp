#include "services/simulator/world/motion.hpp"

#include <algorithm>

#include "services/simulator/world/knots.hpp"

namespace boresight::simulator {

namespace {

struct Progress {
  double travelled_m, speed_mps, acceleration_mps2;
};

/// Progress along the path of an EgoSpec or a BodySpec.
template <typename Mover>
Progress progress(const Mover& mover, double t_s) {
  const Smooth v = smooth(mover.speed_mps, t_s);
  const double w = 2.0 * M_PI / mover.swing_period_s;
  return {integral(mover.speed_mps, t_s) + mover.swing_mps / w * (1.0 - std::cos(w * t_s)),
          v.value + mover.swing_mps * std::sin(w * t_s), v.slope + mover.swing_mps * w * std::cos(w * t_s)};
}

bool is_oncoming(const Knots& speed) {
  double low = 0.0, high = 0.0;
  for (const Knot& k : speed) {
    low = std::min(low, k.value);
    high = std::max(high, k.value);
  }
  return -low > high;
}

}  // namespace

Motion along_road(const Road& road, double arc_m, double arc_speed_mps, double arc_acceleration_mps2,
                  const Knots& lateral_m, bool against) {
  const RoadPoint p = road.at(arc_m);
  const Smooth l = smooth(lateral_m, arc_m);
  // The path's derivative by the road's arc: `g` along the road, l.slope across it. A parallel curve to the left of a
  // left-hand bend is shorter.
  const double g = 1.0 - p.curvature_per_m * l.value;
  const double g_slope = -p.curvature_slope_per_m2 * l.value - p.curvature_per_m * l.slope;
  // At the centre of the bend the path has no direction; the limit keeps all values finite.
  const double h = std::max(1e-6, std::hypot(g, l.slope));
  const double h_slope = (g * g_slope + l.slope * l.curvature) / h;
  const double turn = p.curvature_per_m + (l.curvature * g - l.slope * g_slope) / (h * h);
  const double sign = against ? -1.0 : 1.0;
  Motion m{};
  m.arc_m = arc_m;
  m.lateral_m = l.value;
  m.arc_speed_mps = arc_speed_mps;
  m.position_m = p.position_m + l.value * Eigen::Vector2d(-std::sin(p.heading_rad), std::cos(p.heading_rad));
  m.heading_rad = p.heading_rad + std::atan2(l.slope, g) + (against ? M_PI : 0.0);
  m.speed_mps = sign * arc_speed_mps * h;
  m.acceleration_mps2 = sign * (arc_acceleration_mps2 * h + arc_speed_mps * arc_speed_mps * h_slope);
  m.yaw_rate_radps = arc_speed_mps * turn;
  return m;
}

Motion ego_motion(const EgoSpec& ego, const Road& road, double t_s) {
  const Progress p = progress(ego, t_s);
  Motion m = along_road(road, ego.start_m + p.travelled_m, p.speed_mps, p.acceleration_mps2, ego.lateral_m, false);
  m.travelled_m = p.travelled_m;
  return m;
}

Motion body_motion(const BodySpec& body, const Road& road, double t_s) {
  const Progress p = progress(body, t_s);
  const bool against = is_oncoming(body.speed_mps);
  Motion m{};
  if (body.heading_rad == 0.0) {
    m = along_road(road, body.start_m + p.travelled_m, p.speed_mps, p.acceleration_mps2, body.lateral_m, against);
  } else {
    const double heading = road.at(body.start_m).heading_rad + body.heading_rad;
    const double lateral_m = smooth(body.lateral_m, body.start_m).value;
    m.arc_m = body.start_m;
    m.lateral_m = lateral_m + p.travelled_m * std::sin(body.heading_rad);
    m.position_m =
        road.place(body.start_m, lateral_m) + p.travelled_m * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    m.heading_rad = heading + (against ? M_PI : 0.0);
    m.speed_mps = against ? -p.speed_mps : p.speed_mps;
    m.acceleration_mps2 = against ? -p.acceleration_mps2 : p.acceleration_mps2;
  }
  m.travelled_m = against ? -p.travelled_m : p.travelled_m;
  return m;
}

Gap ego_extent(const EgoSpec& ego, double duration_s) {
  Gap extent{ego.start_m, ego.start_m};
  constexpr double kStep_s = 0.1;
  for (double t = 0.0; t < duration_s + kStep_s; t += kStep_s) {
    const double arc = ego.start_m + progress(ego, t).travelled_m;
    extent = {std::min(extent.from_m, arc), std::max(extent.to_m, arc)};
  }
  return extent;
}

}  // namespace boresight::simulator
