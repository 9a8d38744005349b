// The frame around a state that a service keeps over its restarts. Layout, little-endian: magic (8 characters), version
// (u32), length of all (u32), content, CRC-32/AUTOSAR of all before (u32).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "services/common/state/bytes.hpp"

namespace boresight::state {

inline constexpr std::size_t kFrameHeadBytes = 16;
inline constexpr std::size_t kFrameBytes = kFrameHeadBytes + 4;  ///< without the content

enum class FrameVerdict : std::uint8_t {
  kIntact,
  kCorrupt,       ///< truncated, changed, or another kind of file
  kOtherVersion,  ///< intact, of a version unknown to this program
};

struct Frame {
  FrameVerdict verdict = FrameVerdict::kCorrupt;
  std::span<const std::uint8_t> content;  ///< of an intact frame; views the bytes that were given
};

/// Begins a frame at the start of an empty writer; `magic` has eight characters. The content follows.
void begin_frame(ByteWriter& writer, std::string_view magic, std::uint32_t version);
/// Completes the frame. Returns the number of bytes; 0 if they do not fit.
[[nodiscard]] std::size_t end_frame(ByteWriter& writer);

[[nodiscard]] Frame open_frame(std::span<const std::uint8_t> bytes, std::string_view magic, std::uint32_t version);

}  // namespace boresight::state
