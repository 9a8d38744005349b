// What a radar sees in a mirror: where the wave turned, and where what it met would have to be.
//
// Of a path sensor S → mirror W → target T, whose length is ℓ' = |W−S| + |T−W|, three kinds are detected: back the same
// way (three bounces: range ℓ', direction of W), back directly and forth by the mirror (two bounces, type 1: range
// (|T−S| + ℓ')/2, direction of T), and the other way round (two bounces, type 2: the same range, direction of W).
// By Fermat's principle a shift of W along the mirror changes no length to first order, so that
// dℓ'/dt = d·v_T − u·v_S + (u − d)·v_M with u = S→W, d = W→T and v_M the mirror's own velocity.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "services/ghost_filter/core/mirror/beam.hpp"
#include "services/ghost_filter/core/reflector_map/curve.hpp"
#include "services/ghost_filter/core/reflector_map/reflector_map.hpp"

namespace boresight::ghosts {

inline constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

/// A reflector in the vehicle frame of the scan.
struct Mirror {
  Curve curve;
  Eigen::Matrix3d covariance;  ///< of shift, turn, curvature at the curve's origin
  double begin_m = 0.0, end_m = 0.0;
  double existence = 0.0;
  Eigen::Vector2d velocity_mps{0.0, 0.0};              ///< over ground, vehicle axes
  const Occupancy* occupancy = nullptr;                ///< nullptr: solid from end to end
  double arc_shift_m = 0.0;                            ///< arc length of the curve's origin in the occupancy's count
  double hidden_before_m = 0.0, hidden_after_m = 0.0;  ///< as far beyond its begin and its end vehicles hide it
  std::uint32_t body = kNobody;                        ///< object whose side it is
  double least_range_m = 0.0;                          ///< of what is seen by it: its distance from the sensor
  Beam beam;                                           ///< what it lights, from the sensor
};

/// A rail or a wall, which may go on unseen; a vehicle's side does not.
[[nodiscard]] inline bool is_long(const Mirror& mirror) {
  return mirror.occupancy != nullptr && mirror.end_m - mirror.begin_m >= kLong_m;
}
/// How far beyond the mirror's ends chance_at() may be something.
[[nodiscard]] double most_beyond_m(const Mirror& mirror);
/// Probability that there is something at an arc length known so well.
[[nodiscard]] double chance_at(const Mirror& mirror, double arc_m, double arc_std_m);
/// Of the mirror, across it.
[[nodiscard]] double offset_variance_at(const Mirror& mirror, double arc_m);

/// Where a ray meets a mirror.
struct Turn {
  double distance_m;          ///< |W−S|
  Eigen::Vector2d point_m;    ///< W
  Eigen::Vector2d direction;  ///< d: where it goes on, unit
  Eigen::Vector2d normal;     ///< of the mirror, unit, towards the sensor
  double probability;         ///< that there is something at W
  double offset_std_m;        ///< of the mirror at W
  double angle_std_rad;
  double focus_per_m;  ///< turn of the mirror per metre of shift of the ray across its direction
};

/// The first crossing of the ray (unit `direction`) with the mirror nearer than `farthest_m`; `azimuth_std_rad` says
/// how far beside it may be.
[[nodiscard]] std::optional<Turn> turn_at(const Mirror& mirror, const Eigen::Vector2d& sensor_m,
                                          const Eigen::Vector2d& direction, double farthest_m, double azimuth_std_rad);

/// Length behind W of the path whose way there and back is twice `range_m`; negative: impossible.
[[nodiscard]] double rest_of_three_bounces(const Turn& turn, double range_m);
[[nodiscard]] double rest_of_two_bounces(const Turn& turn, const Eigen::Vector2d& sensor_m, double range_m);

}  // namespace boresight::ghosts
