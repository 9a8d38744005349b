// What of a post-factum calibration is measured and what is made up.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/alignment_estimator/core/batch_calibration/batch_calibration.hpp"

namespace boresight::alignment::batch_calibration {

/// How to make up missing elevations otherwise than published.
struct Alternative {
  double shift_rad = 0.0;  ///< of the mean
  double tilt = 0.0;       ///< rad per rad of azimuth beside the middle of the radar's azimuths
  double width = 1.0;      ///< times as wide
};

/// Draws the missing elevations of a radar's detections: uniform (29). The same seed draws the same numbers for every
/// alternative.
void fill_in(Recording& radar, const Config& config, std::uint64_t seed, const Alternative& alternative = {});

/// Judges the parameters `found` (k_v, then α, β, γ of each radar): solves the least-squares problem to the end with
/// other draws of the missing elevations, with alternatives to how they are made up, and with rolls held beside their
/// estimates. Over at most `config.judgement_detections` detections of each radar, spread evenly; the std is that of
/// all. Empty radars are kNoData. `progress` hears the share that is done.
[[nodiscard]] std::vector<Parameter> judge(std::span<const Recording> radars, const Eigen::VectorXd& found,
                                           const Config& config, const std::function<void(double)>& progress = {});

}  // namespace boresight::alignment::batch_calibration
