// Whether the detections of a radar are proven not to be those of the scene around the vehicle.
#pragma once

#include "interfaces/messages/alignment_estimate.hpp"

namespace boresight::corrector {

/// True if the finding places the radar's detections wrongly. Findings about speed and yaw rate alone do not.
[[nodiscard]] inline bool places_detections_wrongly(AlignmentFinding finding) {
  switch (finding) {
    case AlignmentFinding::kRadarsSwapped:
    case AlignmentFinding::kOtherRadar:
    case AlignmentFinding::kNominalYawWrong:
    case AlignmentFinding::kAzimuthMirrored:
    case AlignmentFinding::kRangeRateMirrored:
    case AlignmentFinding::kAzimuthOrYawRate:  // whichever it is, the detections and the motion do not fit together
    case AlignmentFinding::kCopiedDetections:
      return true;
    case AlignmentFinding::kNone:
    case AlignmentFinding::kYawRateMirrored:
    case AlignmentFinding::kSpeedUnit:
    case AlignmentFinding::kYawRateUnit:
    case AlignmentFinding::kSpeedFrozen:
    case AlignmentFinding::kSpeedZero:
    case AlignmentFinding::kEgoMotionMissing:
      return false;
  }
  return false;
}

}  // namespace boresight::corrector
