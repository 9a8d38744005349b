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

/// One reflector: its surveyed position and its position measured by the radar.
struct Position {
  Eigen::Vector3d surveyed_m{0.0, 0.0, 0.0};  ///< vehicle frame
  double range_m = 0.0;                       ///< measured, sensor frame
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;  ///< ignored without Config::has_elevation
  std::size_t scans = 1;       ///< number of scans; the measured values are their medians
};

struct Config {
  bool has_elevation = true;
  std::size_t min_positions = 10;  ///< the 4D chain design, §2.1
  double range_min_m = 5.0;
  double range_max_m = 50.0;
  double survey_std_m = 0.02;    ///< of a position, along x and along y
  double height_std_m = 0.01;    ///< of a position's height
  double mounting_std_m = 0.01;  ///< of the radar's own position along each axis: one error for all reflectors
  double range_gate_m = 1.0;     ///< a larger deviation from the surveyed range means another reflector
  /// Stds of the mounting error before any measurement, about the boresight axes. They keep the fit finite if the
  /// positions do not determine an axis.
  double prior_yaw_std_rad = 0.1745;    ///< 10°
  double prior_pitch_std_rad = 0.1745;  ///< 10°
  double prior_roll_std_rad = 0.0873;   ///< 5°
  double line_tolerance_m = 0.1;        ///< largest distance of a position from the line
  double skew_tolerance_rad =
      0.0873;  ///< 5°: largest angle between the line and the driving direction, or its perpendicular
};

enum class Problem : std::uint8_t {
  kNone,
  kTooFewPositions,  ///< below Config::min_positions
  kNotFinite,        ///< a value is not a number
  kOutOfRange,       ///< a position is nearer or farther than allowed
  kOutOfView,        ///< a position is behind the nominally mounted radar
  kTooFewAgree,      ///< no more than half of the positions fit one rotation
  kNotALine,         ///< line only: a position is not on the line of the others
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
  std::size_t problem_position = 0;  ///< index of the position at fault, if any
  RotationSeed rotation;             ///< d of R(actual) = Exp(d)·R(nominal), vehicle axes, with its covariance
  /// Alignment angles, actual − nominal: yaw + left, pitch + up, roll about boresight.
  double yaw_rad = 0.0, pitch_rad = 0.0, roll_rad = 0.0;
  double yaw_std_rad = 0.0, pitch_std_rad = 0.0, roll_std_rad = 0.0;
  /// Whether the positions determine the axis: its std is below half of the prior.
  bool pitch_observable = false, roll_observable = false;
  double noise_scale = 1.0;  ///< scatter of the residuals over the expected one, at least 1
  std::vector<double> residual_azimuth_rad, residual_elevation_rad;  ///< measured − fitted, one per position
  std::vector<bool> used;
  std::size_t positions_used = 0;
  [[nodiscard]] bool ok() const { return problem == Problem::kNone; }
};

/// Fit of directions: the rotation that turns the surveyed directions into the measured ones, by robust (Tukey)
/// iterated least squares on SO(3). The positions need not be on a line. The radar's stds are those of `radar.noise`.
[[nodiscard]] Result fit_directions(std::span<const Position> positions, const RadarConfig& radar,
                                    const Config& config);

/// Fit of a line, as published; for a radar that looks along the line or squarely at it. Positions as in
/// fit_directions.
[[nodiscard]] LineResult fit_line(std::span<const Position> positions, const RadarConfig& radar, const Config& config);

}  // namespace boresight::alignment::reflectors
