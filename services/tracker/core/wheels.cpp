#include "services/tracker/core/wheels.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

double chance_of_body(const KinematicState& vehicle, const PositionRate& measurement) {
  constexpr double kWheelShare = 0.5;      // of the detections of a vehicle that is seen from beside
  constexpr double kLeastRange_mps = 1.0;  // of the range rates of a wheel
  constexpr double kLeastChance = 1e-3;
  const Eigen::Vector2d& sight = measurement.line_of_sight;
  const double expected = sight.dot(vehicle.mean.segment<2>(2));
  const double variance = measurement.covariance(2, 2) + sight.dot(vehicle.covariance.block<2, 2>(2, 2) * sight);
  const double residual = measurement.value(2) - expected;
  const double of_body =
      (1.0 - kWheelShare) * std::exp(-0.5 * residual * residual / variance) / std::sqrt(2.0 * M_PI * variance);
  const double of_wheel = kWheelShare / std::max(kLeastRange_mps, 2.0 * std::abs(expected));
  return std::max(kLeastChance, of_body / (of_body + of_wheel));
}

}  // namespace boresight::tracking
