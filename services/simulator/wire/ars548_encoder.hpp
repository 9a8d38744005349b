// Scans in the wire format of the ARS548. The encoder was written from the radar's description, independently of the
// gateway's decoder, so that each checks the other.
#pragma once

#include <array>
#include <cstdint>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::simulator::wire {

inline constexpr std::size_t kArs548ListBytes = 35336;
using Ars548List = std::array<std::uint8_t, kArs548ListBytes>;

inline constexpr std::size_t kArs548StatusBytes = 84;
using Ars548Status = std::array<std::uint8_t, kArs548StatusBytes>;

/// Encodes at most 800 detections; the sensor's clock reads `epoch_ns` and is synchronised.
void encode_ars548(const RadarScan& scan, std::int64_t epoch_ns, Ars548List& bytes);

/// The status message of a synchronised radar in operation that receives the vehicle's motion. `condition` sets its
/// blockage: source_condition::kBlocked, kPartlyBlocked or 0.
[[nodiscard]] Ars548Status encode_ars548_status(std::uint32_t condition);

}  // namespace boresight::simulator::wire
