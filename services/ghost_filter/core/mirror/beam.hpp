// What a mirror lights: the waves from the sensor that it sends on lie between those from its two ends. Most mirrors
// are short, and most places are in the beam of none: that is told without following a way.
#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace boresight::ghosts {

struct Mirror;

class Beam {
 public:
  /// Lights all places.
  Beam() = default;
  Beam(const Mirror& mirror, const Eigen::Vector2d& sensor_m);
  /// Whether a wave by the mirror may come to any place on the straight line from one to the other.
  [[nodiscard]] bool may_light(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const {
    return is_between(begin_.left(from_m), end_.left(from_m), to_m);
  }
  /// The same of the line of sight, from the sensor to a place.
  [[nodiscard]] bool may_light_before(const Eigen::Vector2d& to_m) const {
    return is_between(begin_from_sensor_m_, end_from_sensor_m_, to_m);
  }

 private:
  [[nodiscard]] bool is_between(double begin_from_m, double end_from_m, const Eigen::Vector2d& to_m) const {
    const double begin_to_m = begin_.left(to_m), end_to_m = end_.left(to_m);
    const double least = std::min(std::min(begin_from_m, begin_to_m), std::min(end_from_m, end_to_m));
    const double most = std::max(std::max(begin_from_m, begin_to_m), std::max(end_from_m, end_to_m));
    return least <= slack_m_ && most >= -slack_m_;
  }
  struct Ray {
    double a = 0.0, b = 0.0, c_m = 0.0;
    [[nodiscard]] double left(const Eigen::Vector2d& p) const { return a * p.x() + b * p.y() + c_m; }  // metres
  };
  // From the mirror's ends. What lies on the same side of both is beside the beam, even if they meet.
  Ray begin_, end_;
  double slack_m_ = 0.0;
  double begin_from_sensor_m_ = 0.0, end_from_sensor_m_ = 0.0;  // of the sensor, left of them
};

}  // namespace boresight::ghosts
