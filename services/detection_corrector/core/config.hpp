// Settings of the detection corrector; the defaults are what config/services/detection_corrector.toml ships.
#pragma once

#include <array>

namespace boresight::corrector {

struct Config {
  /// Box in the vehicle frame; detections outside are flagged.
  std::array<double, 3> region_min_m{-100.0, -60.0, -2.0};
  std::array<double, 3> region_max_m{200.0, 60.0, 6.0};
  /// A detection at `range` is weak below rcs_near_dbsm + rcs_slope_db_per_decade · log10(range / 10 m): what is near
  /// must reflect more to be real than what is far, since multipath and noise are near (Report D).
  double rcs_near_dbsm = -25.0;
  double rcs_slope_db_per_decade = 0.0;
  /// Moving if |range rate over ground| exceeds base + per_speed · |v| + sigma · std of the prediction.
  double moving_base_mps = 0.25;
  double moving_per_speed = 0.01;
  double moving_sigma = 3.0;
  /// An angle of the estimate is applied once its std is below this.
  double max_angle_std_to_apply_rad = 0.00873;  // 0.5°
  double max_speed_scale_std_to_apply = 0.02;
  double alignment_max_age_s = 2.0;
  double ego_max_age_s = 0.2;
};

}  // namespace boresight::corrector
