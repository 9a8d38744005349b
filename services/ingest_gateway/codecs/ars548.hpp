// ARS548 detection list → RadarScan, straight into the given memory.
#pragma once

#include <cstdint>
#include <span>

#include "interfaces/messages/radar_scan.hpp"
#include "services/ingest_gateway/codecs/result.hpp"

namespace boresight::ingest::ars548 {

/// The sensor's own stamp.
struct SensorTime {
  std::int64_t epoch_ns = 0;
  bool synchronised = false;
};

/// Judges one UDP payload by its header, lengths and ranges. kComplete: a sound detection list, to be passed to
/// decode(). Object lists, status and filter status are kIgnored. Otherwise `problem` says what is wrong and what is
/// allowed.
[[nodiscard]] DecodeResult check(std::span<const std::uint8_t> datagram, std::string_view& problem);

/// Writes all fields of `scan` but the header from a datagram that check() found kComplete. Angles in radians, metres,
/// m/s; range rate positive when receding, as on the wire. A single implausible detection is flagged, not refused.
[[nodiscard]] SensorTime decode(std::span<const std::uint8_t> datagram, RadarScan& scan);

}  // namespace boresight::ingest::ars548
