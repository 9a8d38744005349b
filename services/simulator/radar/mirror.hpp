// A vertical rectangle as a mirror: mirror images of points, and specular points of paths.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "services/simulator/scene.hpp"

namespace boresight::simulator::radar {

struct Mirror {
  Eigen::Vector2d origin_m, tangent, normal;  ///< unit vectors, normal to the left
  double length_m, low_m, high_m, loss_db;
  double outer;  ///< face that mirrors: +1 the one that the normal points to, −1 the other, 0 both (a structure)
  std::uint32_t body_id;
  Eigen::Vector2d velocity_mps, pivot_m;  ///< the surface at p moves with velocity + yaw rate × (p − pivot)
  double yaw_rate_radps;
  std::uint64_t key;  ///< for random draws

  /// Signed distance from the mirror's plane, metres, positive to the left.
  [[nodiscard]] double across(const Eigen::Vector3d& p) const { return normal.dot(p.head<2>() - origin_m); }
  /// Distance along the mirror from its origin, metres.
  [[nodiscard]] double along(const Eigen::Vector3d& p) const { return tangent.dot(p.head<2>() - origin_m); }
  /// Whether the mirror reflects a point at this signed distance from its plane.
  [[nodiscard]] bool faces(double across_m) const { return outer == 0.0 ? across_m != 0.0 : across_m * outer > 0.0; }

  /// Mirror image of a point.
  [[nodiscard]] Eigen::Vector3d image(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d flat = p.head<2>() - 2.0 * across(p) * normal;
    return {flat.x(), flat.y(), p.z()};
  }
  [[nodiscard]] Eigen::Vector3d velocity_at(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d arm = p.head<2>() - pivot_m;
    return {velocity_mps.x() - yaw_rate_radps * arm.y(), velocity_mps.y() + yaw_rate_radps * arm.x(), 0.0};
  }
};

/// Makes the mirror of a body's side, or of a structure (`body` is nullptr). A body's side rotates with the body and
/// mirrors on its outer face only.
[[nodiscard]] inline Mirror make_mirror(const MirrorSurface& surface, const Body* body) {
  Mirror m{};
  m.origin_m = surface.from_m;
  m.length_m = (surface.to_m - surface.from_m).norm();
  m.tangent = (surface.to_m - surface.from_m) / m.length_m;
  m.normal = {-m.tangent.y(), m.tangent.x()};
  m.low_m = surface.low_m;
  m.high_m = surface.high_m;
  m.loss_db = surface.loss_db;
  m.body_id = surface.body_id;
  m.velocity_mps = surface.velocity_mps;
  if (body != nullptr) {
    m.outer = m.normal.dot(body->position_m - m.origin_m) > 0.0 ? -1.0 : 1.0;
    m.velocity_mps = body->velocity_mps;
    m.pivot_m = body->position_m;
    m.yaw_rate_radps = body->yaw_rate_radps;
  } else {
    m.pivot_m = surface.from_m;
  }
  return m;
}

/// Specular point `at_m` of the path from `source_m` (a sensor, or its mirror image in another mirror) to `target_m`:
/// the straight line from the source to the target's mirror image crosses the mirror there. False if that point lies
/// outside the rectangle, or if source and target are not on the same mirroring face.
[[nodiscard]] inline bool bounce(const Mirror& mirror, const Eigen::Vector3d& source_m, const Eigen::Vector3d& target_m,
                                 Eigen::Vector3d& at_m) {
  const double source = mirror.across(source_m), target = mirror.across(target_m);
  if (source * target <= 0.0 || !mirror.faces(source)) return false;
  const double part = source / (source + target);
  const double along = mirror.along(source_m) + part * (mirror.along(target_m) - mirror.along(source_m));
  if (along < 0.0 || along > mirror.length_m) return false;
  const double z = source_m.z() + part * (target_m.z() - source_m.z());
  if (z < mirror.low_m || z > mirror.high_m) return false;
  const Eigen::Vector2d flat = mirror.origin_m + along * mirror.tangent;
  at_m = {flat.x(), flat.y(), z};
  return true;
}

/// Whether a target within `radius_m` of `centre_m` may have a specular point. Never false if one has.
[[nodiscard]] inline bool may_bounce(const Mirror& mirror, const Eigen::Vector3d& source_m,
                                     const Eigen::Vector3d& centre_m, double radius_m) {
  const double source = mirror.across(source_m);
  if (!mirror.faces(source)) return false;
  const double sign = source > 0.0 ? 1.0 : -1.0, height = sign * source, middle = sign * mirror.across(centre_m);
  if (middle + radius_m <= 0.0) return false;
  // The specular point is monotone in the target's position along and across the mirror: its extremes are at the
  // corners.
  const double near = height / (height + std::max(0.0, middle - radius_m)), far = height / (height + middle + radius_m);
  const double begin = mirror.along(source_m), shift = mirror.along(centre_m) - begin;
  const double low = shift - radius_m, high = shift + radius_m;
  return begin + std::min(low * near, low * far) <= mirror.length_m && begin + std::max(high * near, high * far) >= 0.0;
}

}  // namespace boresight::simulator::radar
