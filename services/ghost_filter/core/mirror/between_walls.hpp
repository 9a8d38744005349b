// Ways to and fro between two walls: what drives between them is lit by one wall, which the other lights.
#pragma once

#include "services/ghost_filter/core/mirror/meeting.hpp"

namespace boresight::ghosts {

/// Ways from a sensor by one mirror and then by another, which are referred to. What all of them have in common, the
/// images of images, is worked out once.
class WaysBetween {
 public:
  WaysBetween(const Mirror& first, const Mirror& second, const Eigen::Vector2d& sensor_m);
  [[nodiscard]] const Mirror& second() const { return *second_; }
  /// The way there and back is as long as to both of them.
  [[nodiscard]] double least_range_m() const { return least_range_m_; }
  /// As WaysBy::meet(), of a ray from the sensor itself. Nothing where one of them is not as good as straight as far as
  /// the wave turns. `point_m` and `arrival` are of the second one.
  [[nodiscard]] std::optional<Meeting> meet(const Eigen::Vector2d& direction, double length_m) const;

 private:
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
  [[nodiscard]] static Wall wall_at(const Mirror& mirror, const Eigen::Vector2d& place_m);
  [[nodiscard]] static double chance_of(const Mirror& mirror, const Wall& wall, double arc_m);
  const Mirror *first_, *second_;
  Eigen::Vector2d sensor_m_;
  Wall one_, two_;
  Eigen::Vector2d back_;  // to the sensor from its image in the image of the first wall: from there the way is straight
  double least_range_m_;
};

}  // namespace boresight::ghosts
