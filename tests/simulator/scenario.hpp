// What a drive is made of.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/messages/header.hpp"

namespace boresight::simulator {

/// Angles by which a radar is crooked, radians: actual = nominal + these.
struct Misalignment {
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
};

/// A vehicle that follows the road at a constant speed and lateral offset.
struct VehicleSpec {
  double start_m = 0.0;    ///< along the road, relative to the ego vehicle at the start
  double lateral_m = 0.0;  ///< left of the ego lane's centre
  double speed_mps = 0.0;  ///< negative: oncoming
  double length_m = 4.5;
  double width_m = 1.9;
};

struct Scenario {
  std::string name;
  double speed_scale = 1.0;                                 ///< k_v: true speed = k_v · signalled speed
  std::array<Misalignment, kMaxRadars + 1> misalignment{};  ///< by radar id
  double mean_speed_mps = 15.0;
  double speed_swing_mps = 6.0;
  double curvature = 1.0;  ///< 0: straight road, 1: winding
  double rail_left_m = 7.5;
  double rail_right_m = -7.5;
  double roadside_density = 1.0;
  std::vector<VehicleSpec> vehicles;
  double ghost_probability = 0.15;  ///< of a vehicle's reflection having a ghost of either type
  double clutter_per_scan = 1.5;
  bool noise = true;
};

/// One of scenario_names(); throws std::invalid_argument that lists them otherwise.
///   demo_drive      winding road, front_right (radar 2) crooked by 2.5° yaw, speed signal 1.2 % low
///   aligned_drive   the same world with nothing crooked: for false alarms
///   straight_rail   straight road between rails, nothing crooked
[[nodiscard]] Scenario scenario(std::string_view name);
[[nodiscard]] std::vector<std::string> scenario_names();

}  // namespace boresight::simulator
