// The body of the ego vehicle, which hides targets from its own radars.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace boresight::simulator::radar {

/// A box in the vehicle frame, whose origin is the rear axle on the ground.
struct EgoBody {
  double rear_m = -1.0;
  double front_m = 3.7;
  double half_width_m = 0.95;
  double clearance_m = 0.15;
  double height_m = 1.5;
};

/// The part of the body that blocks the view of one radar.
struct EgoBox {
  Eigen::Vector2d low_m, high_m;  ///< vehicle frame
  double clearance_m, height_m;
};

/// The radar sits in the bumper, so inside the box, and only its cover is in front of it. A face of the box less than
/// 0.4 m from the radar is therefore moved behind it.
[[nodiscard]] inline EgoBox seen_from(const EgoBody& body, const Eigen::Vector3d& mount_m) {
  constexpr double kBumper_m = 0.4, kBehind_m = 0.02;
  EgoBox box{{body.rear_m, -body.half_width_m}, {body.front_m, body.half_width_m}, body.clearance_m, body.height_m};
  for (Eigen::Index i = 0; i < 2; ++i) {
    if (std::abs(box.low_m(i) - mount_m(i)) < kBumper_m) box.low_m(i) = mount_m(i) + kBehind_m;
    if (std::abs(box.high_m(i) - mount_m(i)) < kBumper_m) box.high_m(i) = mount_m(i) - kBehind_m;
  }
  // A radar mounted deeper inside would see nothing at all. For such a radar the body hides nothing.
  const Eigen::Vector2d mount = mount_m.head<2>();
  if ((mount.array() > box.low_m.array()).all() && (mount.array() < box.high_m.array()).all()) box.low_m = box.high_m;
  return box;
}

}  // namespace boresight::simulator::radar
