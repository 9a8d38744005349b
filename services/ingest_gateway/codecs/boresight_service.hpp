// Bodies of the Boresight service's events (interfaces/wire/boresight_service.md) → scans and ego readings.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/codecs/result.hpp"

namespace boresight::ingest::service {

/// Checks the body of a detection list by its header and lengths (section 3.4): kComplete if decode_detections() may
/// read it; otherwise `problem` is the fault with the allowed value.
[[nodiscard]] DecodeResult check_detections(std::span<const std::uint8_t> body, std::string_view& problem);

/// Writes all fields of `scan` except the header from a body with check_detections() kComplete.
[[nodiscard]] SensorStamp decode_detections(std::span<const std::uint8_t> body, RadarScan& scan);

/// Reads the body of an ego motion (section 4); values that are not allowed are treated as not stated. kComplete, or
/// a fault with its `problem`.
[[nodiscard]] DecodeResult decode_ego(std::span<const std::uint8_t> body, EgoReading& reading, SensorStamp& time,
                                      std::string_view& problem);

/// Takes frames whose payload is the body of a detection list, reassembled and checked by the receiver.
class DetectionList : public Decoder {
 public:
  void take(const recording::Frame& body, const FrameStamp& stamp, DecoderOutput& output) override;
};

/// The same for ego motion.
class EgoEvent : public Decoder {
 public:
  void take(const recording::Frame& body, const FrameStamp& stamp, DecoderOutput& output) override;
};

}  // namespace boresight::ingest::service
