// Settings of the published alignment methods of Burza 2025, §8. The defaults are its constants where it states them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace boresight::alignment::published {

/// The estimator.
enum class Kind : std::uint8_t {
  kSteepestDescent,
  kLeastSquares,       ///< damped, nonlinear
  kTotalLeastSquares,  ///< nonlinear
  kNelderMead,
  kAzimuth1d,  ///< the reference: azimuth only, with k_v
};

/// The model of the range rate.
enum class RoadModel : std::uint8_t {
  kFull,               ///< (10)–(16)
  kStraightWhereSlow,  ///< (17)–(21) for scans with a yaw rate under the limit, else (10)–(16)
  kStraight,           ///< (17)–(21) always: the yaw rate is ignored
};

struct PublishedConfig {
  RoadModel road_model = RoadModel::kFull;
  double straight_yaw_rate_radps = 0.005;  ///< limit of RoadModel::kStraightWhereSlow
  double min_speed_mps = 5.0;              ///< Burza 2025, §8

  // In the order k_v, α, β, γ.
  std::array<double, 4> steepest_descent_rate{1e-6, 1e-3, 1e-2, 1e-2};  ///< η of (23)
  std::array<double, 4> least_squares_rate{1e-3, 1e-2, 1e-2, 1e-2};     ///< η of (25)
  double least_squares_damping = 10.0;                                  ///< λ of (24)
  double total_least_squares_rate = 2e-4;                               ///< η of (26)

  std::size_t nelder_mead_detections = 16;  ///< N_d of (28)
  int nelder_mead_iterations = 1;           ///< per scan
  /// Not published, chosen here. Time constant of the temporal filter, in scans of one radar: with it the published
  /// set-up takes the published 6971 scans within 10 to 20 %. The number of scans to 95 % is proportional to it.
  double nelder_mead_filter_scans = 70.0;
  /// Not published, chosen here. Edge of the initial simplex of every scan around the estimate, about a third of the
  /// expected errors. With half of it pitch and roll need three times as long, with twice of it their noise doubles.
  std::array<double, 4> nelder_mead_edge{0.004, 0.0087, 0.0087, 0.0087};

  /// Ours, not published: rejects detections further from the median residual than this many median absolute deviations
  /// (scaled to stds). Real scenes contain moving objects and ghosts; the published simulation has none, and its
  /// figures are reproduced without the gate.
  bool gate = true;
  double gate_sigma = 3.0;
  double gate_floor_mps = 0.05;    ///< smallest width of the gate
  std::size_t min_detections = 8;  ///< a scan with fewer detections is not used

  /// Ours: limits of the estimate, so that a divergent step is visible and harmless.
  double max_speed_scale_error = 0.2;
  double max_angle_rad = 0.35;

  /// Ours, for the covariance and the state only.
  double prior_speed_scale_std = 0.03;
  double prior_angle_std_rad = 0.0698;   ///< 4°
  double window_s = 60.0;                ///< time constant of the covariance
  double converged_angle_rad = 0.00175;  ///< 0.1°
  double converged_speed_scale = 5e-4;

  std::uint64_t seed = 1;  ///< of the drawn detections (28)
};

}  // namespace boresight::alignment::published
