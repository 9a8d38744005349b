// Occlusion of targets by bodies, structures and the ego vehicle.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/simulator/radar/ego_body.hpp"
#include "services/simulator/scene.hpp"

namespace boresight::simulator::radar {

class Occlusion {
 public:
  /// Takes the obstacles within `reach_m` of `centre_m`: bodies as boxes from clearance to height, opaque structures
  /// within their heights, and the ego vehicle's box. Buffers are reused.
  void prepare(const Scene& scene, const Eigen::Vector2d& centre_m, double reach_m, const EgoBox& ego);

  /// Whether the line between two points is free. `own_body` is the body that `to_m` belongs to: it does not hide its
  /// own reflection centres, whose `facing` limits their visibility instead. `embedded_m`: a point at most this far
  /// behind a structure's surface is part of the structure and not hidden by it.
  [[nodiscard]] bool clear(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, std::uint32_t own_body = 0,
                           double embedded_m = 0.05) const;

 private:
  struct Box {
    Eigen::Vector2d centre, axis, half;
    double radius, low, high;
    std::uint32_t body_id;
  };
  struct Sheet {
    Eigen::Vector2d from, along, normal;  // `along` to the other end; `normal` is a unit vector
    double low, high;
  };
  [[nodiscard]] static bool blocks(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  [[nodiscard]] static bool blocks(const Sheet& sheet, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                   double embedded_m);
  std::vector<Box> boxes_;
  std::vector<Sheet> sheets_;
};

}  // namespace boresight::simulator::radar
