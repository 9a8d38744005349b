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

#include "services/ghost_filter/core/reflector_map/curve.hpp"
#include "services/ghost_filter/core/reflector_map/reflector_map.hpp"

namespace boresight::ghosts {

inline constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

/// As far beyond its ends a long mirror may go on unseen.
inline constexpr double kMirrorGoesOn_m = 40.0;

/// A reflector in the vehicle frame of the scan.
struct Mirror {
  Curve curve;
  Eigen::Matrix3d covariance;  ///< of shift, turn, curvature at the curve's origin
  double begin_m = 0.0, end_m = 0.0;
  double existence = 0.0;
  Eigen::Vector2d velocity_mps{0.0, 0.0};  ///< over ground, vehicle axes
  const Occupancy* occupancy = nullptr;    ///< nullptr: solid from end to end
  double arc_shift_m = 0.0;                ///< arc length of the curve's origin in the occupancy's count
  std::uint32_t body = kNobody;            ///< object whose side it is
  double least_range_m = 0.0;              ///< of what is seen by it: its distance from the sensor
};

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

/// The way from the sensor by a mirror to a known place.
struct Detour {
  double length_m;            ///< ℓ'
  Eigen::Vector2d point_m;    ///< W
  Eigen::Vector2d normal;     ///< of the mirror at W, unit
  Eigen::Vector2d departure;  ///< u, unit
  Eigen::Vector2d arrival;    ///< d, unit
  double probability;         ///< that there is something at W
  double length_std_m;
};
[[nodiscard]] std::optional<Detour> detour_to(const Mirror& mirror, const Eigen::Vector2d& sensor_m,
                                              const Eigen::Vector2d& target_m);

/// Where on a ray something would have to be that is reached by way of the mirror.
struct Meeting {
  double rest_m;        ///< from the ray's begin
  double metres_per_m;  ///< by which it lies farther if the whole way is longer by one metre
  Detour detour;        ///< to it
};
/// Where meet() would find it, were the mirror straight: what is known of most ways without following them.
struct Approach {
  double rest_m, metres_per_m;
  double length_std_m;  ///< of the way by the mirror
  double error_m;       ///< as far off `rest_m` may be; infinite where that is not known
};
/// Nothing if the wave would turn beyond the mirror's ends, or on its other side, however the mirror may be bent.
[[nodiscard]] std::optional<Approach> approach(const Mirror& mirror, const Eigen::Vector2d& sensor_m,
                                               const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
                                               double length_m);

/// The place T on the ray from `from_m` (unit `direction`) for which |T − from| and the way from the sensor by the
/// mirror to T have the sum `length_m`. Nothing if it is not there or less than `least_m` along.
[[nodiscard]] std::optional<Meeting> meet(const Mirror& mirror, const Eigen::Vector2d& sensor_m,
                                          const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
                                          double length_m, double least_m);

}  // namespace boresight::ghosts
