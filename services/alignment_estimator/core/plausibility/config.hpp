// Settings of the search for wrong inputs.
#pragma once

#include "services/common/geometry/angles.hpp"

namespace boresight::alignment {

struct PlausibilityConfig {
  bool enabled = true;
  /// Detections of this time give one velocity of the sensor. Choice: a vehicle's speed changes by 1 m/s at most.
  double window_s = 0.5;
  /// Detections that the velocity explains, as a share of the field of view; with less the window does not count.
  double least_share = 0.35;
  /// The nominal yaw is wrong beyond this angle. Choice: twice the std of mounting errors.
  double yaw_limit_rad = 8.0 * kRadiansPerDegree;
  /// Logarithm of the odds that an input is right before any data. Choice: one of 10,000 drives.
  double prior_log_odds = 9.2;
  /// A finding is reported when its likelihood exceeds that of any other by this factor's logarithm, and withdrawn
  /// below half of it.
  double margin_log = 12.0;
  /// A finding takes at least this time of driving.
  double least_s = 3.0;
};

}  // namespace boresight::alignment
