// What is known of the parameters before any data.
#pragma once

#include <array>

#include "services/alignment_estimator/core/windows/columns.hpp"

namespace boresight::alignment::windows {

/// Standard deviations; 0: the parameter is not estimated.
struct Priors {
  double speed_scale_std = 0.03;
  double rate_scale_std = 0.003;
  double rotation_std_rad = 0.0698;
  double turned_std_rad = 0.0175;  ///< of pitch and yaw after a sudden misalignment, as the blocks showed it
  double yaw_rate_bias_std_radps = 0.00175;
  double yaw_rate_gain_std = 0.03;
  double slip_std_radps2pm = 0.006;
  double pitch_per_acceleration_std_radps2pm = 0.006;
  double common_stamp_std_s = 0.05;
  double stamp_std_s = 0.02;
  double position_std_m = 0.03;
  double curve_std_rad = 0.00262;
  double curve_length_rad = 0.262;
  double height_excess_std = 0.2;
  double mirror_share_std = 1.0;
  double mirror_share_tolerance = 0.15;  ///< the share differs with range and road: it is not known better than this
  double load_std_rad = 0.0105;
  // Fluctuations: medians of their standard deviations, and the standard deviation of the logarithm.
  std::array<double, kFluctuations> own_std{5e-4, 9e-4, 5e-4};
  std::array<double, kFluctuations> common_std{1.4e-3, 1.7e-3, 3e-4};
  double log_fluctuation_std = 1.0;
  double common_correlation_s = 20.0;  ///< median of their correlation times
  double log_correlation_std = 0.7;
  // Drift of a mounting over the last `drift_span_s`: median of the standard deviation of its rate.
  double drift_std_radps = 9e-7;  // 0.003 deg/min
  double drift_span_s = 180.0;
};

}  // namespace boresight::alignment::windows
