// The simulated bodies that are not parked, in the ego vehicle's frame.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "services/simulator/drive.hpp"
#include "services/simulator/judge/object.hpp"

namespace boresight::closed_loop {

using judge::Object;

[[nodiscard]] inline std::vector<Object> objects_at(const simulator::Drive& drive, double t_s) {
  const simulator::EgoState ego = drive.ego(t_s);
  Eigen::Matrix2d to_vehicle;
  to_vehicle << std::cos(ego.heading_rad), std::sin(ego.heading_rad), -std::sin(ego.heading_rad),
      std::cos(ego.heading_rad);
  std::vector<Object> objects;
  for (std::size_t i = 0; i < drive.world().number_of_bodies(); ++i) {
    const simulator::Body b = drive.world().body(i, t_s);
    if (b.parked) continue;
    objects.push_back({b.id, to_vehicle * (b.position_m - ego.position_m), to_vehicle * b.velocity_mps,
                       b.heading_rad - ego.heading_rad, b.length_m, b.width_m});
  }
  return objects;
}

}  // namespace boresight::closed_loop
