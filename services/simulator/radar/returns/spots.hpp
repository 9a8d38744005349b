// Places of an object's detections: near end and near side, seldom the far end, some inside.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "services/simulator/radar/profile.hpp"
#include "services/simulator/radar/returns/draws.hpp"
#include "services/simulator/radar/returns/object_class.hpp"

namespace boresight::simulator::radar {

inline constexpr double kInside_m = 0.7;  ///< depth that counts as inside (measured so)

/// An exponential variate with this mean, truncated at `most`, at a share 0 … 1 of its distribution.
[[nodiscard]] inline double truncated_exponential(double share, double mean, double most) {
  if (!(mean > 0.0)) return 0.0;
  return -mean * std::log(1.0 - share * (1.0 - std::exp(-most / mean)));
}

/// Uniform numbers 0 … 1 that decide one place.
struct SpotDraw {
  double along, across, face, inside, height;
};

/// Offset from the body's centre in the body's axes: x ahead, y left, z above the road. `sensor_body_m` is the sensor
/// relative to the body's centre, in its axes. The distance behind the near end is exponential, so that the distance
/// behind the nearest point along the line of sight has the mean `behind_m`. Seen from the side it is nearly uniform.
/// End and side share the places by their projected sizes. On the end a place lies anywhere across. On the side it
/// lies near the surface, or with probability `inside_share` over kInside_m inside the box.
[[nodiscard]] inline Eigen::Vector3d spot_on_vehicle(const Body& body, const Eigen::Vector2d& sensor_body_m,
                                                     double behind_m, double inside_share, const SpotDraw& draw) {
  constexpr double kLow_m = 0.3, kHigh_m = 1.1;  // as bumpers, lamps, rims and guards (choice)
  constexpr double kSurface_m = 0.3;  // mean depth near the surface (measured on nuScenes: median 0.24–0.36)
  const double range = std::max(1e-3, sensor_body_m.norm());
  const double cosine = std::abs(sensor_body_m.x()) / range, sine = std::abs(sensor_body_m.y()) / range;
  const double ahead = sensor_body_m.x() > 0.0 ? 1.0 : -1.0, left = sensor_body_m.y() > 0.0 ? 1.0 : -1.0;
  const double mean_x = behind_m / std::max(0.05, cosine);
  const double end = body.width_m * cosine, side = body.length_m * sine, half = 0.5 * body.width_m;
  double x = truncated_exponential(draw.along, mean_x, body.length_m);
  double y = body.width_m * (draw.across - 0.5);
  if (draw.face * (end + side) >= end) {
    const bool inside = draw.inside < inside_share && half > kInside_m && body.length_m > 2.0 * kInside_m;
    if (inside) x = kInside_m + truncated_exponential(draw.along, mean_x, body.length_m - 2.0 * kInside_m);
    const double depth = inside ? kInside_m + draw.across * (half - kInside_m)
                                : truncated_exponential(draw.across, kSurface_m, std::min(half, kInside_m));
    y = left * (half - depth);
  }
  return {ahead * (0.5 * body.length_m - x), y, kLow_m + (kHigh_m - kLow_m) * draw.height};
}

/// The offset of an object's n-th detection. Its draws are held, so places last for some scans.
[[nodiscard]] inline Eigen::Vector3d spot_of(const SpotSpec& spec, const Body& body,
                                             const Eigen::Vector2d& sensor_body_m, std::uint32_t n,
                                             const Draws& draws) {
  Stream stream = draws.held("spot", key_of(body.id, n), spec.correlation);
  SpotDraw draw{};
  for (double* const number : {&draw.along, &draw.across, &draw.face, &draw.inside, &draw.height}) {
    *number = stream.uniform();
  }
  if (!is_vehicle(body.kind)) {
    return {body.length_m * (draw.along - 0.5), body.width_m * (draw.across - 0.5), 0.8 * body.height_m * draw.height};
  }
  const bool truck = body.kind == BodyKind::kTruck;
  return spot_on_vehicle(body, sensor_body_m, truck ? spec.truck_behind_m : spec.car_behind_m,
                         truck ? spec.truck_inside_share : spec.car_inside_share, draw);
}

}  // namespace boresight::simulator::radar
