#include "services/ghost_filter/core/mirror/mirror.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kBeyondDetour_m = 5.0;  // as far a mirror on a detour may go on unseen
constexpr double kLeastSine = 0.02;      // a ray that grazes at less than a degree is not followed

/// A rail or a wall may go on where vehicles hide it, or where it was not looked for yet.
double goes_on(const Mirror& mirror, double arc_m) {
  constexpr double kLong_m = 20.0, kAtTheEnd = 0.2;
  const double beyond_m = std::max(mirror.begin_m - arc_m, arc_m - mirror.end_m);
  if (beyond_m <= 0.0 || beyond_m >= kMirrorGoesOn_m || mirror.end_m - mirror.begin_m < kLong_m) return 0.0;
  return kAtTheEnd * (1.0 - beyond_m / kMirrorGoesOn_m);
}

double there(const Mirror& mirror, double arc_m, double arc_std_m) {
  if (mirror.occupancy != nullptr) {
    const double seen = mirror.occupancy->probability(arc_m + mirror.arc_shift_m, arc_std_m);
    return mirror.existence * std::max(seen, goes_on(mirror, arc_m));
  }
  const double slack = arc_std_m + 0.3;
  const double between = below((arc_m - mirror.begin_m) / slack) - below((arc_m - mirror.end_m) / slack);
  return mirror.existence * std::max(0.0, between);
}

/// Over ways of this length it turns so little that where a wave turns need not be sought: by Fermat's principle an
/// error of that changes no length.
bool is_as_good_as_straight(const Mirror& mirror, double length_m) {
  return std::abs(mirror.curve.curvature_per_m) * length_m < 0.03;
}

double variance_at(const Mirror& mirror, double arc_m) {
  const Eigen::Vector3d row(1.0, arc_m, 0.5 * arc_m * arc_m);
  return std::max(0.0, row.dot(mirror.covariance * row));
}

}  // namespace

