// ARS548 detection list → RadarScan, straight into the given memory.
#pragma once

#include <cstdint>
#include <span>

#include "interfaces/messages/radar_scan.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/codecs/result.hpp"

namespace boresight::ingest::ars548 {

/// Judges one UDP payload by its header, lengths and ranges. kComplete: a sound detection list, to be passed to
/// decode(). Object lists and filter status are kIgnored, kAccepted is a sound status message. Otherwise `problem` says
/// what is wrong and what is allowed.
[[nodiscard]] DecodeResult check(std::span<const std::uint8_t> datagram, std::string_view& problem);

/// Writes all fields of `scan` but the header from a datagram that check() found kComplete. Angles in radians, metres,
/// m/s; range rate positive when receding, as on the wire. A single implausible detection is flagged, not refused.
[[nodiscard]] SensorStamp decode(std::span<const std::uint8_t> datagram, RadarScan& scan);

/// source_condition bits of a status message that check() found kAccepted.
[[nodiscard]] std::uint32_t conditions(std::span<const std::uint8_t> status);

/// One sensor: each detection list is one datagram and one scan.
class Ars548 : public Decoder {
 public:
  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;
};

}  // namespace boresight::ingest::ars548
