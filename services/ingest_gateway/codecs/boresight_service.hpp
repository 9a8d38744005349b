// Bodies of the Boresight service's events → scans and ego readings, as interfaces/wire/boresight_service.md has them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/codecs/result.hpp"

namespace boresight::ingest::service {

/// Judges the body of a detection list by its header and lengths (section 3.4): kComplete if decode_detections() may
/// read it; otherwise `problem` says what is wrong and what is allowed.
[[nodiscard]] DecodeResult check_detections(std::span<const std::uint8_t> body, std::string_view& problem);

/// Writes all fields of `scan` but the header from a body that check_detections() found kComplete.
[[nodiscard]] SensorStamp decode_detections(std::span<const std::uint8_t> body, RadarScan& scan);

/// Reads the body of an ego motion (section 4); values that are not allowed are taken as not stated. kComplete or a
/// fault with its `problem`.
[[nodiscard]] DecodeResult decode_ego(std::span<const std::uint8_t> body, EgoReading& reading, SensorStamp& time,
                                      std::string_view& problem);

/// Takes frames whose payload is the body of a detection list: put together, checked and stripped by the receiver.
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