std::optional<Turn> turn_at(const Mirror& mirror, const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& direction,
                            double farthest_m, double azimuth_std_rad) {
  for (const double distance : mirror.curve.crossings(sensor_m, direction)) {
    if (distance < 0.2 || distance > farthest_m) continue;
    const Eigen::Vector2d point = sensor_m + distance * direction;
    const double arc = mirror.curve.arc(point);
    // The other half of a circle has the same crossings.
    if (arc < mirror.begin_m - kMirrorGoesOn_m || arc > mirror.end_m + kMirrorGoesOn_m) continue;
    const Eigen::Vector2d tangent = mirror.curve.tangent_at(arc);
    Eigen::Vector2d normal(-tangent.y(), tangent.x());
    double sine = -direction.dot(normal);
    if (sine < 0.0) {
      normal = -normal;
      sine = -sine;
    }
    if (sine < kLeastSine) continue;
    const double arc_std = distance * azimuth_std_rad / sine;
    const double probability = there(mirror, arc, arc_std);
    if (probability < 0.01) continue;
    const double angle_variance =
        mirror.covariance(1, 1) + arc * (2.0 * mirror.covariance(1, 2) + arc * mirror.covariance(2, 2));
    return Turn{distance,
                point,
                direction + 2.0 * sine * normal,
                normal,
                probability,
                std::sqrt(variance_at(mirror, arc)),
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

std::optional<Detour> detour_to(const Mirror& mirror, const Eigen::Vector2d& sensor_m,
                                const Eigen::Vector2d& target_m) {
  const double sensor_side = mirror.curve.distance(sensor_m);
  const double target_side = mirror.curve.distance(target_m);
  if (sensor_side * target_side <= 0.0) return std::nullopt;
  // On a straight mirror W divides the way in the ratio of the distances; on a bent one that is where one begins.
  double arc = mirror.curve.arc(sensor_m);
  const double across = std::abs(mirror.curve.arc(target_m) - arc);
  arc += (mirror.curve.arc(target_m) - arc) * sensor_side / (sensor_side + target_side);
  // Most mirrors are passed by far: no need to know by how much.
  const double slack = 2.0 * kBeyondDetour_m + 0.3 * std::abs(mirror.curve.curvature_per_m) * arc * arc;
  if (arc < mirror.begin_m - slack || arc > mirror.end_m + slack) return std::nullopt;
  Eigen::Vector2d point, tangent;
  for (int round = 0;; ++round) {
    point = mirror.curve.at(arc);
    tangent = mirror.curve.tangent_at(arc);
    if (round == 2 || is_as_good_as_straight(mirror, std::abs(sensor_side) + std::abs(target_side) + across)) break;
    const Eigen::Vector2d a = sensor_m - point, b = target_m - point;
    const double step = tangent.dot(a) * std::abs(target_side) + tangent.dot(b) * std::abs(sensor_side);
    arc += step / (std::abs(sensor_side) + std::abs(target_side));
  }
  if (arc < mirror.begin_m - kBeyondDetour_m || arc > mirror.end_m + kBeyondDetour_m) return std::nullopt;
  const Eigen::Vector2d out = point - sensor_m, on = target_m - point;
  const double first = out.norm(), second = on.norm();
  if (first < 0.2 || second < 0.2) return std::nullopt;
  const double probability = there(mirror, arc, 0.5);
  if (probability < 0.01) return std::nullopt;
  const Eigen::Vector2d u = out / first, d = on / second;
  const double sine = std::abs(u.x() * tangent.y() - u.y() * tangent.x());
  return Detour{first + second,
                point,
                {-tangent.y(), tangent.x()},
                u,
                d,
                probability,
                2.0 * sine * std::sqrt(variance_at(mirror, arc))};
}

std::optional<Approach> approach(const Mirror& mirror, const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& from_m,
                                 const Eigen::Vector2d& direction, double length_m) {
  constexpr double kMostBent_rad = 0.2;    // from the origin to where the wave turns
  constexpr double kMostMetresPerM = 5.0;  // else what is found hangs on little
  // The way out and the way on to the ray's begin are no shorter than to the nearest point of the mirror and from
  // there.
  const double size = std::max(-mirror.begin_m, mirror.end_m) + 15.0;
  const double reach = 0.5 * (length_m + (from_m - sensor_m).norm()) + size;
  if ((mirror.curve.origin_m - sensor_m).squaredNorm() > reach * reach) return std::nullopt;
  const Eigen::Vector2d& tangent = mirror.curve.tangent;
  const Eigen::Vector2d sensor = mirror.curve.local(sensor_m), from = mirror.curve.local(from_m);
  const Eigen::Vector2d along(direction.dot(tangent), tangent.x() * direction.y() - tangent.y() * direction.x());
  const Eigen::Vector2d back(from.x() - sensor.x(), from.y() + sensor.y());  // from the sensor's image
  Approach way{0.0, 0.0, 0.0, std::numeric_limits<double>::infinity()};
  const double denominator = 2.0 * (length_m + back.dot(along));
  if (denominator < 1e-6) return way;
  way.rest_m = (length_m * length_m - back.squaredNorm()) / denominator;
  const Eigen::Vector2d target = from + way.rest_m * along;
  const double bend = std::abs(mirror.curve.curvature_per_m);
  const double sag = 1.0 + bend * (sensor.x() * sensor.x() + target.x() * target.x());
  if (sensor.y() * target.y() <= 0.0) {
    if (std::min(std::abs(sensor.y()), std::abs(target.y())) > sag) return std::nullopt;
    return way;
  }
  const double turns = sensor.x() + (target.x() - sensor.x()) * sensor.y() / (sensor.y() + target.y());
  const double slack = kBeyondDetour_m + 0.5 * bend * std::max(-mirror.begin_m, mirror.end_m) * length_m + sag;
  if (turns < mirror.begin_m - slack || turns > mirror.end_m + slack) return std::nullopt;
  const double second = length_m - way.rest_m;  // from the sensor's image to the target
  const double opening = second + along.dot(target - Eigen::Vector2d(sensor.x(), -sensor.y()));
  const double reached = std::abs(turns) + 5.0;
  if (second <= 0.0 || kMostMetresPerM * opening < second || bend * reached > kMostBent_rad) return way;
  way.metres_per_m = second / opening;
  way.length_std_m = 2.0 * std::abs(sensor.y() + target.y()) / second * std::sqrt(variance_at(mirror, turns));
  // At that place a bent mirror is half of this away from the straight one, and a way over it so much longer or
  // shorter; some more, as the wave turns elsewhere. meet() may take it for straight beside the sensor.
  const double beside = turns - sensor.x();
  way.error_m = bend * (4.0 * reached * reached + beside * beside) * way.metres_per_m;
  return way;
}

std::optional<Meeting> meet(const Mirror& mirror, const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& from_m,
                            const Eigen::Vector2d& direction, double length_m, double least_m) {
  // By the sensor's image in the mirror's tangent the way is straight: |T − from| + |T − image| = length.
  const bool bent = !is_as_good_as_straight(mirror, length_m);
  double arc = mirror.curve.arc(sensor_m);
  if (bent) arc = 0.5 * (arc + mirror.curve.arc(from_m + 0.5 * length_m * direction));
  Eigen::Vector2d point = mirror.curve.at(arc), tangent = mirror.curve.tangent_at(arc);
  for (int round = 0;; ++round) {
    const Eigen::Vector2d normal(-tangent.y(), tangent.x());
    const Eigen::Vector2d image = sensor_m - 2.0 * normal.dot(sensor_m - point) * normal;
    const Eigen::Vector2d back = from_m - image;
    const double denominator = 2.0 * (length_m + back.dot(direction));
    if (denominator < 1e-6) return std::nullopt;
    const double rest = (length_m * length_m - back.squaredNorm()) / denominator;
    if (rest < least_m || rest > length_m) return std::nullopt;
    const std::optional<Detour> detour = detour_to(mirror, sensor_m, from_m + rest * direction);
    if (!detour) return std::nullopt;
    if (!bent || round == 2) {
      return Meeting{rest, 1.0 / std::max(0.02, 1.0 + direction.dot(detour->arrival)), *detour};
    }
    point = detour->point_m;
    tangent = {detour->normal.y(), -detour->normal.x()};
  }
}

}  // namespace boresight::ghosts
