// SOME/IP-TP: reassembles messages from segments, in fixed memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "services/common/recording/ip_address.hpp"
#include "services/common/someip/message.hpp"

namespace boresight::ingest::someip {

using namespace boresight::someip;
using boresight::someip::describe;

enum class TpResult : std::uint8_t {
  kAccepted,       ///< accepted; segments are still missing
  kComplete,       ///< the message is complete
  kDuplicate,      ///< no new bytes, or its message was just delivered
  kLate,           ///< of a message that a newer one of the same sender has replaced
  kRefused,        ///< of a message that was rejected as too long
  kNotASegment,    ///< the TP bit is not set
  kNoSession,      ///< session id 0: messages are not distinguishable
  kTooShort,       ///< no TP header, or no byte after it
  kNotMultiple,    ///< more segments follow, but the length is not a multiple of 16
  kContradiction,  ///< reaches beyond the message's end, or contradicts the end by another segment
  kOverSize,       ///< the message is longer than the configured maximum
};
/// True for results that are faults of the sender or of the network.
[[nodiscard]] bool is_fault(TpResult result);
/// Description of a fault with the allowed value.
[[nodiscard]] std::string_view describe(TpResult result);

/// Counters since construction.
struct TpStatistics {
  std::uint64_t completed = 0;
  std::uint64_t dropped_incomplete = 0;  ///< messages that remained incomplete, for any reason
  std::uint64_t duplicates = 0;          ///< segments without new bytes
  std::uint64_t overlaps = 0;            ///< segments with new and with existing bytes
  std::uint64_t late_segments = 0;       ///< segments of replaced messages
  std::uint64_t bad_segments = 0;        ///< contradictory segments, or segments that contradict their message
  std::uint64_t over_size = 0;           ///< segments beyond the longest allowed message
};

/// Reassembles messages from segments in any order. Segments belong to the same message if Message ID, versions, type,
/// Request ID and sender are equal. Bytes that arrive first have priority over repeated ones. A message is dropped
/// - when the same sender starts the next message of its kind,
/// - after a time-out, or
/// - when no slot is free: the oldest of the sender that starts another message, or else the oldest of all.
/// A contradictory segment is rejected; the correct one can still complete the message.
///
/// Memory: `slots` × (`max_message_bytes` + 1/128 of it), allocated by the constructor only.
class TpReassembler {
 public:
  /// `max_message_bytes` is the longest payload. At least one slot of 16 bytes is provided.
  TpReassembler(std::size_t slots, std::size_t max_message_bytes, std::int64_t timeout_ns);

  /// Takes one segment; copies its bytes once, to their offset in the message. If the result is kComplete, `complete`
  /// is the message with its spans in the assembly buffer. The header before the payload has the type without the TP
  /// bit and the total length; the return code is that of the last received segment. Valid until the next take().
  [[nodiscard]] TpResult take(const Message& segment, const recording::Endpoint& sender, std::int64_t now_ns,
                              Message& complete);
  /// Drops messages that are incomplete for too long; returns their number.
  std::size_t expire(std::int64_t now_ns);

  [[nodiscard]] const TpStatistics& statistics() const { return statistics_; }

 private:
  enum class State : std::uint8_t { kFree, kAssembling, kDelivered, kRefused };
  struct Assembly {
    State state = State::kFree;
    Message header;
    recording::Endpoint sender;
    std::int64_t since_ns = 0;       // time of the first segment, or of completion
    std::int64_t last_ns = 0;        // time of the latest accepted segment
    std::size_t received_units = 0;  // of 16 bytes
    std::size_t received_end = 0;    // offset after the last received byte
    std::size_t total_bytes = 0;     // known with the last segment, else 0
  };

  [[nodiscard]] Assembly* find(const Message& segment, const recording::Endpoint& sender);
  [[nodiscard]] Assembly& begin(const Message& segment, const recording::Endpoint& sender, std::int64_t now_ns);
  [[nodiscard]] TpResult place(Assembly& assembly, std::size_t offset, std::span<const std::uint8_t> data, bool last);
  [[nodiscard]] Message finish(Assembly& assembly, const Message& last_segment, std::int64_t now_ns);
  [[nodiscard]] bool is_over(const Assembly& assembly, std::int64_t now_ns) const;
  void drop(Assembly& assembly);
  [[nodiscard]] std::size_t index_of(const Assembly& assembly) const;
  [[nodiscard]] std::span<std::uint8_t> buffer_of(const Assembly& assembly);
  [[nodiscard]] std::span<std::uint64_t> units_of(const Assembly& assembly);

  std::size_t max_message_bytes_;
  std::int64_t timeout_ns_;
  std::size_t buffer_bytes_;
  std::size_t words_per_assembly_;
  std::vector<Assembly> assemblies_;
  std::vector<std::uint8_t> buffers_;
  std::vector<std::uint64_t> units_;  // one bit per received 16 bytes
  TpStatistics statistics_;
};

}  // namespace boresight::ingest::someip
