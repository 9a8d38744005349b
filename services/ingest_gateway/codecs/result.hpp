// What a codec says of a frame; wire faults are returned, never asserted.
#pragma once

#include <cstdint>
#include <optional>

#include "interfaces/messages/service_status.hpp"

namespace boresight::ingest {

enum class DecodeResult : std::uint8_t {
  kAccepted,   ///< taken; nothing complete yet
  kComplete,   ///< a scan or an ego motion is complete
  kIgnored,    ///< known, but of no use here
  kBadLength,  ///< shorter or longer than its layout
  kBadValue,   ///< a field outside its range, or a checksum that does not match
  kUnknownMessage,
};

/// The fault that a result is; nullopt if it is none.
[[nodiscard]] constexpr std::optional<Fault> fault_of(DecodeResult result) {
  switch (result) {
    case DecodeResult::kBadLength:
      return Fault::kWireLength;
    case DecodeResult::kBadValue:
      return Fault::kWireValue;
    case DecodeResult::kUnknownMessage:
      return Fault::kWireUnknown;
    case DecodeResult::kAccepted:
    case DecodeResult::kComplete:
    case DecodeResult::kIgnored:
      break;
  }
  return std::nullopt;
}

}  // namespace boresight::ingest
