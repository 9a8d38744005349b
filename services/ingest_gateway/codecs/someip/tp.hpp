// SOME/IP-TP: segments → the message they were cut from, in fixed memory.
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
  kAccepted,       ///< taken; segments are still missing
  kComplete,       ///< the message is whole
  kDuplicate,      ///< all of its bytes were there already, or its message was delivered just now
  kLate,           ///< of a message that a newer one of the same sender has replaced
  kRefused,        ///< of a message that was found too long before
  kNotASegment,    ///< the TP bit is not set
  kNoSession,      ///< session id 0: messages could not be told apart
  kTooShort,       ///< no TP header, or no byte behind it
  kNotMultiple,    ///< more segments follow, but the length is not a multiple of 16
  kContradiction,  ///< reaches beyond the message's end, or ends it elsewhere than another segment did
  kOverSize,       ///< the message is longer than the configured maximum
};
/// Whether the sender or the network did something wrong.
[[nodiscard]] bool is_fault(TpResult result);
/// What is wrong and what is allowed, for a fault.
[[nodiscard]] std::string_view describe(TpResult result);

/// Since construction.
struct TpStatistics {
  std::uint64_t completed = 0;
  std::uint64_t dropped_incomplete = 0;  ///< messages that never became whole, for whatever reason
  std::uint64_t duplicates = 0;          ///< segments that brought nothing new
  std::uint64_t overlaps = 0;            ///< segments that brought new bytes and others that were there
  std::uint64_t late_segments = 0;       ///< segments of replaced messages
  std::uint64_t bad_segments = 0;        ///< segments that contradict themselves or their message
  std::uint64_t over_size = 0;           ///< segments beyond the longest message allowed
};

/// Puts messages together from segments that arrive in any order. Segments belong together if Message ID, versions,
/// type, Request ID and sender agree. Of what arrives twice the first wins. A message is dropped when the same sender
/// begins the next of its kind, when it takes too long, or when all assemblies are busy and it is the oldest, of those
/// of the sender that wants to begin another if it has any. A segment that is wrong in itself is left out; the message
/// can still become whole by the right one.
///
/// Memory: `slots` × (`max_message_bytes` + 1/128 of it), taken by the constructor; nothing is allocated later.
class TpReassembler {
 public:
  /// `max_message_bytes` is the longest payload. At least one slot of 16 bytes is provided.
  TpReassembler(std::size_t slots, std::size_t max_message_bytes, std::int64_t timeout_ns);

  /// Takes one segment; its bytes are copied once, to their place in the message. If the result is kComplete,
  /// `complete` is the message with its spans in the assembly buffer, where a header of the plain type and the whole
  /// length stands before the payload; the return code is that of the segment that came last. It is valid until the
  /// next take().
  [[nodiscard]] TpResult take(const Message& segment, const recording::Endpoint& sender, std::int64_t now_ns,
                              Message& complete);
  /// Drops what has been incomplete for too long; returns how many messages that were.
  std::size_t expire(std::int64_t now_ns);

  [[nodiscard]] const TpStatistics& statistics() const { return statistics_; }

 private:
  enum class State : std::uint8_t { kFree, kAssembling, kDelivered, kRefused };
  struct Assembly {
    State state = State::kFree;
    Message header;
    recording::Endpoint sender;
    std::int64_t since_ns = 0;       // of the first segment, or of the end
    std::int64_t last_ns = 0;        // of the latest segment that was taken
    std::size_t received_units = 0;  // of 16 bytes
    std::size_t received_end = 0;    // behind the last byte that came
    std::size_t total_bytes = 0;     // known once the last segment came, else 0
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
  std::vector<std::uint64_t> units_;  // one bit per 16 bytes that came
  TpStatistics statistics_;
};

}  // namespace boresight::ingest::someip
