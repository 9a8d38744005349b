// What a codec says of a frame; wire faults are returned, never asserted.
#pragma once

#include <cstdint>
#include <string_view>

namespace boresight::ingest {

enum class DecodeResult : std::uint8_t {
  kAccepted,   ///< taken; nothing complete yet
  kComplete,   ///< a scan or an ego motion is complete
  kIgnored,    ///< known, but of no use here
  kBadLength,  ///< shorter or longer than its layout
  kBadValue,   ///< a field outside its range, or a checksum that does not match
  kUnknownMessage,
};

}  // namespace boresight::ingest
