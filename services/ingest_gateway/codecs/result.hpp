// A codec's result for a frame. Wire faults are returned, never asserted.
#pragma once

#include <cstdint>
#include <optional>

#include "interfaces/messages/service_status.hpp"

namespace boresight::ingest {

enum class DecodeResult : std::uint8_t {
  kAccepted,   ///< accepted; nothing complete yet
  kComplete,   ///< a scan or an ego motion is complete
  kIgnored,    ///< known, but not used here
  kBadLength,  ///< shorter or longer than its layout
  kBadValue,   ///< a field outside its range, or a checksum that does not match
  kUnknownMessage,
};

/// The fault of a result; nullopt if it is no fault.
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
