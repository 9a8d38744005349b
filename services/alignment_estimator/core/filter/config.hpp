// Settings of Boresight's own estimator. No value depends on a recording: priors are what vehicles and mountings can
// be, the rest are properties of the method.
#pragma once

namespace boresight::alignment {

struct FilterConfig {
  double min_speed_mps = 5.0;  ///< slower driving tells nothing (Burza 2025, §8)

  // How wrong everything may be before anything was measured (1 σ).
  double prior_speed_scale_std = 0.03;
  double prior_rotation_std_rad = 0.0698;                    ///< 4° about each axis
  double prior_yaw_rate_bias_std_radps = 0.0035;             ///< 0.2°/s
  double prior_slip_coefficient_std_radps2pm = 0.006;        ///< c of V_y = −c·V·(V·ω)
  double prior_pitch_per_acceleration_std_radps2pm = 0.004;  ///< load transfer; not published
  double rotation_drift_rad_per_sqrt_s = 9e-7;               ///< random walk of a mounting, 0.003° in an hour
  double speed_scale_drift_per_sqrt_s = 1e-6;                ///< tyres
  double yaw_rate_bias_drift_radps_per_sqrt_s = 1e-6;        ///< gyro
  double outlier_gate_sigma = 5.0;                           ///< Tukey's constant
  double prior_angle_noise_log_std = 0.7;  ///< of ln σ²: stated or configured σ is right to a factor of 1.4
  double azimuth_std_edge = 0.35;  ///< a configured azimuth σ holds ahead and grows as 1/max(cos α, this); 1: does not

  // Errors of the motion that all radars share at an instant: where their on-line estimates begin. σ of the ego signals
  // begins at what these state, or at these where they state none.
  double speed_std_mps = 0.03;
  double yaw_rate_std_radps = 0.002;
  double body_pitch_std_rad = 0.00436;
  double side_slip_std_rad = 3e-4;
  double ego_correlation_s = 0.02;
  double body_correlation_s = 0.3;
  double nuisance_memory_s = 120.0;  ///< time constant of those estimates

  // Graduated start of a radar (graduated non-convexity).
  double start_seconds = 0.5;     ///< of scans before the first pass
  double start_detections = 150;  ///< or longer, until there are as many
  int start_passes = 12;
  double start_scale_mps = 2.0;  ///< σ of the first pass; times `start_shrink` each pass
  double start_shrink = 0.6;
  double start_inflation = 9.0;  ///< of the start's covariance: errors of the motion are not modelled there

  // Convergence as published.
  double converged_yaw_std_rad = 0.00175;  ///< 0.1°
  double min_seconds_to_converge = 5.0;

  // What is remembered is believed with more doubt: the car may have been worked on.
  double memory_inflation = 4.0;
  double memory_rotation_std_rad = 0.0035;  ///< 0.2°
  double memory_speed_scale_std = 0.003;

  // Knocks: what the radar's own deviation in blocks must exceed, and the sum of its excess (CUSUM).
  double step_change_block_s = 0.5;
  double step_change_yaw_rad = 0.0087;    ///< 0.5°: half of the smallest step to be told
  double step_change_pitch_rad = 0.0175;  ///< 1°
  double step_change_sum_blocks = 1.5;    ///< of excess in units of the above
  // Smaller ones, more slowly: what the own deviation of a window must exceed in its own σ, the sum of its excess, and
  // what the window after a suspicion must show.
  double step_change_window_s = 2.0;
  double step_change_small_stds = 1.5;
  double step_change_small_sum_stds = 5.0;
  double step_change_small_confirm_stds = 2.5;
  double step_change_least_rad = 0.0035;  ///< 0.2°: what is smaller is followed, but not told
};

}  // namespace boresight::alignment
