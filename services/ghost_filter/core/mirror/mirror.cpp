#include "services/ghost_filter/core/mirror/mirror.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kLeastSine = 0.02;  // a ray that grazes at less than a degree is not followed

double goes_on(const Mirror& mirror, double arc_m) {
  constexpr double kAtTheEnd = 0.2, kHidden = 0.5;
  const double beyond_m = std::max(mirror.begin_m - arc_m, arc_m - mirror.end_m);
  if (beyond_m <= 0.0 || beyond_m >= kGoesOn_m || !is_long(mirror)) return 0.0;
  if (mirror.occupancy->is_driven(arc_m + mirror.arc_shift_m)) return 0.0;
  const double hidden_m = arc_m < mirror.begin_m ? mirror.hidden_before_m : mirror.hidden_after_m;
  return std::max(beyond_m <= hidden_m ? kHidden : 0.0, kAtTheEnd * (1.0 - beyond_m / kGoesOn_m));
}

}  // namespace

double most_beyond_m(const Mirror& mirror) {
  return is_long(mirror) || mirror.occupancy == nullptr ? kGoesOn_m : mirror.occupancy->most_blur_m();
}

double chance_at(const Mirror& mirror, double arc_m, double arc_std_m) {
  if (mirror.occupancy != nullptr) {
    const double seen = mirror.occupancy->probability(arc_m + mirror.arc_shift_m, arc_std_m);
    return mirror.existence * std::max(seen, goes_on(mirror, arc_m));
  }
  constexpr double kEnd_m = 0.6;  // as well as a track's ends are known
  const double slack = arc_std_m + kEnd_m;
  const double between = below((arc_m - mirror.begin_m) / slack) - below((arc_m - mirror.end_m) / slack);
  return mirror.existence * std::max(0.0, between);
}

double offset_variance_at(const Mirror& mirror, double arc_m) {
  const Eigen::Vector3d row(1.0, arc_m, 0.5 * arc_m * arc_m);
  return std::max(0.0, row.dot(mirror.covariance * row));
}

std::optional<Turn> turn_at(const Mirror& mirror, const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& direction,
                            double farthest_m, double azimuth_std_rad) {
  const double beyond_m = most_beyond_m(mirror);
  for (const double distance : mirror.curve.crossings(sensor_m, direction)) {
    if (distance < 0.2 || distance > farthest_m) continue;
    const Eigen::Vector2d point = sensor_m + distance * direction;
    const double arc = mirror.curve.arc(point);
    // The other half of a circle has the same crossings.
    if (arc < mirror.begin_m - beyond_m || arc > mirror.end_m + beyond_m) continue;
    const Eigen::Vector2d tangent = mirror.curve.tangent_at(arc);
    Eigen::Vector2d normal(-tangent.y(), tangent.x());
    double sine = -direction.dot(normal);
    if (sine < 0.0) {
      normal = -normal;
      sine = -sine;
    }
    if (sine < kLeastSine) continue;
    const double arc_std = distance * azimuth_std_rad / sine;
    const double probability = chance_at(mirror, arc, arc_std);
    if (probability < 0.01) continue;
    const double angle_variance =
        mirror.covariance(1, 1) + arc * (2.0 * mirror.covariance(1, 2) + arc * mirror.covariance(2, 2));
    return Turn{distance,
                point,
                direction + 2.0 * sine * normal,
                normal,
                probability,
                std::sqrt(offset_variance_at(mirror, arc)),
                std::sqrt(std::max(0.0, angle_variance)),
                std::abs(mirror.curve.curvature_per_m) / sine};
  }
  return std::nullopt;
}

double rest_of_three_bounces(const Turn& turn, double range_m) {
  return range_m - turn.distance_m;
}

double rest_of_two_bounces(const Turn& turn, const Eigen::Vector2d& sensor_m, double range_m) {
  // |W + s·d − S| = L − s with L = 2r − |W−S|.
  const double length = 2.0 * range_m - turn.distance_m;
  const Eigen::Vector2d back = turn.point_m - sensor_m;
  const double denominator = 2.0 * (length + back.dot(turn.direction));
  return denominator < 1e-6 ? -1.0 : (length * length - back.squaredNorm()) / denominator;
}

}  // namespace boresight::ghosts
