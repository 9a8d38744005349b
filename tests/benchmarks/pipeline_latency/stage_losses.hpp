// Scans that each service lost or dropped, by its own counters.
#pragma once

#include <array>
#include <cstdint>

#include "interfaces/catalogue/catalogue.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight::bench {

struct StageLosses {
  std::uint64_t outputs = 0;
  std::uint64_t lost = 0;     ///< its queue overflowed
  std::uint64_t dropped = 0;  ///< superseded by a newer scan of the radar
};

/// By Service, from the last heartbeat of each that the observer received.
[[nodiscard]] inline std::array<StageLosses, catalogue::kNumberOfServices> losses_of(
    const harness::Observer& observer) {
  std::array<StageLosses, catalogue::kNumberOfServices> losses{};
  for (const harness::Sample* sample : observer.of(catalogue::TopicId::kServiceStatus)) {
    if (sample->header.source_id >= losses.size()) continue;
    const auto& faults = sample->status.faults;
    losses[sample->header.source_id] = {.outputs = sample->status.outputs,
                                        .lost = faults[static_cast<std::size_t>(Fault::kInputLost)],
                                        .dropped = faults[static_cast<std::size_t>(Fault::kInputDropped)]};
  }
  return losses;
}

}  // namespace boresight::bench
