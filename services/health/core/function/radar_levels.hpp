// What the radars are used to deliver: the learnt levels that are kept over a restart.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/header.hpp"
#include "services/health/core/function/sight_monitor.hpp"

namespace boresight::health {

struct RadarLevels {
  std::uint32_t radar_id = 0;
  SightLevels sight;
  StoredLevel log_unexplained;  ///< of the disturbance
};

/// Of all radars of a vehicle.
struct VehicleLevels {
  std::size_t number_of_radars = 0;
  std::array<RadarLevels, kMaxRadars> radars{};
};

}  // namespace boresight::health
