// Parses the lines of candump (can-utils), from log files and from the console.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "services/common/recording/frame.hpp"

namespace boresight::recording {

/// Result of parsing one line.
enum class CandumpResult : std::uint8_t {
  kFrame,
  kEmpty,         ///< blank line, or the indented explanation that `candump -e` writes below an error frame
  kErrorFrame,    ///< a well-formed error frame: a state of the bus, not data
  kDropCount,     ///< `candump -d` reports that the kernel dropped frames here
  kCanXl,         ///< a CAN XL frame, which is not supported
  kNoStamp,       ///< a console line without a time stamp
  kBadStamp,      ///< a stamp that is neither `(seconds.fraction)` nor `(date time.fraction)`
  kBadName,       ///< no interface name, longer than 15 characters, or with control characters
  kBadId,         ///< CAN id not 3 or 8 hexadecimal digits, or out of range
  kBadData,       ///< odd or not hexadecimal digits, or a number of bytes that the kind of frame does not allow
  kTrailingText,  ///< something other than a direction (R, T) or the console's ASCII column after the data
  kTooLong        ///< longer than any line of candump
};

[[nodiscard]] std::string_view describe(CandumpResult result);
/// True for results to be reported: the line's content is lost.
[[nodiscard]] bool is_problem(CandumpResult result);

/// Origin of a time stamp.
enum class CandumpStamp : std::uint8_t {
  kAbsolute,  ///< since the epoch, or the origin of the log file
  kRelative   ///< console of `-tz` (since the first frame) or `-td` (since the previous one), which look alike
};

/// Longest line of candump: 2048 bytes of CAN XL on the console.
constexpr std::size_t kMaxCandumpLine = 16384;

struct CandumpLine {
  Frame frame;  ///< its payload views `bytes`
  CandumpStamp stamp = CandumpStamp::kAbsolute;
  std::array<std::uint8_t, 64> bytes{};
};

/// Parses
///   log      `(1.5) can0 123#0102`, `12345678#…`, FD `123##<flags>…`, remote `123#R8`, raw DLC `…_9`, a direction
///   behind console  `(1.5)  can0  [RX B -]  123   [2]  01 02   '..'`, FD `[24]`, `remote request`, `ERRORFRAME`, `-i`,
///   `-S`,
///            `-c` (colours), `-tA` (a date without time zone, read as UTC)
/// with either kind of line ending. Any bytes are allowed in `line`; time is bounded by its length.
[[nodiscard]] CandumpResult parse_candump_line(std::string_view line, CandumpLine& out);

}  // namespace boresight::recording
