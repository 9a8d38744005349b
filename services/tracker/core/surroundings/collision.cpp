#include "services/tracker/core/surroundings/collision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

namespace {

constexpr double kLeastClosing_mps = 0.1;  // slower is standing still to one another: keeps the time finite
constexpr double kLeastGap_m = 0.1;        // keeps the deceleration finite
constexpr double kLeastDeviation_m = 1e-3;
constexpr double kLeastTime_s = 0.05;  // keeps the lateral acceleration finite

double normal_below(double deviations) {
  return 0.5 * std::erfc(-deviations / std::numbers::sqrt2);
}

/// Probability that two outlines overlap across the path.
double overlap(const Meeting& m, double offset_m, double std_m, const CollisionParameters& parameters) {
  const double half_m = 0.5 * (parameters.width_m + m.width_m);
  return normal_below((half_m - offset_m) / std_m) - normal_below((-half_m - offset_m) / std_m);
}

}  // namespace

Meeting meeting(const MeetingObject& object, const EgoPath& path, const CollisionParameters& parameters) {
  Meeting m{};
  m.time_s = m.time_std_s = kInfinity;
  PathPlace place = path.place(object.position_m);
  // The time at which the front reaches the nearest face, (W11): the object moves on meanwhile.
  double time_s = 0.0;
  constexpr int kIterations = 4;
  for (int k = 0; k < kIterations; ++k) {
    const double road_rad = path.heading_rad(place.along_m);
    const Eigen::Vector2d along(std::cos(road_rad), std::sin(road_rad));
    const double turned_rad = object.heading_rad - road_rad;
    const double c = std::abs(std::cos(turned_rad)), s = std::abs(std::sin(turned_rad));
    m.length_m = object.length_m * c + object.width_m * s;
    m.width_m = object.length_m * s + object.width_m * c;
    m.closing_mps = path.speed_mps - along.dot(object.velocity_mps);
    const double gap_m = place.along_m - 0.5 * m.length_m - parameters.front_m - path.speed_mps * time_s;
    if (k == 0) {
      m.is_ahead = gap_m > 0.0;  // what is alongside is not met by the front
      m.offset_m = place.aside_m;
      m.deceleration_mps2 =
          m.closing_mps > 0.0 ? 0.5 * m.closing_mps * m.closing_mps / std::max(kLeastGap_m, gap_m) : 0.0;
    }
    if (!m.is_ahead || m.closing_mps < kLeastClosing_mps) return m;
    time_s = std::max(0.0, time_s + gap_m / m.closing_mps);
    if (time_s > parameters.horizon_s) return m;
    place = path.place(object.position_m + time_s * object.velocity_mps);
  }
  // The covariance then: of the object's place, its velocity, and the path, (W12), (W13).
  const double road_rad = path.heading_rad(place.along_m);
  const Eigen::Vector2d along(std::cos(road_rad), std::sin(road_rad)), across(-along.y(), along.x());
  const Eigen::Matrix4d& p = object.covariance;
  const Eigen::Matrix2d cross = p.topRightCorner<2, 2>();
  const Eigen::Matrix2d spread =
      p.topLeftCorner<2, 2>() + time_s * (cross + cross.transpose()) + time_s * time_s * p.bottomRightCorner<2, 2>();
  const double driven_std_m = path.speed_std_mps * time_s;
  m.time_s = time_s;
  m.time_std_s = std::sqrt(along.dot(spread * along) + driven_std_m * driven_std_m) / m.closing_mps;
  m.offset_m = place.aside_m;
  m.place_m = object.position_m + time_s * object.velocity_mps;
  m.object_std_m = std::sqrt(std::max(kLeastDeviation_m * kLeastDeviation_m, across.dot(spread * across)));
  const double path_m2 = path.variance_m2(time_s, parameters.lateral_jerk_density_m2ps5);
  m.offset_std_m = std::sqrt(m.object_std_m * m.object_std_m + path_m2);
  m.probability = overlap(m, m.offset_m, m.offset_std_m, parameters);
  const double aside_m = 0.5 * (parameters.width_m + m.width_m) - std::abs(m.offset_m);
  m.lateral_mps2 = 2.0 * aside_m / std::max(kLeastTime_s * kLeastTime_s, time_s * time_s);
  return m;
}

void follow_road(const RoadCourse& course, const CollisionParameters& parameters, Meeting& m) {
  if (!course.is_known) return;
  const double lane_m2 = parameters.lane_std_m * parameters.lane_std_m;
  const double std_m = std::sqrt(m.object_std_m * m.object_std_m + course.variance_m2 + lane_m2);
  const double on_road = overlap(m, course.aside_m, std_m, parameters);
  m.probability += parameters.road_share * (on_road - m.probability);
}

}  // namespace boresight::tracking
