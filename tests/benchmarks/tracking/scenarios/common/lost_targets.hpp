// Targets that a tracker finds and then loses.
#pragma once

#include <cstddef>

#include "services/boresight/track/estimates.hpp"

namespace boresight::bench::scenarios {

struct LostTargets {
  static constexpr std::size_t kLongestGap = 5;  ///< scans; choice: a coasting track survives as long
  std::size_t targets = 0;                       ///< of the truth
  std::size_t found = 0;                         ///< with an estimate in some scan
  std::size_t lost = 0;  ///< of these: without an estimate in more than kLongestGap successive scans after that
};

/// A target has an estimate if the best one-to-one assignment of GOSPA with the true base distance pairs it with one:
/// the estimate is then within the cut-off.
[[nodiscard]] LostTargets count_lost_targets(const track::ObjectsByStep& truth, const track::ObjectsByStep& estimates);

}  // namespace boresight::bench::scenarios
