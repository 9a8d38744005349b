// Faults by kind.
#pragma once

#include <array>
#include <numeric>

#include "interfaces/messages/service_status.hpp"

namespace boresight::ingest {

struct FaultCounts {
  [[nodiscard]] std::size_t count(Fault kind) const { return faults[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] std::size_t all_faults() const { return std::accumulate(faults.begin(), faults.end(), std::size_t{0}); }

  std::array<std::size_t, kNumberOfFaults> faults{};
};

}  // namespace boresight::ingest
