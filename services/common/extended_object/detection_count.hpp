// Expected number of detections of an object in one scan of one radar, none included, and the probability of none.
//
//     (8)   n(r, φ) = n₃₀ · (30 m / √(r² + r₀²))^p · f(φ),   P(0) = (k / (k + n))^k.
//
// r is the range of the nearest point of the box, φ the aspect, k the shape of the gamma distribution of the mean. P(0)
// holds for an object in view that nothing hides, in one scan on its own: misses last, which a filter models as a
// state.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "services/common/extended_object/aspect.hpp"
#include "services/common/extended_object/object_classes.hpp"

namespace boresight::extended_object {

/// `towards_sensor_box`: unit vector from the object to the sensor, in box axes.
[[nodiscard]] inline double expected_detections(const DetectionCount& count, double range_m,
                                                const Eigen::Vector2d& towards_sensor_box) {
  constexpr double kReferenceRange_m = 30.0;  // of mean_at_30m
  constexpr int kSidePower = 2;               // of the sine of the aspect
  const double range = std::max(std::hypot(range_m, count.near_range_m), 1e-3);
  return count.mean_at_30m * std::pow(kReferenceRange_m / range, count.range_power) *
         by_aspect(towards_sensor_box, count.rear_factor, count.side_factor, count.front_factor, kSidePower);
}

[[nodiscard]] inline double no_detection_probability(const DetectionCount& count, double expected_detections) {
  if (!(count.dispersion_shape > 0.0)) return std::exp(-expected_detections);
  return std::exp(-count.dispersion_shape * std::log1p(expected_detections / count.dispersion_shape));
}

}  // namespace boresight::extended_object
