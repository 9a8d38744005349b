// Static calibration with corner reflectors at surveyed positions (the 4D chain design, §2.1): the published fit of a
// line, and the product's own fit of the whole rotation to the directions.
// Equations: docs/algorithms/reflectors.md (R1)–(R6).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "services/alignment_estimator/core/plate/seed.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::reflectors {

/// One reflector, where it stands and where the radar sees it.
struct Position {
  Eigen::Vector3d surveyed_m{0.0, 0.0, 0.0};  ///< vehicle frame
  double range_m = 0.0;                       ///< measured, sensor frame
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;  ///< not looked at without Config::has_elevation
  std::size_t scans = 1;       ///< that the measured values are the median of
};

struct Config {
  bool has_elevation = true;
  std::size_t min_positions = 10;  ///< the 4D chain design, §2.1
  double range_min_m = 5.0;
  double range_max_m = 50.0;
  double survey_std_m = 0.02;    ///< of a position, along x and along y
  double height_std_m = 0.01;    ///< of a position's height
  double mounting_std_m = 0.01;  ///< of the radar's own place along each axis: one error for all positions
  double range_gate_m = 1.0;     ///< another range than the surveyed by more than this is another reflector
  /// How crooked the radar may be before anything was measured, about its boresight axes; keeps the fit finite where
  /// the positions tell nothing of an axis.
  double prior_yaw_std_rad = 0.1745;    ///< 10°
  double prior_pitch_std_rad = 0.1745;  ///< 10°
  double prior_roll_std_rad = 0.0873;   ///< 5°
  double line_tolerance_m = 0.1;        ///< by which a position may stand beside the line
  double skew_tolerance_rad = 0.0873;   ///< 5°: by which the line may differ from the driving direction or its square
};

enum class Problem : std::uint8_t {
  kNone,
  kTooFewPositions,  ///< below Config::min_positions
  kNotFinite,        ///< a value is not a number
  kOutOfRange,       ///< a position is nearer or farther than allowed
  kOutOfView,        ///< a position is behind the radar as mounted
  kTooFewAgree,      ///< no more than half of the positions fit one rotation
  kNotALine,         ///< line only: a position stands beside the line of the others
  kLineTooShort,     ///< line only: the positions span less than 5 m
  kSkewLine,         ///< line only: neither along nor across the driving direction
};
[[nodiscard]] std::string_view explain(Problem problem);

/// The published fit: slope of the measured line against the surveyed one, elevations against height differences.
struct LineResult {
  Problem problem = Problem::kNone;
  std::size_t problem_position = 0;
  bool across = false;  ///< the line is square to the driving direction, else along it
  double yaw_rad = 0.0, yaw_std_rad = 0.0;
  double pitch_rad = 0.0, pitch_std_rad = 0.0;  ///< 0 ± 0 without elevation
  [[nodiscard]] bool ok() const { return problem == Problem::kNone; }
};

struct Result {
  Problem problem = Problem::kNone;
  std::size_t problem_position = 0;  ///< index of the position at fault, where one is
  RotationSeed rotation;             ///< d of R(actual) = Exp(d)·R(nominal), vehicle axes, with its covariance
  /// Alignment angles, actual − nominal, as everywhere: yaw + left, pitch + up, roll about boresight.
  double yaw_rad = 0.0, pitch_rad = 0.0, roll_rad = 0.0;
  double yaw_std_rad = 0.0, pitch_std_rad = 0.0, roll_std_rad = 0.0;
  /// Whether the positions tell of the axis: its std is below half of what it was before.
  bool pitch_observable = false, roll_observable = false;
  double noise_scale = 1.0;  ///< scatter of the residuals over what the stds let expect, at least 1
  std::vector<double> residual_azimuth_rad, residual_elevation_rad;  ///< measured − fitted, one a position
  std::vector<bool> used;
  std::size_t positions_used = 0;
  [[nodiscard]] bool ok() const { return problem == Problem::kNone; }
};

/// Directions: finds the rotation that turns the surveyed directions into the measured ones by robust (Tukey) iterated
/// least squares on SO(3). The positions need not be on a line. Stds of the radar are those of `radar.noise`.
[[nodiscard]] Result fit_directions(std::span<const Position> positions, const RadarConfig& radar,
                                    const Config& config);

/// As published; for a radar that looks along the line or squarely at it. Positions are taken as in fit_directions.
[[nodiscard]] LineResult fit_line(std::span<const Position> positions, const RadarConfig& radar, const Config& config);

}  // namespace boresight::alignment::reflectors
