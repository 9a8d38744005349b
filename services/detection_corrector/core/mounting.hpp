// The mounting of a radar as far as it is known: nominal, plus what the alignment estimate is sure of.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/detection_corrector/core/config.hpp"

namespace boresight::corrector {

struct Mounting {
  Eigen::Matrix3d sensor_to_vehicle;
  double speed_scale = 1.0;
  std::uint64_t alignment_sequence = 0;  ///< 0: nothing applied
};

/// The nominal mounting corrected by each axis of `estimate` (may be null) that is observable and sure enough.
[[nodiscard]] Mounting mounting_of(const RadarConfig& radar, const AlignmentEstimate* estimate, const Config& config);

}  // namespace boresight::corrector
