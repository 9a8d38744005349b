// Settings of Boresight's own estimator. No value depends on a recording: priors cover the possible vehicles and
// mountings, the other values are properties of the method.
#pragma once

namespace boresight::alignment {

struct FilterConfig {
  double min_speed_mps = 5.0;  ///< scans at lower speed are not used (Burza 2025, §8)

  double outlier_gate_sigma = 5.0;         ///< Tukey's constant
  double prior_angle_noise_log_std = 0.7;  ///< of ln σ²: stated and configured σ are right within a factor of 1.4
  double azimuth_std_edge = 0.35;  ///< a configured azimuth σ holds straight ahead and grows as 1/max(cos α, this)

  // Errors of the motion, where the ego signals state none.
  double speed_std_mps = 0.03;
  double yaw_rate_std_radps = 0.002;

  // Graduated start of a radar (graduated non-convexity).
  double start_seconds = 0.5;     ///< of scans before the first pass
  double start_detections = 150;  ///< or longer, until this number is reached
  int start_passes = 12;
  double start_scale_mps = 2.0;  ///< σ of the first pass; times `start_shrink` each pass
  double start_shrink = 0.6;
  double start_inflation = 9.0;  ///< of the covariance of the start, which does not model errors of the motion

  // Convergence as published.
  double converged_yaw_std_rad = 0.00175;  ///< 0.1°
  double min_seconds_to_converge = 5.0;
  double min_inlier_share = 0.15;  ///< of stationary detections in recent scans; choice
  double inlier_memory_s = 10.0;   ///< over which they are counted; choice
  double max_noise_scale = 3.3;    ///< σ of the residuals over the stated ones; choice
};

}  // namespace boresight::alignment
