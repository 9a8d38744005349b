// How long a scan waited between two stages.
#pragma once

#include <algorithm>
#include <cstdint>

#include "interfaces/messages/header.hpp"

namespace boresight::runtime {

/// Time in ns from the end of the latest stage that stamped the message to `begin_ns`, when the next stage takes it:
/// transport and waiting. 0 without a stamp, and if a stamp lies in the future.
[[nodiscard]] inline std::int64_t queueing_ns(const MessageHeader& message, std::int64_t begin_ns) {
  std::int64_t end_ns = 0;
  for (const StageStamp& stage : message.stages) end_ns = std::max(end_ns, stage.end_ns);
  return end_ns > 0 ? std::max<std::int64_t>(0, begin_ns - end_ns) : 0;
}

}  // namespace boresight::runtime
