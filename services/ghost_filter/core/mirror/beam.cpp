#include "services/ghost_filter/core/mirror/beam.hpp"

#include <cmath>

#include "services/ghost_filter/core/mirror/meeting.hpp"
#include "services/ghost_filter/core/mirror/mirror.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kNear_m = 1.0;          // of a mirror: rays to it graze, and their ends do not tell where others go
constexpr double kMostTurned_rad = 1.0;  // from end to end: beyond it the same holds
constexpr double kSlack_m = 0.5;

}  // namespace

Beam::Beam(const Mirror& mirror, const Eigen::Vector2d& sensor_m) {
  const Curve& curve = mirror.curve;
  const double beyond_m = most_unseen_m(mirror);
  const double low = mirror.begin_m - beyond_m, high = mirror.end_m + beyond_m;
  const double bend = std::abs(curve.curvature_per_m), half = 0.5 * (high - low);
  if (!(2.0 * bend * half < kMostTurned_rad) || !(std::abs(curve.distance(sensor_m)) > kNear_m)) return;
  struct End {
    Eigen::Vector2d point, tangent, out;
    double side_m;  // of its tangent, on which the sensor is
  };
  const auto end_at = [&](double arc_m) {
    const Eigen::Vector2d point = curve.at(arc_m), tangent = curve.tangent_at(arc_m), out = point - sensor_m;
    return End{point, tangent, out, tangent.y() * out.x() - tangent.x() * out.y()};
  };
  const End begin = end_at(low), end = end_at(high);
  // One end is seen from in front, the other from behind.
  if (begin.side_m * end.side_m <= 0.0) return;
  const auto ray_of = [](const End& e) {
    const Eigen::Vector2d out = e.out.normalized();
    const Eigen::Vector2d on = 2.0 * out.dot(e.tangent) * e.tangent - out;
    return Ray{-on.y(), on.x(), on.y() * e.point.x() - on.x() * e.point.y()};
  };
  begin_ = ray_of(begin);
  end_ = ray_of(end);
  begin_from_sensor_m_ = begin_.left(sensor_m);
  end_from_sensor_m_ = end_.left(sensor_m);
  // Where a bent mirror gathers them, some of the rays between pass beside those from the ends: as a sphere's.
  slack_m_ = kSlack_m + bend * bend * half * half * half;
}

}  // namespace boresight::ghosts
