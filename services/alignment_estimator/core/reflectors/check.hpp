// What both fits ask of the positions.
#pragma once

#include <utility>

#include "services/alignment_estimator/core/reflectors/reflectors.hpp"

namespace boresight::alignment::reflectors {

/// The first problem of the positions and where it is.
[[nodiscard]] std::pair<Problem, std::size_t> check(std::span<const Position> positions, const RadarConfig& radar,
                                                    const Config& config);

/// Where the radar is.
[[nodiscard]] inline Eigen::Vector3d place_of(const RadarConfig& radar) {
  return Eigen::Vector3d(radar.mounting_pose.position_m.data());
}

/// Of a median of `scans` values, over that of one.
[[nodiscard]] double median_factor(std::size_t scans);

}  // namespace boresight::alignment::reflectors
