// One residual of a range rate: Tukey's weight, errors in variables, noise. Shared by the sums without and with a
// curve. Equations: docs/algorithms/alignment.md (A10)–(A12).
#pragma once

#include <cmath>

#include "services/alignment_estimator/core/filter/scan_sums.hpp"

namespace boresight::alignment {

/// E[w z²]/E[w] of a Gaussian residual z under Tukey's weight w.
[[nodiscard]] inline double weighted_square(double gate) {
  const double b = 1.0 / (gate * gate);
  return (1.0 - 6.0 * b + 15.0 * b * b) / (1.0 - 2.0 * b + 3.0 * b * b);
}

/// Tukey's weight w of a squared residual, and the derivative ψ′.
struct TukeyWeight {
  double t;  ///< squared residual over the squared gate, below 1
  double w = (1.0 - t) * (1.0 - t);
  double curvature = (1.0 - t) * (1.0 - 5.0 * t);
};

/// `z2`: the squared residual over its variance.
inline void count(const TukeyWeight& tukey, double z2, ScanSums& sums) {
  sums.inliers += 1.0;
  sums.weights += tukey.w;
  sums.curvature += tukey.curvature;
  sums.squares += tukey.w * tukey.w * z2;
  if (tukey.w > 0.2) sums.stationary += 1.0;
}

/// Derivatives of the range rate to azimuth (a) and elevation (b).
struct AngleDerivatives {
  double along;               ///< u·g
  double da, db;              ///< first
  double daa, dab;            ///< second; that to the elevation twice is −along
  double va = 0.0, ve = 0.0;  ///< variances of the angles
  double va_slope = 0.0;      ///< relative slope of the azimuth's std to the azimuth

  AngleDerivatives(double x, double y, double z, double across, double gx, double gy, double gz)
      : along(x * gx + y * gy + z * gz),
        da(x * gy - y * gx),
        db((-x * z * gx - y * z * gy) / across + across * gz),
        daa(-along + z * gz),
        dab(-(gy * x - gx * y) * z / across) {}
};

/// Errors in variables: the noise ε of the angles is in the residual and in the gradient, so E[ψ(e)·ε] = Cov(e,
/// ε)·E[ψ′] (Stein) is subtracted. Two more terms are subtracted here: variances are computed from noisy angles, and
/// the curvature of the range rate skews the residuals, so that the robust weight prefers one side. What is left
/// multiplies the gradient. `inverse`: of the residual's own variance.
[[nodiscard]] inline double pull_of(double e, const TukeyWeight& tukey, double inverse, double gate_variance,
                                    double inverse_gate_square, const AngleDerivatives& d) {
  const double s2a = 2.0 * (d.da * d.daa * d.va + d.da * d.da * d.va * d.va_slope + d.db * d.dab * d.ve);
  const double s2b = 2.0 * (d.da * d.dab * d.va - d.db * d.along * d.ve);
  const double ca = d.da * d.va, cb = d.db * d.ve, t = tukey.t;
  const double by_variance = (1.0 - 12.0 * t + 15.0 * t * t) * (s2a * ca + s2b * cb);
  const double by_skew =
      6.0 * inverse_gate_square * (1.0 - 5.0 * t) * (d.daa * ca * ca + 2.0 * d.dab * ca * cb - d.along * cb * cb);
  return -tukey.w * inverse * e - inverse / gate_variance * (by_variance + by_skew);
}

/// Scores and information of the two factors of the noise. `of_rate`, `of_angle`: shares of the gate's variance;
/// `mean_square`: weighted_square().
inline void add_noise(double w, double z2, double mean_square, double of_rate, double of_angle, ScanSums& sums) {
  const double excess = w * (z2 - mean_square);
  sums.noise_score_rate += excess * of_rate;
  sums.noise_score_angle += excess * of_angle;
  sums.noise_rate_rate += w * of_rate * of_rate;
  sums.noise_rate_angle += w * of_rate * of_angle;
  sums.noise_angle_angle += w * of_angle * of_angle;
}

}  // namespace boresight::alignment
