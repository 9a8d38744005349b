#include "services/tracker/core/wheels.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace boresight::tracking {

namespace {

/// Share of wheels in what is the strongest of several, and in the others: plates and corners reflect some 10 dB more.
constexpr double kOfStrongest = 0.02, kOfOthers = 0.9;

/// Which detection on the outline is the strongest; none if the sensor measures no strength.
std::optional<std::uint32_t> strongest_of(const Cluster& cluster) {
  std::optional<std::uint32_t> strongest;
  for (std::uint32_t k = 0; k < cluster.number_on_outline; ++k) {
    if (!std::isfinite(cluster.outline_dbsm[k])) continue;
    if (!strongest || cluster.outline_dbsm[k] > cluster.outline_dbsm[*strongest]) strongest = k;
  }
  return strongest;
}

}  // namespace

double chance_of_body(const KinematicState& vehicle, const PositionRate& measurement, double wheel_share) {
  constexpr double kLeastRange_mps = 1.0;  // of the range rates of a wheel
  constexpr double kLeastChance = 1e-3;
  const Eigen::Vector2d& sight = measurement.line_of_sight;
  const double expected = sight.dot(vehicle.mean.segment<2>(2));
  const double variance = measurement.covariance(2, 2) + sight.dot(vehicle.covariance.block<2, 2>(2, 2) * sight);
  const double residual = measurement.value(2) - expected;
  const double of_body =
      (1.0 - wheel_share) * std::exp(-0.5 * residual * residual / variance) / std::sqrt(2.0 * M_PI * variance);
  const double of_wheel = wheel_share / std::max(kLeastRange_mps, 2.0 * std::abs(expected));
  return std::max(kLeastChance, of_body / (of_body + of_wheel));
}

bool is_seen_all_round(const Cluster& cluster) {
  constexpr double kMeanSight = 0.98;  // spread over some 0.2 rad
  constexpr std::uint32_t kLeast = 2;  // what is rather a ghost has a part in the mean, but no range rate of its own
  return cluster.mean_sight.norm() < kMeanSight && cluster.number_on_outline >= kLeast;
}

void follow_rates(KinematicState& vehicle, const Cluster& cluster, const Eigen::Vector2d& sensor_m) {
  constexpr double kStd_mps = 0.3;
  const auto follow = [&](std::uint32_t k, double wheel_share) {
    PositionRate one{};
    one.line_of_sight = (cluster.outline[k] - sensor_m).normalized();
    one.value(2) = cluster.outline_rate_mps[k];
    one.covariance(2, 2) = kStd_mps * kStd_mps;
    const double real = cluster.realness * chance_of_body(vehicle, one, wheel_share);
    update_rate(vehicle, one.line_of_sight, one.value(2), kStd_mps * kStd_mps / real);
  };
  // The surest one first: by what it says, wheels are told. In another order a wheel that happens to fit would have
  // its say first, and the body might no longer fit.
  const auto strongest = strongest_of(cluster);
  if (strongest) follow(*strongest, kOfStrongest);
  for (std::uint32_t k = 0; k < cluster.number_on_outline; ++k) {
    if (k != strongest) follow(k, strongest ? kOfOthers : kWheelShare);
  }
}

}  // namespace boresight::tracking
