// Lines of candump logs (can-utils): `(seconds.micro) interface ID#HEX`.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "services/common/recording/frame.hpp"

namespace boresight::recording {

/// Result of parsing one line.
enum class CandumpResult : std::uint8_t {
  kFrame,
  kEmpty,        ///< blank line
  kBadStamp,     ///< no `(seconds.fraction)`
  kBadName,      ///< no interface name, or longer than 15 characters
  kBadId,        ///< CAN id not 3 or 8 hexadecimal digits, or out of range
  kBadData,      ///< odd digits, no hexadecimal, or more bytes than the kind of frame carries
  kTrailingText  ///< something other than a direction (R, T) after the data
};

[[nodiscard]] std::string_view describe(CandumpResult result);

/// Parses classic (`ID#HEX`), extended (8 digits), FD (`ID##<flags>HEX`) and remote (`ID#R`) frames; tolerates a
/// trailing direction and CR. `bytes` receives the data that `frame.payload` views.
[[nodiscard]] CandumpResult parse_candump_line(std::string_view line, Frame& frame,
                                               std::array<std::uint8_t, 64>& bytes);

}  // namespace boresight::recording
