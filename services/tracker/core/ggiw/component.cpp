#include "services/tracker/core/ggiw/component.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boresight::tracking {

template <typename Real>
void predict(Component<Real>& c, const MotionParameters& motion, double elapsed_s) {
  const auto t = static_cast<Real>(elapsed_s);
  const auto q = static_cast<Real>(elapsed_s > 0.0 ? motion.acceleration_density : 0.0);
  c.position_m = c.position_m + t * c.velocity_mps;
  const Matrix2<Real> pv = c.position_velocity_covariance;
  const Symmetric2<Real> vv = c.velocity_covariance;
  const Symmetric2<Real> cross{Real(2) * pv.xx, pv.xy + pv.yx, Real(2) * pv.yy};
  const Symmetric2<Real> identity{1, 0, 1};
  c.position_covariance = c.position_covariance + t * cross + (t * t) * vv + (q * t * t * t / Real(3)) * identity;
  c.position_velocity_covariance = pv + t * full(vv) + (q * t * t / Real(2)) * full(identity);
  c.velocity_covariance = vv + (q * t) * identity;
  if (elapsed_s <= 0.0) return;

  const auto keep_rate = static_cast<Real>(std::exp(-elapsed_s / motion.rate_memory_s));
  c.rate_shape *= keep_rate;
  c.rate_inverse_scale *= keep_rate;
  const auto min_shape = static_cast<Real>(motion.rate_min_shape);
  if (c.rate_shape < min_shape) {
    c.rate_inverse_scale *= min_shape / c.rate_shape;
    c.rate_shape = min_shape;
  }
  const auto keep_extent = static_cast<Real>(std::exp(-elapsed_s / motion.extent_memory_s));
  const auto min_dof = static_cast<Real>(motion.extent_min_dof);
  Symmetric2<Real> mean = extent(c);
  const Real middle = trace(mean) / Real(2), half = (mean.xx - mean.yy) / Real(2);
  const Real least = middle - std::sqrt(half * half + mean.xy * mean.xy);
  const auto min_extent = static_cast<Real>(motion.extent_min_m2);
  if (least < min_extent) mean = mean + (min_extent - least) * identity;
  c.extent_dof = std::max(min_dof, Real(6) + keep_extent * (c.extent_dof - Real(6)));
  c.extent_scale = (c.extent_dof - Real(6)) * mean;
}

template <typename Real>
Component<Real> merge(std::span<const WeightedComponent<Real>> mixture) {
  if (mixture.size() == 1) return *mixture.front().component;
  Real sum = 0;
  for (const auto& m : mixture) sum += m.weight;
  Component<Real> out;
  out.label = mixture.front().component->label;
  out.source = {0, 0, 0, mixture.front().component->source.radar, 0, 0, 0};
  out.extent_dof = 0;
  Symmetric2<Real> mean_extent;
  Real rate = 0, rate_squares = 0, strength_sum = 0;
  for (const auto& m : mixture) {
    const Component<Real>& c = *m.component;
    const Real w = m.weight / sum, mean_rate = c.rate_shape / c.rate_inverse_scale;
    out.position_m = out.position_m + w * c.position_m;
    out.velocity_mps = out.velocity_mps + w * c.velocity_mps;
    out.extent_dof += w * c.extent_dof;
    mean_extent = mean_extent + w * extent(c);
    rate += w * mean_rate;
    rate_squares += w * (mean_rate / c.rate_inverse_scale + mean_rate * mean_rate);
    out.source.object += w * c.source.object;
    out.source.side_lobe += w * c.source.side_lobe;
    out.source.lasting_source += w * c.source.lasting_source;
    out.source.hidden_parent += w * c.source.hidden_parent;
    out.source.kept_ring += w * c.source.kept_ring;
    out.source.side_lobe_odds += w * c.source.side_lobe_odds;
    if (c.source.radar != out.source.radar) out.source.radar = -1;
    out.mirror += w * c.mirror;
    out.strengths += w * c.strengths;
    strength_sum += w * c.strengths * c.strength_db;
  }
  for (const auto& m : mixture) {
    const Component<Real>& c = *m.component;
    const Real w = m.weight / sum;
    const Vector2<Real> dp = c.position_m - out.position_m, dv = c.velocity_mps - out.velocity_mps;
    out.position_covariance = out.position_covariance + w * (c.position_covariance + outer(dp));
    out.velocity_covariance = out.velocity_covariance + w * (c.velocity_covariance + outer(dv));
    out.position_velocity_covariance =
        out.position_velocity_covariance + w * (c.position_velocity_covariance + outer(dp, dv));
  }
  if (out.strengths > 0) out.strength_db = strength_sum / out.strengths;
  const Real variance = std::max(rate_squares - rate * rate, rate * rate * std::numeric_limits<Real>::epsilon());
  out.rate_inverse_scale = rate / variance;
  out.rate_shape = rate * out.rate_inverse_scale;
  out.extent_scale = (out.extent_dof - Real(6)) * mean_extent;
  return out;
}

template <typename Real>
Real distance(const Component<Real>& a, const Component<Real>& b, Real limit) {
  const Vector2<Real> dp = a.position_m - b.position_m;
  Real sum = (quadratic(inverse(a.position_covariance), dp) + quadratic(inverse(b.position_covariance), dp)) / Real(2);
  if (sum >= limit) return sum;
  const Vector2<Real> dv = a.velocity_mps - b.velocity_mps;
  sum += (quadratic(inverse(a.velocity_covariance), dv) + quadratic(inverse(b.velocity_covariance), dv)) / Real(4);
  if (sum >= limit) return sum;
  const Symmetric2<Real> xa = extent(a), xb = extent(b), dx = xa - xb;
  const Real mean = (trace(xa) + trace(xb)) / Real(2);
  sum += (dx.xx * dx.xx + Real(2) * dx.xy * dx.xy + dx.yy * dx.yy) / (mean * mean) *
         (a.extent_dof + b.extent_dof - Real(12)) / Real(16);
  if (sum >= limit) return sum;
  const Real rate_ratio = std::log(a.rate_shape * b.rate_inverse_scale / (a.rate_inverse_scale * b.rate_shape));
  return sum + rate_ratio * rate_ratio * (a.rate_shape + b.rate_shape) / Real(8);
}

template void predict(Component<double>&, const MotionParameters&, double);
template void predict(Component<float>&, const MotionParameters&, double);
template Component<double> merge(std::span<const WeightedComponent<double>>);
template Component<float> merge(std::span<const WeightedComponent<float>>);
template double distance(const Component<double>&, const Component<double>&, double);
template float distance(const Component<float>&, const Component<float>&, float);

}  // namespace boresight::tracking
