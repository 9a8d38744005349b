// Finds the stationary detections of a recording: RadarScenes labels them, other recordings do not.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "services/alignment_estimator/core/batch_calibration/batch_calibration.hpp"

namespace boresight::alignment::batch_calibration {

/// Returns the usable detections: finite, fast enough and, if the gate is on, close to the range rate of a stationary
/// reflector under a robust fit of k_v and each radar's yaw (Tukey weights, joint over radars; missing elevation 0).
/// Same radars in the same order; a radar with fewer than `config.min_detections` becomes empty.
/// `progress` receives the completed share.
[[nodiscard]] std::vector<Recording> gated(std::span<const Recording> radars, const Config& config,
                                           const std::function<void(double)>& progress = {});

}  // namespace boresight::alignment::batch_calibration
