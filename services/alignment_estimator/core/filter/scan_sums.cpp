#include "services/alignment_estimator/core/filter/scan_sums.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/filter/residual.hpp"

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
    const double ce = std::sqrt(x * x + y * y), tx = -x * z / ce, ty = -y * z / ce;
    AngleDerivatives d(x, y, z, ce, gx, gy, gz);
    d.va = judgement.angle_scale * run.azimuth_variance[i];
    d.ve = judgement.angle_scale * run.elevation_variance[i];
    d.va_slope = run.azimuth_std_slope[i];
    double e = run.range_rate_mps[i] + d.along;
    // Unfolds to the multiple of the unambiguous interval nearest to the prediction.
    if (ambiguity > 0.0) e -= ambiguity * std::nearbyint(e * inverse_ambiguity);
    const double by_rate =
        judgement.range_rate_scale * run.range_rate_variance[i] + run.lowering_variance[i] * d.along * d.along;
    const double by_angle = d.va * d.da * d.da + d.ve * d.db * d.db;
    const double s2 = by_rate + by_angle;
    const double predicted = cxx * x * x + cyy * y * y + czz * z * z + cxy * x * y + cxz * x * z + cyz * y * z;
    const double gate_variance = std::max(s2 + predicted, min_variance);
    const double z2 = e * e / gate_variance;
    const TukeyWeight tukey{z2 * inverse_gate_square};
    if (tukey.t >= 1.0) {
      if (tukey.t < 9.0) sums.near += 1.0;
      continue;
    }
    count(tukey, z2, sums);
    const double inverse = 1.0 / s2, weight = tukey.w * inverse, slope = tukey.curvature * inverse;
    information.add(weight, x, y, z);
    sums.along += weight * d.along * d.along;
    sums.lowered += weight * d.along * d.along * run.lowering[i];
    sums.raised += weight * d.along * d.along * run.mean_sine[i];
    from_noise.add(weight * d.va, -y, x, 0.0);
    from_noise.add(weight * d.ve, tx, ty, ce);
    const double pull = pull_of(e, tukey, inverse, gate_variance, inverse_gate_square, d);
    const double ka = slope * d.va * d.da, kb = slope * d.ve * d.db;
    sx += pull * x - ka * y + kb * tx;
    sy += pull * y + ka * x + kb * ty;
    sz += pull * z + kb * ce;
    add_noise(tukey.w, z2, mean_square, by_rate / gate_variance, by_angle / gate_variance, sums);
  }
  sums.information = information.matrix();
  sums.from_noise = from_noise.matrix();
  sums.score = {sx, sy, sz};
  return sums;
}

}  // namespace boresight::alignment
