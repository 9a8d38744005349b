#include "services/alignment_estimator/core/windows/curve_sums.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/filter/residual.hpp"

namespace boresight::alignment::windows {

namespace {

constexpr double kWideGate = 3.0;
/// A detection below the road is a mirror image or it is not, and the share of mirror images is a mean: the variance of
/// one with equal chance, relative to the square of what its range rate would change.
constexpr double kImageVariance = 0.25;

/// What the range rate of a detection would lose per unit of its height parameter, and the derivative to the elevation.
struct HeightColumn {
  double column = 0.0, by_elevation = 0.0;
  bool below = false;
};

/// Above the road: the reflector is higher than its detection. Below: the detection is the mirror image of a reflector
/// above. `upright`: cosine of the roll, between the directions of growing elevation of the sensor and of the vehicle.
HeightColumn height_column(const Eigen::Vector3d& u, const Eigen::Vector3d& g, double along, double upright,
                           double range_m, const CurveJudgement& judgement) {
  if (!(judgement.height_m > 0.0) || !(range_m > 1.0)) return {};
  const double z = judgement.up.dot(u), height = judgement.height_m / range_m + z;  // over the range
  if (height >= 0.0) {
    const double across = std::sqrt(std::max(1.0 - z * z, 1e-6));
    const double rise = (judgement.up.dot(g) - z * along) / across;  // derivative to the vehicle's elevation
    return {rise * height, upright * (rise * across - along * height), false};
  }
  const double image = -z - 2.0 * judgement.height_m / range_m;
  // Steeper than a radar of the road sees.
  constexpr double kSteepest = 0.5;
  if (std::abs(image) > kSteepest || z < -kSteepest) return {};
  const double across = std::sqrt(1.0 - z * z), across_image = std::sqrt(1.0 - image * image);
  const double upward = judgement.up.dot(g), forward = (along - z * upward) / across;
  return {(across_image - across) * forward + (image - z) * upward,
          upright * ((image * across / across_image + z) * forward - 2.0 * across * upward), true};
}

}  // namespace

CurveSums sum_scan(const Sightings& run, const Eigen::Vector3d& g, const Curve& curve, const Knots& knots,
                   const CurveJudgement& judgement) {
  CurveSums sums;
  ScanSums& common = sums.common;
  const double inverse_gate_square = 1.0 / (judgement.gate * judgement.gate);
  const double mean_square = weighted_square(judgement.gate);
  const double ambiguity = run.ambiguity_mps, inverse_ambiguity = ambiguity > 0.0 ? 1.0 / ambiguity : 0.0;
  const double wide = judgement.wide_std_mps * judgement.wide_std_mps;
  const double inverse_step = 1.0 / knots.step_rad;
  common.information.setZero();
  common.from_noise.setZero();
  common.score.setZero();
  sums.detections = static_cast<double>(run.count);
  for (std::size_t i = 0; i < run.count; ++i) {
    const double place = (run.azimuth_rad[i] - knots.first_rad) * inverse_step;
    const int knot = std::clamp(static_cast<int>(place), 0, kKnots - 2);
    const double h1 = std::clamp(place - knot, 0.0, 1.0), h0 = 1.0 - h1;
    const double slope_of_hat = place > 0.0 && place < kKnots - 1 ? inverse_step : 0.0;
    const double error = curve(knot) * h0 + curve(knot + 1) * h1;
    // Turned by −error about the sensor's z axis, to second order.
    const double ce_ = 1.0 - 0.5 * error * error;
    const Eigen::Vector3d u(ce_ * run.x[i] + error * run.y[i], ce_ * run.y[i] - error * run.x[i], run.z[i]);
    const double ce = std::sqrt(u.x() * u.x() + u.y() * u.y());
    const Eigen::Vector3d ea(-u.y(), u.x(), 0.0), eb(-u.x() * u.z() / ce, -u.y() * u.z() / ce, ce);
    AngleDerivatives d(u.x(), u.y(), u.z(), ce, g.x(), g.y(), g.z());
    d.va = judgement.angle_factor * run.azimuth_variance[i];
    d.ve = judgement.angle_factor * run.elevation_variance[i];
    d.va_slope = run.azimuth_std_slope[i];
    const HeightColumn of_height = run.has_elevation
                                       ? height_column(u, g, d.along, judgement.up.dot(eb), run.range_m[i], judgement)
                                       : HeightColumn();
    double e = run.range_rate_mps[i] + d.along +
               (of_height.below ? judgement.mirror_share : judgement.height_excess) * of_height.column;
    if (ambiguity > 0.0) e -= ambiguity * std::nearbyint(e * inverse_ambiguity);
    const double by_rate =
        judgement.rate_factor * run.range_rate_variance[i] + run.lowering_variance[i] * d.along * d.along;
    const double by_angle = d.va * d.da * d.da + d.ve * d.db * d.db;
    const double s2 =
        by_rate + by_angle + (of_height.below ? kImageVariance * of_height.column * of_height.column : 0.0);
    const double gate_variance = s2 + u.dot(judgement.velocity_variance * u) + judgement.curve_variance * d.da * d.da;
    if (wide > 0.0) {
      const double t = e * e / ((gate_variance + wide) * kWideGate * kWideGate);
      if (t < 1.0) {
        const double weight = (1.0 - t) * (1.0 - t) / s2;
        sums.wide_score -= weight * e * u;
        sums.wide_information.noalias() += weight * u * u.transpose();
      }
    }
    const double z2 = e * e / gate_variance;
    const TukeyWeight tukey{z2 * inverse_gate_square};
    if (tukey.t >= 1.0) {
      if (tukey.t < 9.0) common.near += 1.0;
      continue;
    }
    count(tukey, z2, common);
    const double inverse = 1.0 / s2, weight = tukey.w * inverse, slope = tukey.curvature * inverse;
    const double pull = pull_of(e, tukey, inverse, gate_variance, inverse_gate_square, d);
    const double ka = slope * d.va * d.da, kb = slope * d.ve * d.db;
    sums.score += pull * u + ka * ea + kb * eb;
    const double wa = weight * d.va, we = weight * d.ve;
    const double along_square = weight * d.along * d.along;
    common.along += along_square;
    common.lowered += along_square * run.lowering[i];
    common.raised += along_square * run.mean_sine[i];
    const Eigen::Matrix3d from_noise = wa * ea * ea.transpose() + we * eb * eb.transpose();
    common.from_noise += from_noise;
    sums.information.noalias() += weight * u * u.transpose() - from_noise;
    // The knots: ∂e/∂c = −h·da. Its derivative to the azimuth has the slope of the hat function, so that a direction
    // that the data cannot see (a scale of the range rates against a stretched curve) gets no push.
    CurveSums::Heights& heights = sums.heights[of_height.below ? 1 : 0];
    const double hc = of_height.column, hb = of_height.by_elevation;
    heights.score += pull * hc + kb * hb;
    heights.by_velocity += weight * hc * u - we * hb * eb;
    heights.diagonal += weight * hc * hc - we * hb * hb;
    for (int side = 0; side < 2; ++side) {
      const int k = knot + side;
      const double h = side == 0 ? h0 : h1, hat = side == 0 ? -slope_of_hat : slope_of_hat;
      const double column = -d.da * h, by_azimuth = -(d.daa * h + d.da * hat), by_elevation = -d.dab * h;
      sums.curve_score(k) += pull * column + ka * by_azimuth + kb * by_elevation;
      sums.curve_by_velocity.row(k) +=
          (weight * column * u - wa * by_azimuth * ea - we * by_elevation * eb).transpose();
      sums.curve_diagonal(k) +=
          weight * column * column - wa * by_azimuth * by_azimuth - we * by_elevation * by_elevation;
      heights.by_curve(k) += weight * column * hc - we * by_elevation * hb;
      if (side == 1) {
        const double c0 = -d.da * h0, a0 = -(d.daa * h0 - d.da * slope_of_hat), b0 = -d.dab * h0;
        sums.curve_next(knot) += weight * c0 * column - wa * a0 * by_azimuth - we * b0 * by_elevation;
      }
    }
    add_noise(tukey.w, z2, mean_square, by_rate / gate_variance, by_angle / gate_variance, common);
  }
  return sums;
}

}  // namespace boresight::alignment::windows
