// The levels of a detection's evidence.
#pragma once

#include <optional>

#include "services/ghost_filter/core/evidence/config.hpp"
#include "services/ghost_filter/core/evidence/counts.hpp"
#include "services/ghost_filter/core/evidence/levels.hpp"
#include "services/ghost_filter/core/origins/expected.hpp"

namespace boresight::ghosts {

/// What the sensor itself says of a detection.
struct SensorVerdict {
  bool is_doubted = false;    ///< called invalid
  bool is_ambiguous = false;  ///< called ambiguous in its range rate
  std::optional<double> existence;
};

[[nodiscard]] Levels levels_of(const Counts& counts, const SensorVerdict& verdict, const Expected& expected,
                               bool has_tracks, const EvidenceConfig& config);

}  // namespace boresight::ghosts
