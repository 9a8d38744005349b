// A point reflector of a body or of the stationary world.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "services/simulator/scene.hpp"

namespace boresight::simulator::radar {

struct Target {
  Eigen::Vector3d position_m, velocity_mps;
  Eigen::Vector3d facing;  ///< half-space from which it is visible; zero: from everywhere
  double rcs_dbsm;
  std::uint32_t body_id;  ///< 0: a scatterer
  bool moving;
  std::uint64_t key;  ///< of its random draws
  Origin origin{};    ///< of a scatterer

  [[nodiscard]] bool seen_from(const Eigen::Vector3d& place_m) const {
    return facing.isZero() || facing.dot(place_m - position_m) > 0.0;
  }
};

}  // namespace boresight::simulator::radar
