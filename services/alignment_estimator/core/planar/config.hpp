// Settings of Boresight's filter with the planar roll model of Burza 2025, which only reproduces the published tables.
#pragma once

namespace boresight::alignment::planar {

struct PlanarConfig {
  double min_speed_mps = 5.0;  ///< scans at lower speed are not used (Burza 2025, §8)

  // Standard deviations before any measurement.
  double prior_speed_scale_std = 0.03;
  double prior_angle_std_rad = 0.0698;  ///< 4°, of α, β and γ each

  // Random walks. Burza's truth is constant, so these are smaller than for a real mounting.
  double angle_drift_rad_per_sqrt_s = 1e-7;
  double speed_scale_drift_per_sqrt_s = 5e-8;

  double outlier_gate_sigma = 5.0;  ///< Tukey's constant

  // Graduated start of a radar (graduated non-convexity).
  double start_seconds = 1.0;  ///< of scans in the window of the start
  int start_passes = 16;
  double start_scale_mps = 2.0;  ///< added σ of the first pass; times `start_shrink` each pass, none in the last three
  double start_shrink = 0.6;
  double start_inflation = 2.0;  ///< of the covariance of the start, which does not model errors of the motion

  // Convergence as published.
  double converged_yaw_std_rad = 0.00175;  ///< 0.1°
  double min_seconds_to_converge = 5.0;
};

}  // namespace boresight::alignment::planar
