// Which results of a batch calibration the data support, and which follow from the assumed elevations.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/alignment_estimator/core/batch_calibration/batch_calibration.hpp"

namespace boresight::alignment::batch_calibration {

/// Assumptions about missing elevations other than the published one.
struct Alternative {
  double shift_rad = 0.0;  ///< shift of the mean
  double tilt = 0.0;       ///< rad per rad of azimuth, from the middle of the radar's azimuths
  double width = 1.0;      ///< factor of the width
};

/// Draws the missing elevations of a radar's detections: uniform (29). The same seed draws the same numbers for every
/// alternative.
void fill_in(Recording& radar, const Config& config, std::uint64_t seed, const Alternative& alternative = {});

/// Judges the parameters `found` (k_v, then α, β, γ of each radar). Solves the least-squares problem completely with
/// other draws of the missing elevations, with the alternatives above, and with rolls fixed beside their estimates.
/// Uses at most `config.judgement_detections` detections per radar, spread evenly; the std is that of all detections.
/// Radars without data are kNoData. `progress` receives the completed share.
[[nodiscard]] std::vector<Parameter> judge(std::span<const Recording> radars, const Eigen::VectorXd& found,
                                           const Config& config, const std::function<void(double)>& progress = {});

}  // namespace boresight::alignment::batch_calibration
