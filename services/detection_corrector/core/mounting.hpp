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

/// The nominal mounting turned by that part of the estimated rotation (`estimate` may be null) which is observable and
/// sure enough. The parts are the principal axes of its covariance about the vehicle's axes: of a radar that looks to
/// the side straight driving tells the pitch about the vehicle's axis and not the roll, so that neither pitch nor roll
/// about its own axes is known; a calibration plate tells the opposite.
[[nodiscard]] Mounting mounting_of(const RadarConfig& radar, const AlignmentEstimate* estimate, const Config& config);

}  // namespace boresight::corrector
