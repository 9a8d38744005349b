// GOSPA of estimates beside the truth of a simulated scenario, scan by scan.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "services/boresight/track/estimates.hpp"
#include "services/simulator/judge/gospa.hpp"

namespace boresight::track {

struct GospaScore {
  judge::GospaBase base;
  std::vector<judge::GospaParts> scans;  ///< of steps 1 … T of the truth
  std::size_t not_considered = 0;        ///< pairs that the judge could not consider

  [[nodiscard]] judge::GospaParts mean() const;
};

/// Estimates after the last step of the truth are not judged.
[[nodiscard]] GospaScore score_gospa(const ObjectsByStep& truth, const ObjectsByStep& estimates, judge::GospaBase base);

/// A row for each score, in columns; with `per_step` a row for each step before.
[[nodiscard]] std::string gospa_text(std::span<const GospaScore> scores, bool per_step);

}  // namespace boresight::track
