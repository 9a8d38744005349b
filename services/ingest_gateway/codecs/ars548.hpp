// ARS548 detection list → RadarScan, directly into the given memory.
#pragma once

#include <cstdint>
#include <span>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/e2e/checker.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/codecs/result.hpp"

namespace boresight::ingest::ars548 {

/// Checks one UDP payload by its header, lengths and ranges. kComplete: a valid detection list for decode(). kIgnored:
/// object lists and filter status. kAccepted: a valid status message. Otherwise `problem` is the fault with the allowed
/// value.
[[nodiscard]] DecodeResult check(std::span<const std::uint8_t> datagram, std::string_view& problem);

/// Writes all fields of `scan` except the header from a datagram with check() kComplete. Angles in radians, metres,
/// m/s; range rate positive when receding, as on the wire. A single implausible detection is flagged, not rejected.
[[nodiscard]] SensorStamp decode(std::span<const std::uint8_t> datagram, RadarScan& scan);

/// The stamp of a detection or object list, which has the same offset in both.
[[nodiscard]] SensorStamp stamp_of(std::span<const std::uint8_t> list);

/// source_condition bits of a status message with check() kAccepted.
[[nodiscard]] std::uint32_t conditions(std::span<const std::uint8_t> status);

/// One sensor: each detection list is one datagram and one scan.
class Ars548 : public Decoder {
 public:
  /// With `e2e` required, detection lists that fail their check are dropped; some firmware leaves the header at zero.
  explicit Ars548(const E2eConfig& e2e = {}) : e2e_required_(e2e.required), checker_(e2e.protection) {}

  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;

 private:
  bool e2e_required_;
  e2e::Checker checker_;
};

}  // namespace boresight::ingest::ars548
