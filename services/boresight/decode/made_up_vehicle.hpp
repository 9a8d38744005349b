// A vehicle for recordings of which nothing is known but the radars' profile.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/common/recording/reader.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::decode {

/// Names of profiles as in vehicle files.
[[nodiscard]] const std::vector<std::pair<std::string, RadarProfile>>& profiles();

/// A sender of radar data found in a recording.
struct Sender {
  recording::Endpoint endpoint;
  std::uint16_t instance = 0;  ///< kBoresight, as its E2E Data ID says
};

struct Senders {
  std::vector<Sender> radars;  ///< in the order of their first message, 16 at most
  std::optional<Sender> ego;   ///< kBoresight: who sends the vehicle's motion
};

/// Looks for senders in the first frames of a recording (ten thousand of UDP): an ARS548 by its port, a Boresight
/// service by its events.
[[nodiscard]] Senders find_senders(recording::Reader& reader, RadarProfile profile);

struct MadeUp {
  RadarProfile profile = RadarProfile::kArs548;
  std::string interface {};     ///< of CAN; "": any
  std::uint32_t sensor_id = 0;  ///< kArs408
  std::string mapping{};        ///< kMapping
  Senders senders{};            ///< a radar each; none for kArs548: one radar, from any sender
};

/// Radars that may see anything anywhere and are as noisy as the default says. The vehicle's motion is taken from where
/// the profile has it, if it does.
[[nodiscard]] VehicleConfig made_up_vehicle(const MadeUp& options);

}  // namespace boresight::decode
