#include "services/ghost_filter/core/mirror/between_walls.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ghosts {

namespace {

constexpr double kLeastWay_m = 0.2;    // to a wall, and from it
constexpr double kLeastChance = 0.01;  // of there being something where the wave turns both times
constexpr double kAroundTurn_m = 0.5;  // as well as it is known where that is
constexpr double kMostSag_m = 0.5;     // by which a wall may leave its tangent

/// A mirror's tangent, nearest to a place.
struct Wall {
  double arc_m;
  Eigen::Vector2d point_m, normal;
  [[nodiscard]] Eigen::Vector2d image_of(const Eigen::Vector2d& p) const {
    return p - 2.0 * normal.dot(p - point_m) * normal;
  }
  [[nodiscard]] Eigen::Vector2d turned(const Eigen::Vector2d& d) const { return d - 2.0 * normal.dot(d) * normal; }
  /// To the wall from a place in a direction; negative: it lies behind. Not finite if they are parallel.
  [[nodiscard]] double distance_along(const Eigen::Vector2d& from, const Eigen::Vector2d& d) const {
    return normal.dot(point_m - from) / normal.dot(d);
  }
};

Wall wall_at(const Mirror& mirror, const Eigen::Vector2d& place_m) {
  const double arc = mirror.curve.arc(place_m);
  const Eigen::Vector2d tangent = mirror.curve.tangent_at(arc);
  return {arc, mirror.curve.at(arc), {-tangent.y(), tangent.x()}};
}

}  // namespace

std::optional<Meeting> meet_between(const Mirror& first, const Mirror& second, const Eigen::Vector2d& sensor_m,
                                    const Eigen::Vector2d& direction, double length_m) {
  const Wall one = wall_at(first, sensor_m);
  const Eigen::Vector2d image_m = one.image_of(sensor_m);
  const Wall two = wall_at(second, image_m);
  // The sensor's image in the image of the first wall: from there the way is straight.
  const Eigen::Vector2d back = sensor_m - two.image_of(image_m);
  const double opening = 2.0 * (length_m + back.dot(direction));
  if (opening < 1e-6) return std::nullopt;
  const double rest = (length_m * length_m - back.squaredNorm()) / opening, straight = length_m - rest;
  if (!(rest > 0.0) || straight < kLeastWay_m) return std::nullopt;
  const Eigen::Vector2d target_m = sensor_m + rest * direction, arrival = (back + rest * direction) / straight;
  // Back from the target, by each wall from the side on which it came.
  const double from_second = two.distance_along(target_m, -arrival);
  const Eigen::Vector2d at_second = target_m - from_second * arrival, between = two.turned(arrival);
  const double from_first = one.distance_along(at_second, -between);
  const Eigen::Vector2d at_first = at_second - from_first * between, departure = one.turned(between);
  if (!(from_second > kLeastWay_m && from_first > kLeastWay_m)) return std::nullopt;
  if (!(departure.dot(at_first - sensor_m) > kLeastWay_m)) return std::nullopt;
  const auto chance = [](const Mirror& mirror, const Wall& wall, const Eigen::Vector2d& point_m) {
    const double arc = mirror.curve.arc(point_m), off = arc - wall.arc_m;
    return std::abs(mirror.curve.curvature_per_m) * off * off > kMostSag_m ? 0.0
                                                                           : chance_at(mirror, arc, kAroundTurn_m);
  };
  const double probability = chance(first, one, at_first) * chance(second, two, at_second);
  if (probability < kLeastChance) return std::nullopt;
  const double sine_first = std::abs(departure.dot(one.normal)), sine_second = std::abs(arrival.dot(two.normal));
  const double length_variance =
      4.0 * (sine_first * sine_first * offset_variance_at(first, first.curve.arc(at_first)) +
             sine_second * sine_second * offset_variance_at(second, second.curve.arc(at_second)));
  return Meeting{rest,
                 1.0 / std::max(0.02, 1.0 + direction.dot(arrival)),
                 at_second,
                 departure,
                 arrival,
                 probability,
                 std::sqrt(length_variance)};
}

}  // namespace boresight::ghosts
