#include "services/tracker/core/owners.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace boresight::tracking {

namespace {

/// The nearest person, if any: limbs are within so much of where they are thought to be.
std::size_t person_at(const Seen& seen, std::span<const KnownPlace> known) {
  constexpr double kReach_m = 1.5;
  std::size_t person = known.size();
  double nearest_m2 = kReach_m * kReach_m;
  for (std::size_t k = 0; k < known.size(); ++k) {
    if (!known[k].is_small) continue;
    const double distance_m2 = (known[k].position_m - seen.at_m).squaredNorm();
    if (distance_m2 >= nearest_m2 || !known[k].may_show(seen.rate_mps, seen.sight)) continue;
    nearest_m2 = distance_m2;
    person = k;
  }
  return person;
}

/// Density of the range rate, for each m/s: most detections are of the body, the others of wheels, which turn at
/// anything between nothing and twice its speed.
double rate_density(const Seen& seen, const KnownPlace& vehicle) {
  constexpr double kOfBody = 0.6, kBodyStd_mps = 0.15;
  constexpr double kLeastRange_mps = 1.0, kMore_mps = 0.3;  // of the range rates of a wheel
  constexpr double kAnything = 1e-4;                        // errors, and what is no vehicle's at all
  const double mean = seen.sight.dot(vehicle.velocity_mps), off = std::abs(seen.rate_mps - mean);
  const double variance = kBodyStd_mps * kBodyStd_mps + seen.rate_std_mps * seen.rate_std_mps +
                          seen.sight.dot(vehicle.velocity_covariance * seen.sight);
  const double body = kOfBody * std::exp(-0.5 * off * off / variance) / std::sqrt(2.0 * M_PI * variance);
  const bool may_be_wheel = off < std::abs(mean) + kMore_mps;
  return body + (may_be_wheel ? (1.0 - kOfBody) / std::max(kLeastRange_mps, 2.0 * std::abs(mean)) : kAnything);
}

/// The likeliest vehicle, if any may be.
std::size_t vehicle_at(const Seen& seen, std::span<const KnownPlace> known) {
  constexpr double kReach_m = 3.0, kGate_chi2 = 9.0;
  constexpr double kRough_m = 0.3;  // boxes are not known better, and what reflects is not quite at their faces
  const Eigen::Vector2d left(-seen.sight.y(), seen.sight.x());
  const Eigen::Matrix2d noise = seen.range_std_m * seen.range_std_m * seen.sight * seen.sight.transpose() +
                                seen.across_std_m * seen.across_std_m * left * left.transpose() +
                                kRough_m * kRough_m * Eigen::Matrix2d::Identity();
  std::size_t vehicle = known.size();
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < known.size(); ++k) {
    const double reach_m = known[k].half_m.sum() + kReach_m;
    if (known[k].is_small || (known[k].position_m - seen.at_m).squaredNorm() >= reach_m * reach_m) continue;
    const Eigen::Vector2d way = known[k].way_to(seen.at_m);
    const Eigen::Matrix2d covariance = noise + known[k].position_covariance_m2;
    const double chi2 = way.dot(covariance.inverse() * way);
    // Written so that what is not a number is not near.
    if (way.squaredNorm() > kReach_m * kReach_m || !(chi2 < kGate_chi2)) continue;
    const double log_density =
        -0.5 * (chi2 + std::log(covariance.determinant())) + std::log(rate_density(seen, known[k]));
    if (log_density <= most) continue;
    most = log_density;
    vehicle = k;
  }
  return vehicle;
}

}  // namespace

std::size_t owner_of(const Seen& seen, std::span<const KnownPlace> known) {
  const std::size_t person = person_at(seen, known);
  if (person < known.size()) return person;
  // The likeliest vehicle may be but the only one that is known there.
  const std::size_t vehicle = vehicle_at(seen, known);
  return vehicle < known.size() && is_beside(seen, known[vehicle]) ? known.size() : vehicle;
}

bool is_beside(const Seen& seen, const KnownPlace& vehicle) {
  constexpr double kHalfWidest_m = 1.3, kRough_m = 0.3;
  constexpr double kOwnSpeed_mps = 0.15;  // in a jam lanes differ by little, but range rates are told to a tenth
  const Eigen::Vector2d left(-vehicle.axis.y(), vehicle.axis.x());
  const double off_line_m = std::abs(left.dot(seen.at_m - vehicle.position_m));
  const double variance = seen.across_std_m * seen.across_std_m + left.dot(vehicle.position_covariance_m2 * left);
  return off_line_m > kHalfWidest_m + kRough_m + std::sqrt(variance) &&
         std::abs(seen.rate_mps - seen.sight.dot(vehicle.velocity_mps)) > kOwnSpeed_mps;
}

}  // namespace boresight::tracking
