// Scenarios with a radar profile, and the vehicle whose radars stand as those that were measured.
#pragma once

#include <cstdint>
#include <string>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/scenario.hpp"

namespace boresight::bench::realism {

/// The measured column that a profile is judged by.
enum class Source : std::uint8_t {
  kNone,
  kRadarScenes,  ///< R: Schumann et al. 2021
  kNuScenes,     ///< N: Caesar et al. 2020
};
[[nodiscard]] Source source_of(const std::string& profile);

/// The scenario with this profile for all radars. The random offset of a radar's RCS scale is switched off, since the
/// tables of RCS are in the scale of the measured radars.
[[nodiscard]] simulator::Scenario with_profile(simulator::Scenario scenario, const std::string& profile);

/// Radars of kRadarScenes: four behind the front bumper at yaw ±25° and ±85°, 75 ms, ±70°, 100 m. Of kNuScenes: five,
/// ahead, to the sides and to the rear, 77 ms; their directions and view are a choice. `demo`: for noise and body.
[[nodiscard]] VehicleConfig measuring_vehicle(const VehicleConfig& demo, Source source);

}  // namespace boresight::bench::realism
