// A vehicle configuration for recordings of which only the radars' profile is known.
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
  std::uint16_t instance = 0;  ///< kBoresight: from its E2E Data ID
};

struct Senders {
  std::vector<Sender> radars;  ///< in the order of their first message, 16 at most
  std::optional<Sender> ego;   ///< kBoresight: the sender of the ego motion
};

/// Searches the first ten thousand UDP frames of a recording for senders: an ARS548 is known by its port, a Boresight
/// service by its events.
[[nodiscard]] Senders find_senders(recording::Reader& reader, RadarProfile profile);

struct MadeUp {
  RadarProfile profile = RadarProfile::kArs548;
  std::string interface {};     ///< of CAN; "": any
  std::uint32_t sensor_id = 0;  ///< kArs408
  std::string mapping{};        ///< kMapping
  Senders senders{};            ///< a radar for each; if empty for kArs548: one radar, from any sender
};

/// The radars have an unlimited field of view and the default noise. The ego motion is taken from the profile's own
/// messages, if it has any.
[[nodiscard]] VehicleConfig made_up_vehicle(const MadeUp& options);

}  // namespace boresight::decode
