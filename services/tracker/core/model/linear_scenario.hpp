// A planar world with a linear measurement model: the simulated scenarios of the literature on extended-object tracking
// (Granström et al. 2015, Xia et al. 2019), without a radar.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace boresight::tracking {

/// One place where objects appear: a component of the Poisson birth intensity.
struct ScenarioBirth {
  Eigen::Vector4d mean{Eigen::Vector4d::Zero()};              ///< x, y in m; v_x, v_y in m/s
  Eigen::Vector4d std{Eigen::Vector4d::Ones()};               ///< of mean
  Eigen::Matrix2d extent_scale{Eigen::Matrix2d::Identity()};  ///< V of the inverse Wishart, m²
  double extent_dof = 20.0;                                   ///< v of the inverse Wishart; E[X] = V / (v − 6)
  double rate_shape = 16.0, rate_inverse_scale = 2.0;         ///< gamma of the number of detections a scan
};

struct LinearScenario {
  double survival_probability = 0.99;  ///< for each step
  double step_s = 1.0;                 ///< time between scans
  double acceleration_density = 1.0;   ///< q of white acceleration, m²/s³
  double rate_forgetting = 1.1;        ///< η: α and β of the gamma are divided by it each step
  double extent_memory_s = 5.0;        ///< τ: v − 6 and V decay by exp(−step/τ)
  double detection_probability = 0.9;
  double spread = 0.25;  ///< detections ~ N(centre, spread · X + noise)
  double noise_variance_m2 = 0.0;
  double range_rate_std_mps = 0.0;           ///< 0: no range rates; else seen from the origin
  double clutter_per_scan = 10.0;            ///< Poisson, uniform over the area
  double clutter_range_rate_span_mps = 1.0;  ///< range rates of clutter are uniform over this span
  Eigen::Vector2d area_min_m{-100.0, -100.0}, area_max_m{100.0, 100.0};
  double birth_weight = 0.02;  ///< expected births for each component and step
  std::vector<ScenarioBirth> births;
  double confirmed_existence = 0.5;  ///< from here on a track is confirmed (choice: likelier than not)
  double speed_sigma = 3.0;          ///< deviations of the velocity of births that its limit includes (choice)
  double link_sigma = 4.0;           ///< detections of one new object deviate less from each other (choice)
};

}  // namespace boresight::tracking
