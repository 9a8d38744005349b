// Settings of the detection corrector; the defaults equal config/services/detection_corrector.toml.
#pragma once

#include <array>

namespace boresight::corrector {

/// How the ratio of actual to stated range-rate noise is learnt.
struct StatedNoiseConfig {
  double prior_detections = 300.0;  ///< weight of the stated noise, in stationary detections
  double time_constant_s = 60.0;    ///< of forgetting the evidence
  double other_share = 0.1;         ///< of detections that are not of a stationary reflector
  double other_width_mps = 2.0;     ///< half of their range rates over ground are below it
  double least_scale = 0.2;         ///< limits of actual / stated std
  double most_scale = 5.0;
  /// Nothing is learnt at lower speeds: in a standing vehicle the same reflectors repeat the same errors.
  double least_speed_mps = 1.0;
};

struct Config {
  /// Box in the vehicle frame; detections outside get a flag.
  std::array<double, 3> region_min_m{-100.0, -60.0, -2.0};
  std::array<double, 3> region_max_m{200.0, 60.0, 6.0};
  /// A detection at `range` is weak below rcs_near_dbsm + rcs_slope_db_per_decade · log10(range / 10 m): a near
  /// detection needs more RCS, since multipath and noise are near (the 4D chain design).
  double rcs_near_dbsm = -100.0;
  double rcs_slope_db_per_decade = 0.0;
  /// Moving if |range rate over ground| exceeds this many stds of that of a stationary reflector.
  double moving_sigma = 4.0;
  /// Range-rate error that no input's std contains: heave, pitch and roll of the body, and age of the ego motion.
  double body_motion_std_mps = 0.06;
  /// An azimuth std that the sensor does not state grows as 1/max(cos azimuth, this): an antenna's aperture shrinks
  /// with the cosine. The same as in the alignment estimator.
  double azimuth_std_edge = 0.35;
  /// An angle of the estimate is applied if its std is smaller.
  double max_angle_std_to_apply_rad = 0.00873;  // 0.5°
  double max_speed_scale_std_to_apply = 0.02;
  /// Standard deviations of mounting, speed signal and motion without an estimate.
  double unknown_rotation_std_rad = 0.01745;  // 1°
  double unknown_speed_scale_std = 0.01;
  double unknown_yaw_rate_bias_std_radps = 0.0035;  // 0.2°/s
  double unknown_slip_std_radps2pm = 0.003;         // of the rear axle, rad per m/s²
  double alignment_max_age_s = 2.0;
  double ego_max_age_s = 0.2;
  StatedNoiseConfig stated_noise;
};

}  // namespace boresight::corrector
