#include "services/alignment_estimator/core/planar/planar_sums.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::alignment::planar {

namespace {

/// The model at one parameter vector, for one scan.
struct Model {
  Model(const Setting& setting, const Parameters& at)
      : yaw(setting.nominal.yaw_rad + at(parameter::kAlpha)),
        pitch(setting.nominal.pitch_rad + at(parameter::kBeta)),
        cos_roll(std::cos(setting.nominal.roll_rad + at(parameter::kGamma))),
        sin_roll(std::sin(setting.nominal.roll_rad + at(parameter::kGamma))),
        speed(setting.speed_mps),
        x(setting.nominal.position_m[0]),
        y(setting.nominal.position_m[1]) {
    const double yaw_rate = setting.yaw_rate_radps - at(parameter::kYawRateError);
    forward = at(parameter::kSpeedScale) * speed - yaw_rate * y;
    left = yaw_rate * x;
  }
  double yaw, pitch, cos_roll, sin_roll, speed, x, y, forward, left;
};

/// Values and derivatives at one detection, over the angles a and e of (10)(11).
struct Point {
  Point(const Model& m, double azimuth, double elevation)
      : from_yaw(azimuth * m.cos_roll - elevation * m.sin_roll),
        from_pitch(elevation * m.cos_roll + azimuth * m.sin_roll) {
    const double a = m.yaw + from_yaw, e = m.pitch + from_pitch;
    ca = std::cos(a), sa = std::sin(a), ce = std::cos(e), se = std::sin(e);
    along = m.forward * ca + m.left * sa;
    across = m.forward * sa - m.left * ca;
    value = -along * ce;  // (12)
    by_a = across * ce;   // (14)
    by_e = along * se;    // (15)
    by_aa = by_ee = along * ce;
    by_ae = -across * se;
  }
  [[nodiscard]] Parameters gradient(const Model& m) const {
    Parameters g;
    g << -m.speed * ca * ce,                     // (13)
        (m.x * sa - m.y * ca) * ce, by_a, by_e,  //
        by_e * from_yaw - by_a * from_pitch;     // (16)
    return g;
  }
  /// Derivatives of the gradient to a and to e.
  [[nodiscard]] Parameters gradient_by_a(const Model& m) const {
    Parameters g;
    g << m.speed * sa * ce, (m.x * ca + m.y * sa) * ce, by_aa, by_ae, by_ae * from_yaw + by_e - by_aa * from_pitch;
    return g;
  }
  [[nodiscard]] Parameters gradient_by_e(const Model& m) const {
    Parameters g;
    g << m.speed * ca * se, (m.y * ca - m.x * sa) * se, by_ae, by_ee, by_ee * from_yaw - by_ae * from_pitch - by_a;
    return g;
  }
  double from_yaw, from_pitch;  ///< the detection's angles turned by the roll
  double ca, sa, ce, se, along, across, value, by_a, by_e, by_aa, by_ae, by_ee;
};

}  // namespace

Row row_of(const Setting& setting, const Parameters& at, double azimuth_rad, double elevation_rad) {
  const Model model(setting, at);
  const Point point(model, azimuth_rad, elevation_rad);
  return {point.value, point.gradient(model)};
}

Sums sum_rows(const Rows& rows, const Setting& setting, const Parameters& at, const Judgement& judgement) {
  const Model model(setting, at);
  const double c = model.cos_roll, s = model.sin_roll;
  const double inverse_gate_square = 1.0 / (judgement.gate * judgement.gate);
  Sums sums;
  for (std::size_t i = 0; i < rows.count; ++i) {
    const Point p(model, rows.azimuth_rad[i], rows.elevation_rad[i]);
    const double va = rows.azimuth_std_rad[i] * rows.azimuth_std_rad[i];
    const double ve = rows.elevation_std_rad[i] * rows.elevation_std_rad[i];
    // Covariance of a and e, turned by the roll, and its product with the model's gradient.
    const double caa = c * c * va + s * s * ve, cee = s * s * va + c * c * ve, cae = c * s * (va - ve);
    const double ka = caa * p.by_a + cae * p.by_e, ke = cae * p.by_a + cee * p.by_e;
    const double variance =
        rows.range_rate_std_mps[i] * rows.range_rate_std_mps[i] + ka * p.by_a + ke * p.by_e + judgement.added_variance;
    double e = rows.range_rate_mps[i] - p.value + 0.5 * (caa * p.by_aa + 2.0 * cae * p.by_ae + cee * p.by_ee);
    if (rows.ambiguity_mps > 0.0) e = std::remainder(e, rows.ambiguity_mps);
    if (!std::isfinite(e) || !(variance > 0.0)) continue;
    const Parameters g = p.gradient(model);
    const double z2 = e * e / (variance + g.dot(judgement.covariance * g)), t = z2 * inverse_gate_square;
    if (!(t < 1.0)) continue;
    const double q = 1.0 - t, weight = q * q, slope = q * (1.0 - 5.0 * t);
    sums.inliers += 1.0;
    if (weight > 0.2) sums.stationary += 1.0;
    sums.elevation += rows.elevation_rad[i];
    sums.elevation_square += rows.elevation_rad[i] * rows.elevation_rad[i];
    sums.elevation_variance += ve;
    sums.slope += slope;
    sums.square += weight * weight * z2;
    const double inverse = 1.0 / variance;
    const Parameters ga = p.gradient_by_a(model), ge = p.gradient_by_e(model);
    const double variance_by_a = 2.0 * (ka * p.by_aa + ke * p.by_ae),
                 variance_by_e = 2.0 * (ka * p.by_ae + ke * p.by_ee);
    // Term of ψ·(1/s): Stein's lemma for the derivative of ψ(e/s)/s to s².
    const double of_variance = 0.5 * slope * (1.0 + z2) * inverse * (variance_by_a * ka + variance_by_e * ke);
    sums.score += inverse * ((weight * e - of_variance) * g + slope * (ka * ga + ke * ge));
    sums.information.selfadjointView<Eigen::Lower>().rankUpdate(g, inverse);
    sums.from_noise += inverse * (caa * ga * ga.transpose() + cae * (ga * ge.transpose() + ge * ga.transpose()) +
                                  cee * ge * ge.transpose());
  }
  sums.information.triangularView<Eigen::StrictlyUpper>() = sums.information.transpose();
  return sums;
}

}  // namespace boresight::alignment::planar
