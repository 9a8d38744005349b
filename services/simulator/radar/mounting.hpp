// The true mounting of a radar at a time: initial mounting error and sudden misalignments.
#pragma once

#include <Eigen/Core>

#include "services/common/geometry/frames.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/radar_effects.hpp"

namespace boresight::simulator::radar {

/// Mounting error at `t_s`: the initial error and the step changes up to then.
[[nodiscard]] inline Misalignment misalignment_at(const RadarEffects& effects, std::uint32_t radar, double t_s) {
  Misalignment m = radar < effects.misalignment.size() ? effects.misalignment[radar] : Misalignment{};
  for (const RadarStepChange& step_change : effects.step_changes) {
    if (step_change.radar != radar || t_s < step_change.time_s) continue;
    m.yaw_rad += step_change.by.yaw_rad;
    m.pitch_rad += step_change.by.pitch_rad;
    m.roll_rad += step_change.by.roll_rad;
  }
  return m;
}

/// R(sensor→vehicle) of the true mounting.
[[nodiscard]] inline Eigen::Matrix3d actual_mounting(const MountingPose& nominal, const RadarEffects& effects,
                                                     std::uint32_t radar, double t_s) {
  const Misalignment m = misalignment_at(effects, radar, t_s);
  return geometry::sensor_to_vehicle(nominal, m.yaw_rad, m.pitch_rad, m.roll_rad);
}

}  // namespace boresight::simulator::radar
