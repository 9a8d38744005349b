// The part of the world that a radar can see at an instant. This is the interface between the world model (roads and
// trajectories) and the radar model (wave propagation).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace boresight::simulator {

/// World frame: x-y is the road's plane, z up. The ego vehicle's origin is its rear axle on the ground.
struct EgoPose {
  Eigen::Vector2d position_m;
  double heading_rad;
  double speed_mps;  ///< along the heading
  double acceleration_mps2;
  double yaw_rate_radps;
  double lateral_speed_mps = 0.0;  ///< of the rear axle, positive to the left: side slip
  double body_pitch_rad = 0.0;     ///< of the body about the rear axle, positive with the nose up
};

/// A point that reflects back to the radar: a corner, a rim, a leg. `facing` is a unit vector out of the body's
/// side: the point is visible from that half-space. A zero vector means visible from everywhere.
struct ReflectionCentre {
  Eigen::Vector3d position_m;
  Eigen::Vector3d velocity_mps;  ///< over ground, including rotation and micro-Doppler motion (rims, limbs)
  Eigen::Vector3d facing;
  double rcs_dbsm;
};

enum class BodyKind : std::uint8_t { kCar, kVan, kTruck, kPedestrian, kCyclist };

/// An extended body, moving or parked. Ids begin at 1 and stay the same for a drive.
struct Body {
  std::uint32_t id;
  BodyKind kind;
  bool parked;
  Eigen::Vector2d position_m;  ///< centre
  double heading_rad;
  Eigen::Vector2d velocity_mps;
  double yaw_rate_radps;
  double length_m, width_m, height_m;
  double clearance_m;                             ///< between road and underbody: a radar sees through this gap
  double side_low_m;                              ///< lower edge of the sides that mirror
  std::uint32_t first_centre, number_of_centres;  ///< in Scene::centres
};

/// A vertical rectangle that mirrors: rail, wall, façade, side of a large vehicle. It mirrors targets on both of its
/// faces.
struct MirrorSurface {
  Eigen::Vector2d from_m, to_m;
  double low_m, high_m;  ///< heights of its edges
  double loss_db;        ///< of power, per bounce, ≥ 0
  Eigen::Vector2d velocity_mps;
  std::uint32_t body_id;  ///< of the body whose side it is; 0: a structure
  bool opaque;            ///< hides targets behind it, within its heights; also for a rail on posts
};

/// The table of the scenario that a stationary thing comes from.
struct Origin {
  enum class Kind : std::uint8_t { kNone, kStructure, kScatter };
  Kind kind = Kind::kNone;
  std::uint32_t index = 0;  ///< of the [[structure]] or [[scatter]], from 0 as in messages about the file
  [[nodiscard]] bool operator==(const Origin&) const = default;
};

/// A stationary point reflector: post, kerb, leaf, facet of a wall.
struct Scatterer {
  Eigen::Vector3d position_m;
  double rcs_dbsm;
  Origin origin{};
};

/// The content of the world at one instant. Buffers are reused from instant to instant.
struct Scene {
  double t_s = 0.0;
  EgoPose ego{};
  std::vector<Body> bodies;
  std::vector<ReflectionCentre> centres;
  std::vector<MirrorSurface> surfaces;
  std::vector<Scatterer> scatterers;  ///< within the requested reach
};

}  // namespace boresight::simulator
