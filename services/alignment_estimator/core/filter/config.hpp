// Settings of Boresight's own estimator. No value depends on a recording: priors cover the possible vehicles and
// mountings, the other values are properties of the method.
#pragma once

namespace boresight::alignment {

struct FilterConfig {
  double min_speed_mps = 5.0;  ///< scans at lower speed are not used (Burza 2025, §8)

  // Standard deviations before any measurement.
  double prior_speed_scale_std = 0.03;
  double prior_rotation_std_rad = 0.0698;                    ///< 4° about each axis
  double prior_yaw_rate_bias_std_radps = 0.0035;             ///< 0.2°/s
  double prior_slip_coefficient_std_radps2pm = 0.006;        ///< c of V_y = −c·V·(V·ω)
  double prior_pitch_per_acceleration_std_radps2pm = 0.004;  ///< load transfer; not published
  double rotation_drift_rad_per_sqrt_s = 9e-7;               ///< random walk of a mounting, 0.003° in an hour
  double speed_scale_drift_per_sqrt_s = 1e-6;                ///< change of the tyres
  double yaw_rate_bias_drift_radps_per_sqrt_s = 1e-6;        ///< drift of the gyro
  double outlier_gate_sigma = 5.0;                           ///< Tukey's constant
  double prior_angle_noise_log_std = 0.7;  ///< of ln σ²: stated and configured σ are right within a factor of 1.4
  double azimuth_std_edge = 0.35;  ///< a configured azimuth σ holds straight ahead and grows as 1/max(cos α, this)

  // Errors of the motion, shared by all radars at an instant: start values of their on-line estimates. The σ stated by
  // the ego signals replaces the values for speed and yaw rate.
  double speed_std_mps = 0.03;
  double yaw_rate_std_radps = 0.002;
  double body_pitch_std_rad = 0.00436;
  double side_slip_std_rad = 3e-4;
  double ego_correlation_s = 0.02;
  double body_correlation_s = 0.3;
  double nuisance_memory_s = 120.0;  ///< time constant of those estimates

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
  double max_noise_scale = 3.3;    ///< σ of the residuals over the stated ones; choice

  // Inflation of a memory from an earlier drive: the car may have been repaired since.
  double memory_inflation = 4.0;
  double memory_rotation_std_rad = 0.0035;  ///< 0.2°
  double memory_speed_scale_std = 0.003;

  // Large step changes: limit of a radar's own deviation per block, and limit of the sum of the excess (CUSUM).
  double step_change_block_s = 0.5;
  double step_change_yaw_rad = 0.0087;    ///< 0.5°: half of the smallest step change looked for
  double step_change_pitch_rad = 0.0175;  ///< 1°
  double step_change_sum_blocks = 1.5;    ///< sum of the excess, in units of the limits above
  // Small step changes, with longer windows: limit of the own deviation in its σ, limit of the sum of the excess, and
  // the deviation in the next window that confirms a suspicion.
  double step_change_window_s = 2.0;
  double step_change_small_stds = 1.5;
  double step_change_small_sum_stds = 5.0;
  double step_change_small_confirm_stds = 2.5;
  double step_change_least_rad = 0.0035;  ///< 0.2°: smaller changes are followed without a report
};

}  // namespace boresight::alignment
