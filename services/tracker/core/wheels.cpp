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

bool is_seen_all_round(const Cluster& cluster) {
  constexpr double kMeanSight = 0.98;  // spread over some 0.2 rad
  constexpr std::uint32_t kLeast = 3;  // two may be the body and a wheel, and who knows which
  return cluster.mean_sight.norm() < kMeanSight && cluster.number_on_outline >= kLeast;
}

void follow_rates(KinematicState& vehicle, const Cluster& cluster, const Eigen::Vector2d& sensor_m) {
  constexpr double kStd_mps = 0.3;
  for (std::uint32_t k = 0; k < cluster.number_on_outline; ++k) {
    PositionRate one{};
    one.line_of_sight = (cluster.outline[k] - sensor_m).normalized();
    one.value(2) = cluster.outline_rate_mps[k];
    one.covariance(2, 2) = kStd_mps * kStd_mps;
    const double real = cluster.realness * chance_of_body(vehicle, one);
    update_rate(vehicle, one.line_of_sight, one.value(2), kStd_mps * kStd_mps / real);
  }
}

}  // namespace boresight::tracking
