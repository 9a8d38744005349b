// What is hidden behind what.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tests/simulator/radar/ego_body.hpp"
#include "tests/simulator/scene.hpp"

namespace boresight::simulator::radar {

class Occlusion {
 public:
  /// Takes what stands in the way within `reach_m` of `centre_m`: bodies as boxes from clearance to height, opaque
  /// structures within their heights, the ego vehicle's box. Buffers are reused.
  void prepare(const Scene& scene, const Eigen::Vector2d& centre_m, double reach_m, const EgoBox& ego);

  /// Whether nothing is between the two points. `own_body`: of which `to_m` is a part, and which does not hide it (its
  /// reflection centres face somewhere instead). `embedded_m`: `to_m` may lie behind a structure's surface by so much
  /// and still be a part of it.
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
