// Assigns faults of messages and segments to the counted kinds of faults.
#pragma once

#include "interfaces/messages/service_status.hpp"
#include "services/common/someip/message.hpp"
#include "services/ingest_gateway/codecs/someip/tp.hpp"

namespace boresight::ingest::someip {

using namespace boresight::someip;

/// Only for results that are faults.
[[nodiscard]] constexpr Fault kind_of(ReadResult result) {
  const bool is_value = result == ReadResult::kProtocolVersion || result == ReadResult::kMessageType;
  return is_value ? Fault::kWireValue : Fault::kWireLength;
}

[[nodiscard]] constexpr Fault kind_of(TpResult result) {
  const bool is_length =
      result == TpResult::kTooShort || result == TpResult::kNotMultiple || result == TpResult::kOverSize;
  return is_length ? Fault::kWireLength : Fault::kWireValue;
}

}  // namespace boresight::ingest::someip
