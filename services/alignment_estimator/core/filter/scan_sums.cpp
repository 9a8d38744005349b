#include "services/alignment_estimator/core/filter/scan_sums.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::alignment {

namespace {

/// Six sums of a symmetric matrix.
struct Symmetric {
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  void add(double w, double x, double y, double z) {
    const double wx = w * x, wy = w * y;
    xx += wx * x;
    xy += wx * y;
    xz += wx * z;
    yy += wy * y;
    yz += wy * z;
    zz += w * z * z;
  }
  [[nodiscard]] Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
  }
};

/// E[w z²]/E[w] of a Gaussian residual z under Tukey's weight w: the reference for z² in the noise scale.
double weighted_square(double gate) {
  const double b = 1.0 / (gate * gate);
  return (1.0 - 6.0 * b + 15.0 * b * b) / (1.0 - 2.0 * b + 3.0 * b * b);
}

}  // namespace

SightingRun run_of(const Sightings& s) {
  return {s.x.data(),
          s.y.data(),
          s.z.data(),
          s.range_rate_mps.data(),
          s.azimuth_variance.data(),
          s.elevation_variance.data(),
          s.range_rate_variance.data(),
          s.azimuth_std_slope.data(),
          s.lowering.data(),
          s.lowering_variance.data(),
          s.mean_sine.data(),
          s.count,
          s.ambiguity_mps};
}

ScanSums sum_scan(const SightingRun& run, const Eigen::Vector3d& velocity, const Judgement& judgement) {
  const double gx = velocity.x(), gy = velocity.y(), gz = velocity.z();
  const Eigen::Matrix3d& c = judgement.velocity_variance;
  const double cxx = c(0, 0), cyy = c(1, 1), czz = c(2, 2);
  const double cxy = 2.0 * c(0, 1), cxz = 2.0 * c(0, 2), cyz = 2.0 * c(1, 2);
  const double min_variance = judgement.min_std_mps * judgement.min_std_mps;
  const double inverse_gate_square = 1.0 / (judgement.gate * judgement.gate);
  const double mean_square = weighted_square(judgement.gate);
  const double ambiguity = run.ambiguity_mps, inverse_ambiguity = ambiguity > 0.0 ? 1.0 / ambiguity : 0.0;
  Symmetric information, from_noise;
  double sx = 0.0, sy = 0.0, sz = 0.0;
  ScanSums sums;
  for (std::size_t i = 0; i < run.count; ++i) {
    const double x = run.x[i], y = run.y[i], z = run.z[i];
    const double along = x * gx + y * gy + z * gz;
    double e = run.range_rate_mps[i] + along;
    // Unfolds to the multiple of the unambiguous interval nearest to the prediction.
    if (ambiguity > 0.0) e -= ambiguity * std::nearbyint(e * inverse_ambiguity);
    // Derivatives of the line of sight to azimuth (−y, x, 0) and elevation, and of the range rate.
    const double ce = std::sqrt(x * x + y * y), tx = -x * z / ce, ty = -y * z / ce;
    const double da = x * gy - y * gx, db = tx * gx + ty * gy + ce * gz;
    const double va = judgement.angle_scale * run.azimuth_variance[i];
    const double ve = judgement.angle_scale * run.elevation_variance[i];
    const double by_rate =
        judgement.range_rate_scale * run.range_rate_variance[i] + run.lowering_variance[i] * along * along;
    const double by_angle = va * da * da + ve * db * db;
    const double s2 = by_rate + by_angle;
    const double predicted = cxx * x * x + cyy * y * y + czz * z * z + cxy * x * y + cxz * x * z + cyz * y * z;
    const double gate_variance = std::max(s2 + predicted, min_variance);
    const double z2 = e * e / gate_variance, t = z2 * inverse_gate_square;
    if (t >= 1.0) {
      if (t < 9.0) sums.near += 1.0;
      continue;
    }
    const double q = 1.0 - t, w = q * q, curvature = q * (1.0 - 5.0 * t);
    sums.inliers += 1.0;
    sums.weights += w;
    sums.curvature += curvature;
    sums.squares += w * w * z2;
    if (w > 0.2) sums.stationary += 1.0;
    const double inverse = 1.0 / s2, weight = w * inverse, slope = curvature * inverse;
    information.add(weight, x, y, z);
    sums.along += weight * along * along;
    sums.lowered += weight * along * along * run.lowering[i];
    sums.raised += weight * along * along * run.mean_sine[i];
    from_noise.add(weight * va, -y, x, 0.0);
    from_noise.add(weight * ve, tx, ty, ce);
    // Errors in variables: the noise ε of the angles is in the residual and in the gradient, so E[ψ(e)·ε] =
    // Cov(e, ε)·E[ψ′] (Stein) is subtracted. Two more terms are subtracted: variances are computed from noisy angles
    // (s2a, s2b are their derivatives), and the curvature of the range rate skews the residuals, so that the robust
    // weight prefers one side.
    const double daa = -along + z * gz, dab = -(gy * x - gx * y) * z / ce;
    const double s2a = 2.0 * (da * daa * va + da * da * va * run.azimuth_std_slope[i] + db * dab * ve);
    const double s2b = 2.0 * (da * dab * va - db * along * ve);
    const double ca = da * va, cb = db * ve;
    const double by_variance = (1.0 - 12.0 * t + 15.0 * t * t) * (s2a * ca + s2b * cb);
    const double by_skew =
        6.0 * inverse_gate_square * (1.0 - 5.0 * t) * (daa * ca * ca + 2.0 * dab * ca * cb - along * cb * cb);
    const double pull = -weight * e - inverse / gate_variance * (by_variance + by_skew);
    const double ka = slope * va * da, kb = slope * ve * db;
    sx += pull * x - ka * y + kb * tx;
    sy += pull * y + ka * x + kb * ty;
    sz += pull * z + kb * ce;
    const double share = 1.0 / gate_variance, of_rate = by_rate * share, of_angle = by_angle * share;
    const double excess = w * (z2 - mean_square);
    sums.noise_score_rate += excess * of_rate;
    sums.noise_score_angle += excess * of_angle;
    sums.noise_rate_rate += w * of_rate * of_rate;
    sums.noise_rate_angle += w * of_rate * of_angle;
    sums.noise_angle_angle += w * of_angle * of_angle;
  }
  sums.information = information.matrix();
  sums.from_noise = from_noise.matrix();
  sums.score = {sx, sy, sz};
  return sums;
}

}  // namespace boresight::alignment
