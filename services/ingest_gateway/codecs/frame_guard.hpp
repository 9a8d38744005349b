// Checks of a CAN frame: length, checksum, E2E protection.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "services/common/e2e/checker.hpp"
#include "services/common/recording/frame.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/dbc/mapping.hpp"

namespace boresight::ingest {

/// Checks one message of a mapping. The texts of its faults are built once, by the constructor.
class FrameGuard {
 public:
  explicit FrameGuard(const dbc::MappedMessage& message);

  /// The payload without CAN FD's padding, or an empty span with the fault reported.
  [[nodiscard]] std::span<const std::uint8_t> usable(const recording::Frame& frame, DecoderOutput& output);

 private:
  std::size_t length_bytes_;
  dbc::Checksum checksum_;
  e2e::Checker e2e_;
  std::string too_short_, bad_checksum_;
  std::array<std::string, 8> bad_protection_;  // by e2e::Status
};

}  // namespace boresight::ingest
