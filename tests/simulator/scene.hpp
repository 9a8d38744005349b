// The world at an instant, as what a radar can see of it: the interface between the world, which knows roads and
// trajectories, and the radar model, which knows waves.
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
  double speed_mps;
  double acceleration_mps2;
  double yaw_rate_radps;
};

/// A spot that reflects back: a corner, a wheel house, a leg. `facing`: unit vector out of the body's side, in which
/// half-space it is seen; zero: from everywhere.
struct ReflectionCentre {
  Eigen::Vector3d position_m;
  Eigen::Vector3d velocity_mps;  ///< over ground, with turning and micro-motion (wheels, limbs)
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
  double clearance_m;                             ///< between road and underbody: where a radar sees through below
  double flank_low_m;                             ///< lower edge of the flanks, of what mirrors
  std::uint32_t first_centre, number_of_centres;  ///< in Scene::centres
};

/// A vertical rectangle that mirrors: rail, wall, façade, side of a large vehicle. What lies on its left when one looks
/// from `from_m` to `to_m` and what lies on its right are both mirrored.
struct MirrorSurface {
  Eigen::Vector2d from_m, to_m;
  double low_m, high_m;  ///< heights of its edges
  double loss_db;        ///< of power, per bounce, ≥ 0
  Eigen::Vector2d velocity_mps;
  std::uint32_t body_id;  ///< of the body whose side it is; 0: a structure
  bool opaque;            ///< hides what is behind, within its heights; a rail on posts does as well
};

/// Which table of its scenario something that stands comes from.
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

/// Buffers are reused from instant to instant.
struct Scene {
  double t_s = 0.0;
  EgoPose ego{};
  std::vector<Body> bodies;
  std::vector<ReflectionCentre> centres;
  std::vector<MirrorSurface> surfaces;
  std::vector<Scatterer> scatterers;  ///< within the reach that was asked for
};

}  // namespace boresight::simulator
