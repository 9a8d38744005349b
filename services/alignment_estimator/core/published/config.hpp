// Settings of the published alignment methods of Burza 2025, §8; the defaults of what it states are its constants.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace boresight::alignment::published {

/// Which estimator.
enum class Kind : std::uint8_t {
  kSteepestDescent,
  kLeastSquares,       ///< damped, nonlinear
  kTotalLeastSquares,  ///< nonlinear
  kNelderMead,
  kAzimuth1d,  ///< the reference: azimuth only, with k_v
};

/// Which model of the range rate.
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
  int nelder_mead_iterations = 1;           ///< a scan
  /// Not published and not to be derived, chosen here. Time constant of the temporal filter, in scans of one radar:
  /// with it the published set-up takes the published 6971 scans, within a tenth or two. Scans to 95 % are proportional
  /// to it.
  double nelder_mead_filter_scans = 70.0;
  /// Not published, chosen here. Edge of the simplex around the estimate that every scan starts with, about a third of
  /// the errors looked for; half of it lets pitch and roll take three times as long, twice of it doubles their noise.
  std::array<double, 4> nelder_mead_edge{0.004, 0.0087, 0.0087, 0.0087};

  /// Ours, not published: detections further from the median residual than this many median absolute deviations
  /// (scaled to stds) do not take part in a scan. Real scenes have movers and ghosts; the published simulation has
  /// none, and its figures are reproduced without the gate.
  bool gate = true;
  double gate_sigma = 3.0;
  double gate_floor_mps = 0.05;    ///< never narrower than this
  std::size_t min_detections = 8;  ///< fewer say nothing of what is usual in the scan

  /// Ours: the estimate is held within these, so that a step that diverges is seen and harms nothing.
  double max_speed_scale_error = 0.2;
  double max_angle_rad = 0.35;

  /// Ours, for the covariance and the state only.
  double prior_speed_scale_std = 0.03;
  double prior_angle_std_rad = 0.0698;   ///< 4°
  double window_s = 60.0;                ///< how long the covariance remembers a scan
  double converged_angle_rad = 0.00175;  ///< 0.1°
  double converged_speed_scale = 5e-4;

  std::uint64_t seed = 1;  ///< of the draw of detections (28)
};

}  // namespace boresight::alignment::published
