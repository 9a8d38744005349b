// What a mounting error does to users of the detections: displacement, lost coverage, lost range, wrong velocities.
// Equations: docs/algorithms/downstream.md (D1)(D5)–(D8). Angles in rad.
#pragma once

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::health {

/// What a radar sees when it is mounted as intended.
struct Sight {
  MountingPose mounting_pose;
  FieldOfView field_of_view;  ///< a turn changes no range, so range_max_m does not matter
  AntennaLobe antenna;
  RegionOfInterest region_of_interest;
};

/// Losses by a turned radar; 0 without a mounting error.
struct SightLoss {
  double coverage_ratio = 0.0;  ///< 0 … 1, of the solid angle of the region of interest in the nominal field of view
  double range_ratio = 0.0;     ///< below 1; negative if the region's middle is now nearer to boresight
};

/// Lateral displacement (m, positive to the left) of a detection at `range_m` that is not corrected (D1).
[[nodiscard]] double lateral_displacement_m(double range_m, double yaw_error_rad);

/// Loss of sight if R(sensor→vehicle) is `actual` instead of the nominal mounting (D5)(D6)(D7). A region without a
/// direction in the nominal field of view loses nothing.
[[nodiscard]] SightLoss sight_loss(const Sight& sight, const Eigen::Matrix3d& actual);

/// Size (m/s) of the error of the velocity over ground of a stationary object, at `speed_mps` of the vehicle (D8).
[[nodiscard]] double velocity_error_mps(double speed_mps, double yaw_error_rad);

/// R(sensor→vehicle) by an estimate: by its sensor form or its vehicle form, whichever has more observable axes. An
/// axis that is not observable counts as nominal.
[[nodiscard]] Eigen::Matrix3d actual_mounting(const MountingPose& nominal, const AlignmentEstimate& estimate);

}  // namespace boresight::health
