// The yardstick: iceoryx alone, a process per hop, each waiting on a WaitSet and loaning a chunk of the stage's size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boresight::bench {

/// Sends `messages` chunks of chunk_bytes[0] every `period_ns` through chunk_bytes.size() hops, the last of which only
/// receives; returns the time of each from before the first loan to the last wake-up, ns. Starts a RouDi of its own.
[[nodiscard]] std::vector<double> bare_chain(const std::vector<std::size_t>& chunk_bytes, std::int64_t period_ns,
                                             std::size_t messages);

}  // namespace boresight::bench
