// From detections to the information and the score of the planar model's parameters, corrected for the noise of the
// angles.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::planar {

/// Parameters of one detection: k_v, the error δω of the yaw-rate signal (signalled = true + δω), α_m, β_m, γ_m. An
/// error δV of the speed signal acts like an error of k_v, with the factor −k_v/V.
using Parameters = Eigen::Matrix<double, 5, 1>;
using Square = Eigen::Matrix<double, 5, 5>;
namespace parameter {
enum : Eigen::Index { kSpeedScale, kYawRateError, kAlpha, kBeta, kGamma };
}  // namespace parameter

/// Columns of `count` detections: angles (rad) and range rate (m/s), and their stds.
struct Rows {
  const double* azimuth_rad;
  const double* elevation_rad;
  const double* range_rate_mps;
  const double* azimuth_std_rad;
  const double* elevation_std_rad;
  const double* range_rate_std_mps;
  std::size_t count;
  double ambiguity_mps;  ///< 0: none
};

/// The radar and the signalled motion at the time of the scan.
struct Setting {
  const MountingPose& nominal;
  double speed_mps;
  double yaw_rate_radps;
};

/// Weights of the residuals.
struct Judgement {
  double gate = 5.0;                   ///< Tukey's constant
  double added_variance = 0.0;         ///< added to every residual, (m/s)²: what a start does not know yet
  Square covariance = Square::Zero();  ///< of the parameters: widens the gate only
};

/// Sums over the detections of one scan. With ψ Tukey's function of the residual in stds and s² the variance of a
/// residual, σ_ṙ² + (∂ṙ/∂α_n σ_α)² + (∂ṙ/∂β_n σ_β)².
struct Sums {
  Square information = Square::Zero();    ///< Σ g·gᵀ / s² of those within the gate
  Square from_noise = Square::Zero();     ///< expected part of it that comes from the noise of the angles in g
  Parameters score = Parameters::Zero();  ///< Σ ψ·g / s, corrected: zero in expectation at the truth
  double inliers = 0.0;                   ///< within the gate
  double stationary = 0.0;                ///< those of them with a weight above 0.2
  double slope = 0.0;                     ///< Σ ψ′
  double square = 0.0;                    ///< Σ ψ²
  // Of the measured elevations of those within the gate: sum, sum of squares, and sum of their noise's variances.
  double elevation = 0.0, elevation_square = 0.0, elevation_variance = 0.0;
};

/// Corrects for errors in variables. h is the model, (a, e) the measured angles (10)(11), C the covariance of their
/// noise ε. The residual measured − h has the mean −½·tr(C·∇²h) and the covariance −C·∇h with ε; ε is also in the
/// gradient g and in s². All three effects are removed from the score to second order in ε, with Stein's lemma
/// E[ψ(e)·ε] = Cov(e, ε)·E[ψ′].
[[nodiscard]] Sums sum_rows(const Rows& rows, const Setting& setting, const Parameters& at, const Judgement& judgement);

/// The model's range rate (m/s) and its gradient over the parameters at the measured angles, without any correction.
struct Row {
  double value_mps;
  Parameters gradient;
};
[[nodiscard]] Row row_of(const Setting& setting, const Parameters& at, double azimuth_rad, double elevation_rad);

}  // namespace boresight::alignment::planar
