// What is tracked, and the own vehicle, as objects at the time of a scan.
#pragma once

#include <cstdint>
#include <optional>

#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/common/geometry/ego_step.hpp"
#include "services/ghost_filter/core/classify/config.hpp"
#include "services/ghost_filter/core/classify/object.hpp"

namespace boresight::ghosts {

/// What the ghost filter has learnt of a track, scan after scan.
struct TrackBelief {
  std::uint32_t tracking_id = 0;
  double log_odds = 0.0;  ///< that it is the image of something else
  std::uint32_t judgements = 0;
  double rcs_dbsm = kUsualRcs_dbsm, rcs_std_db = kUsualRcsStd_db;  ///< of its parts, as far as they were heard
  double mirrors = 0.0;                                            ///< log-odds gained, that its faces do
};

/// The track `elapsed_s` later, in the vehicle frame after that `step`; nothing if it is not told where it is.
[[nodiscard]] std::optional<Object> predicted(const Track& track, const TrackBelief& belief, double elapsed_s,
                                              const geometry::EgoStep& step, double tentative_weight);

[[nodiscard]] Object own_vehicle(const ClassConfig& config, const ScanGeometry& geometry);

}  // namespace boresight::ghosts
