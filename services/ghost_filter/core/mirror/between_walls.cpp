#include "services/ghost_filter/core/mirror/between_walls.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ghosts {

namespace {

constexpr double kLeastWayBetweenWalls_m = 0.2;   // to a wall, and from it
constexpr double kLeastChanceOfBothWalls = 0.01;  // of there being something where the wave turns both times
constexpr double kAroundTurn_m = 0.5;             // as well as it is known where that is
constexpr double kMostSag_m = 0.5;                // by which a wall may leave its tangent

}  // namespace

WaysBetween::Wall WaysBetween::wall_at(const Mirror& mirror, const Eigen::Vector2d& place_m) {
  const double arc = mirror.curve.arc(place_m);
  const Eigen::Vector2d tangent = mirror.curve.tangent_at(arc);
  return {arc, mirror.curve.at(arc), {-tangent.y(), tangent.x()}};
}

WaysBetween::WaysBetween(const Mirror& first, const Mirror& second, const Eigen::Vector2d& sensor_m)
    : first_(&first),
      second_(&second),
      sensor_m_(sensor_m),
      one_(wall_at(first, sensor_m)),
      two_(wall_at(second, one_.image_of(sensor_m))),
      back_(sensor_m - two_.image_of(one_.image_of(sensor_m))),
      least_range_m_(first.least_range_m + second.least_range_m) {}

double WaysBetween::chance_of(const Mirror& mirror, const Wall& wall, double arc_m) {
  const double off = arc_m - wall.arc_m;
  return std::abs(mirror.curve.curvature_per_m) * off * off > kMostSag_m ? 0.0
                                                                         : chance_at(mirror, arc_m, kAroundTurn_m);
}

std::optional<Meeting> WaysBetween::meet(const Eigen::Vector2d& direction, double length_m) const {
  const double opening = 2.0 * (length_m + back_.dot(direction));
  if (opening < 1e-6) return std::nullopt;
  const double rest = (length_m * length_m - back_.squaredNorm()) / opening, straight = length_m - rest;
  if (!(rest > 0.0) || straight < kLeastWayBetweenWalls_m) return std::nullopt;
  const Eigen::Vector2d target_m = sensor_m_ + rest * direction, arrival = (back_ + rest * direction) / straight;
  // Back from the target, by each wall from the side on which it came.
  const double from_second = two_.distance_along(target_m, -arrival);
  const Eigen::Vector2d at_second = target_m - from_second * arrival, between = two_.turned(arrival);
  const double from_first = one_.distance_along(at_second, -between);
  const Eigen::Vector2d at_first = at_second - from_first * between, departure = one_.turned(between);
  if (!(from_second > kLeastWayBetweenWalls_m && from_first > kLeastWayBetweenWalls_m)) return std::nullopt;
  if (!(departure.dot(at_first - sensor_m_) > kLeastWayBetweenWalls_m)) return std::nullopt;
  const double arc_of_first = first_->curve.arc(at_first), arc_of_second = second_->curve.arc(at_second);
  const double probability = chance_of(*first_, one_, arc_of_first) * chance_of(*second_, two_, arc_of_second);
  if (probability < kLeastChanceOfBothWalls) return std::nullopt;
  const double sine_first = std::abs(departure.dot(one_.normal)), sine_second = std::abs(arrival.dot(two_.normal));
  const double length_variance = 4.0 * (sine_first * sine_first * offset_variance_at(*first_, arc_of_first) +
                                        sine_second * sine_second * offset_variance_at(*second_, arc_of_second));
  return Meeting{rest,
                 1.0 / std::max(0.02, 1.0 + direction.dot(arrival)),
                 at_second,
                 departure,
                 arrival,
                 probability,
                 std::sqrt(length_variance)};
}

}  // namespace boresight::ghosts
