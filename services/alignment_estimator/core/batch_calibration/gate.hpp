// Which detections of a recording stand still: RadarScenes says so of each, other recordings do not.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "services/alignment_estimator/core/batch_calibration/batch_calibration.hpp"

namespace boresight::alignment::batch_calibration {

/// The recordings with what can be used: finite, fast enough and, if the gate is on, near what a robust fit of k_v and
/// of each radar's yaw expects of a world that stands still (Tukey weights, joint over radars; missing elevation 0).
/// Same radars in the same order; a radar with fewer than `config.min_detections` comes out empty.
/// `progress` hears the share that is done.
[[nodiscard]] std::vector<Recording> gated(std::span<const Recording> radars, const Config& config,
                                           const std::function<void(double)>& progress = {});

}  // namespace boresight::alignment::batch_calibration
