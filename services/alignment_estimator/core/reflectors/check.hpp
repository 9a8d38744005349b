// Requirements of both fits on the positions.
#pragma once

#include <utility>

#include "services/alignment_estimator/core/reflectors/reflectors.hpp"

namespace boresight::alignment::reflectors {

/// The first problem of the positions and its index.
[[nodiscard]] std::pair<Problem, std::size_t> check(std::span<const Position> positions, const RadarConfig& radar,
                                                    const Config& config);

/// Position of the radar.
[[nodiscard]] inline Eigen::Vector3d place_of(const RadarConfig& radar) {
  return Eigen::Vector3d(radar.mounting_pose.position_m.data());
}

/// Std of a median of `scans` values, over the std of one value.
[[nodiscard]] double median_factor(std::size_t scans);

}  // namespace boresight::alignment::reflectors
