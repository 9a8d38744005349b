// ARS548 detection list → RadarScan, straight into the given memory.
#pragma once

#include <cstdint>
#include <span>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/e2e/checker.hpp"
#include "services/common/vehicle/vehicle.hpp"
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

/// The stamp of a detection or object list, both of which have it in the same place.
[[nodiscard]] SensorStamp stamp_of(std::span<const std::uint8_t> list);

/// source_condition bits of a status message that check() found kAccepted.
[[nodiscard]] std::uint32_t conditions(std::span<const std::uint8_t> status);

/// One sensor: each detection list is one datagram and one scan.
class Ars548 : public Decoder {
 public:
  /// With `e2e` required, detection lists that fail their check are dropped; real firmware may leave the header zero.
  explicit Ars548(const E2eConfig& e2e = {}) : e2e_required_(e2e.required), checker_(e2e.protection) {}

  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;

 private:
  bool e2e_required_;
  e2e::Checker checker_;
};

}  // namespace boresight::ingest::ars548
