// A value that depends on the aspect, given at three of them.
#pragma once

#include <Eigen/Core>

namespace boresight::extended_object {

/// `towards_sensor`: unit vector from the object to the sensor in box axes, (cos φ, sin φ) with φ = 0 ahead of it. The
/// ends blend by (1 ± cos φ)/2; the side has the weight sin^power φ, an even power. Smooth in φ, exact at 0, ±90° and
/// 180°. A high power keeps the side's value to aspects near abeam.
[[nodiscard]] inline double by_aspect(const Eigen::Vector2d& towards_sensor, double rear, double side, double front,
                                      int power) {
  const double end = 0.5 * (front + rear) + 0.5 * (front - rear) * towards_sensor.x();
  double weight = 1.0;
  for (int i = 0; i < power; ++i) weight *= towards_sensor.y();
  return end + weight * (side - end);
}

}  // namespace boresight::extended_object
