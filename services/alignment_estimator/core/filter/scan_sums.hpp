// Measurement of the sensor's velocity in its own frame by one scan. The range rate of a stationary reflector is −u·g
// with g = Rᵀv, so all parameters act through the three components of g. A scan is summed into a 3 × 3 information and
// a score, whatever the number of parameters. Equations: docs/algorithms/alignment.md (A4)–(A12).
#pragma once

#include <Eigen/Core>

#include "services/alignment_estimator/core/filter/sightings.hpp"

namespace boresight::alignment {

/// A contiguous range of sightings inside their columns.
struct SightingRun {
  const double* x;
  const double* y;
  const double* z;
  const double* range_rate_mps;
  const double* azimuth_variance;
  const double* elevation_variance;
  const double* range_rate_variance;
  const double* azimuth_std_slope;
  const double* lowering;
  const double* lowering_variance;
  const double* mean_sine;
  std::size_t count;
  double ambiguity_mps;
};
[[nodiscard]] SightingRun run_of(const Sightings& sightings);

/// Weights and scales of the residuals.
struct Judgement {
  double gate = 5.0;                  ///< Tukey's constant
  double min_std_mps = 0.0;           ///< residual σ of the gate is at least this (graduated start)
  double range_rate_scale = 1.0;      ///< factors of the variances
  double angle_scale = 1.0;           //
  Eigen::Matrix3d velocity_variance;  ///< of g as predicted, widens the gate
};

struct ScanSums {
  Eigen::Matrix3d information;  ///< Σ W u uᵀ, W Tukey's weight over the residual's variance; with the angles' noise
  Eigen::Matrix3d from_noise;   ///< the part of it that comes from the angles' noise only
  Eigen::Vector3d score;        ///< of g, corrected for errors in variables: zero mean at the true g
  double weights = 0.0, curvature = 0.0;  ///< Σ w and Σ ψ′
  double squares = 0.0;                   ///< Σ ψ² of normalised residuals
  double inliers = 0.0;                   ///< residuals in the gate
  double near = 0.0;                      ///< residuals beyond the gate, but within three times of it
  double stationary = 0.0;                ///< residuals with weights over 0.2
  /// Σ W (u·g)²; the same times the reduction of range rates by unknown elevations; the same times their mean sine.
  double along = 0.0, lowered = 0.0, raised = 0.0;
  // Scores and Fisher information of the logarithms of the two variance factors.
  double noise_score_rate = 0.0, noise_score_angle = 0.0;
  double noise_rate_rate = 0.0, noise_rate_angle = 0.0, noise_angle_angle = 0.0;
};

/// Residuals at g, the velocity of the sensor in its own frame (m/s). No allocation.
[[nodiscard]] ScanSums sum_scan(const SightingRun& run, const Eigen::Vector3d& g, const Judgement& judgement);

}  // namespace boresight::alignment
