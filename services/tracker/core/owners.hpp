// Which of the objects that are tracked a detection is of.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include <Eigen/Core>

namespace boresight::tracking {

/// Where a tracked object is expected in the scan.
struct KnownPlace {
  Eigen::Vector2d position_m, axis, half_m;  ///< centre; direction of the length, unit; half of length and width
  bool is_small = false;                     ///< a person or a cycle
  Eigen::Vector2d velocity_mps{0.0, 0.0};    ///< over ground
  Eigen::Matrix2d position_covariance_m2 = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d velocity_covariance = Eigen::Matrix2d::Zero();  ///< m²/s²
  /// Whether limbs or wheels of who moves so may show that range rate over ground in that direction.
  [[nodiscard]] bool may_show(double rate_mps, const Eigen::Vector2d& sight) const {
    constexpr double kMore_mps = 1.5;
    const double mean_mps = sight.dot(velocity_mps);
    return std::abs(rate_mps - mean_mps) < std::abs(mean_mps) + kMore_mps;
  }
  /// From the box to a point, the shortest way, in the axes of both; nothing to a point in the box.
  [[nodiscard]] Eigen::Vector2d way_to(const Eigen::Vector2d& point_m) const {
    const Eigen::Vector2d d = point_m - position_m;
    const Eigen::Vector2d at(axis.dot(d), axis.x() * d.y() - axis.y() * d.x());
    const Eigen::Vector2d way = at - at.cwiseMax(-half_m).cwiseMin(half_m);
    return {axis.x() * way.x() - axis.y() * way.y(), axis.y() * way.x() + axis.x() * way.y()};
  }
};

/// A detection as the sensor tells it.
struct Seen {
  Eigen::Vector2d at_m, sight;       ///< the place, and the unit vector to it
  double range_std_m, across_std_m;  ///< of the place, along and across the line of sight
  double rate_mps, rate_std_mps;     ///< over ground
};

/// The one that a detection is of, or the number of all. It is of the nearest person within arm's reach who may show
/// such a range rate. Else it is of the vehicle that it is likeliest of, by how far off its box it lies, beside the
/// noise and what is not known of the track, and by its range rate, which is the body's or a wheel's: cars at the end
/// of a radar's range are nearer to each other than azimuths are sure, but in a jam each lane has a speed of its own.
/// What is surely beside the likeliest one is nobody's.
[[nodiscard]] std::size_t owner_of(const Seen& seen, std::span<const KnownPlace> known);

/// Whether a detection is surely of something beside the vehicle: it lies farther from its middle line than vehicles
/// are wide, however wide the box has been drawn by what is beside it, and moves otherwise than its body.
[[nodiscard]] bool is_beside(const Seen& seen, const KnownPlace& vehicle);

}  // namespace boresight::tracking
