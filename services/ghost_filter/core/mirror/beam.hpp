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
    const double begin_from = begin_.left(from_m), begin_to = begin_.left(to_m);
    const double end_from = end_.left(from_m), end_to = end_.left(to_m);
    const double least = std::min(std::min(begin_from, begin_to), std::min(end_from, end_to));
    const double most = std::max(std::max(begin_from, begin_to), std::max(end_from, end_to));
    return least <= slack_m_ && most >= -slack_m_;
  }

 private:
  struct Ray {
    double a = 0.0, b = 0.0, c_m = 0.0;
    [[nodiscard]] double left(const Eigen::Vector2d& p) const { return a * p.x() + b * p.y() + c_m; }  // metres
  };
  // From the mirror's ends. What lies on the same side of both is beside the beam, even if they meet.
  Ray begin_, end_;
  double slack_m_ = 0.0;
};

}  // namespace boresight::ghosts
