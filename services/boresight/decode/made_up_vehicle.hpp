// A vehicle for recordings of which nothing is known but the radar's profile.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::decode {

/// Names of profiles as in vehicle files.
[[nodiscard]] const std::vector<std::pair<std::string, RadarProfile>>& profiles();

struct MadeUp {
  RadarProfile profile = RadarProfile::kArs548;
  std::string interface;  ///< of CAN; "": any
};

/// One radar, id 1, that takes frames from any sender, may see anything anywhere, and is as noisy as the default says.
[[nodiscard]] VehicleConfig made_up_vehicle(const MadeUp& options);

}  // namespace boresight::decode
