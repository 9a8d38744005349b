#include "services/tracker/core/ggiw/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

namespace {

template <typename Real>
constexpr Real kLogPi = Real(1.1447298858494001741434);
template <typename Real>
constexpr Real kLogTwoPi = Real(1.8378770664093454835607);

/// log Γ(a + more) − log Γ(a) for a above 60: Stirling's series.
template <typename Real>
Real log_gamma_growth(Real a, Real more) {
  const Real b = a + more;
  const auto rest = [](Real x) { return (Real(1) - Real(1) / (Real(30) * x * x)) / (Real(12) * x); };
  return (b - Real(0.5)) * std::log(b) - (a - Real(0.5)) * std::log(a) - more + rest(b) - rest(a);
}

/// What range rates of information Λ do to a velocity of covariance C. With adj S = S⁻¹ det S,
///   det(I + CΛ) = 1 + tr CΛ + det C det Λ,   (I + CΛ)⁻¹C = (C + det C adj Λ) / det(I + CΛ):
/// sums of positive terms, which no rounding makes indefinite.
template <typename Real>
struct RateUpdate {
  Symmetric2<Real> information;  // Λ
  Vector2<Real> innovation;      // d
  Real information_determinant, factor_determinant;
  Symmetric2<Real> covariance;  // (I + CΛ)⁻¹C
  Vector2<Real> correction;     // (I + CΛ)⁻¹C d
  Real turn_determinant, turn_chi2;

  RateUpdate(const Cell<Real>& cell, const Vector2<Real>& velocity, const Symmetric2<Real>& c, const View<Real>& view) {
    const Real f = Real(1) / view.range_rate_variance;
    information = f * cell.sight_squares;
    innovation = f * cell.sight_rate - information * velocity;
    // An unknown turn rate looks like a velocity w · N(0, 1) in addition.
    const Vector2<Real> w = view.turn_mps, of_turn = information * w;
    const Real by_turn = dot(w, innovation);
    turn_determinant = Real(1) + dot(w, of_turn);
    turn_chi2 = by_turn * by_turn / turn_determinant;
    information = information - (Real(1) / turn_determinant) * outer(of_turn);
    innovation = innovation - (by_turn / turn_determinant) * of_turn;
    information_determinant = std::max(Real(0), determinant(information));
    const Real c_determinant = std::max(Real(0), determinant(c));
    const Real product = c.xx * information.xx + Real(2) * c.xy * information.xy + c.yy * information.yy;
    factor_determinant = Real(1) + std::max(Real(0), product) + c_determinant * information_determinant;
    covariance = (Real(1) / factor_determinant) * (c + c_determinant * adjugate(information));
    correction = covariance * innovation;
  }
};

}  // namespace

template <typename Real>
Absence<Real>::Absence(const Component<Real>& c, const View<Real>& view)
    : exposure_(view.exposure),
      detection_probability_(view.detection_probability),
      log_rate_step_(std::log(c.rate_inverse_scale + view.exposure)),
      // Of the gamma-Poisson: (β / (β + exposure))^α
      log_none_(c.rate_shape * (std::log(c.rate_inverse_scale) - log_rate_step_)),
      probability_(std::max(Real(kLeastDensity),
                            Real(1) - detection_probability_ + detection_probability_ * std::exp(log_none_))) {}

template <typename Real>
Component<Real> Absence<Real>::after(const Component<Real>& prior) const {
  Component<Real> out = prior;
  // Not detected, or detected with no point: a mixture of two gammas by its moments.
  const Real share = detection_probability_ * std::exp(log_none_) / probability_;
  if (share <= Real(0)) return out;
  const Real before = prior.rate_shape / prior.rate_inverse_scale;
  const Real scale = prior.rate_inverse_scale + exposure_, after = prior.rate_shape / scale;
  const Real mean = (Real(1) - share) * before + share * after;
  const Real variance = (Real(1) - share) * (before / prior.rate_inverse_scale + before * before) +
                        share * (after / scale + after * after) - mean * mean;
  out.rate_inverse_scale = mean / variance;
  out.rate_shape = mean * out.rate_inverse_scale;
  return out;
}

template <typename Real>
Prediction<Real>::Prediction(const Component<Real>& c, const View<Real>& view)
    : view_(view),
      label_(c.label),
      position_m_(c.position_m),
      velocity_mps_(c.velocity_mps),
      position_covariance_(c.position_covariance),
      velocity_covariance_(c.velocity_covariance),
      position_velocity_covariance_(c.position_velocity_covariance),
      extent_scale_(c.extent_scale),
      extent_dof_(c.extent_dof),
      rate_shape_(c.rate_shape),
      rate_inverse_scale_(c.rate_inverse_scale),
      detection_probability_(view.detection_probability),
      absence_(c, view),
      source_(c.source) {
  const Symmetric2<Real> x = extent(c);
  scatter_ = view.spread * x + view.noise_m2;
  held_scatter_ = (view.held * view.spread) * x + view.noise_m2;
  extent_root_ = square_root(x);
  shape_ = extent_root_ * inverse(square_root(scatter_));
  for (std::size_t k = 0; k < view.number_of_readings; ++k) {
    const Reading<Real>& reading = view.readings[k];
    Place& place = places_[k];
    place.offset_m = reading.offset_m;
    place.prior_m2 = position_covariance_ + reading.covariance_m2;
    place.knows_scatter = reading.knows_scatter;
    place.scatter_m2 = reading.knows_scatter ? reading.scatter_m2 + view.noise_m2 : scatter_;
    place.covariance_m2 = place.prior_m2 + place.scatter_m2;
    place.information = inverse(place.covariance_m2);
    place.log_half_determinant = std::log(determinant(place.covariance_m2)) / Real(2);
    place.log_weight = view.number_of_readings > 1 ? std::log(reading.weight) : Real(0);
  }

  const Real log_x = std::log(determinant(x)), log_scatter = std::log(determinant(scatter_));
  log_exposure_ = std::log(view.exposure);
  log_expected_ = std::log(view.exposure * rate_shape_ / rate_inverse_scale_);
  per_detection_ = (log_x - log_scatter) / Real(2) - kLogPi<Real>;
  log_detection_ = std::log(std::max(detection_probability_, Real(kLeastProbability)));
  constant_ =
      (extent_dof_ - Real(3)) / Real(2) * std::log(determinant(extent_scale_)) + log_scatter / Real(2) + log_detection_;
  if (view.range_rate_variance > 0) log_range_rate_ = kLogTwoPi<Real> + std::log(view.range_rate_variance);
  by_count_[0] = 0;
  log_count_[0] = absence_.log_none();
  extent_terms_ = absence_.log_none();
  tabulated_ = 1;
}

template <typename Real>
void Prediction<Real>::tabulate(std::size_t n) {
  for (; tabulated_ <= n && tabulated_ < kTabulated; ++tabulated_) {
    const auto k = static_cast<Real>(tabulated_);
    // From k − 1 to k detections: gamma function of the rate, multivariate gamma function of the extent.
    const Real rate = std::log(rate_shape_ + k - Real(1)) - absence_.log_rate_step() + log_exposure_;
    const Real a = (extent_dof_ + k - Real(4)) / Real(2);
    extent_terms_ += rate + std::log(a - Real(0.5));
    log_count_[tabulated_] = log_count_[tabulated_ - 1] + rate - std::log(k);
    by_count_[tabulated_] = extent_terms_ + constant_ + k * per_detection_ - std::log(k);
  }
}

template <typename Real>
Real Prediction<Real>::interpolated(const std::array<Real, kTabulated>& table, Real n) {
  const std::size_t low = n < Real(1) ? 1 : static_cast<std::size_t>(n);
  if (tabulated_ < low + 2) tabulate(low + 3);
  const Real fraction = n < Real(1) ? Real(0) : n - static_cast<Real>(low);
  return fraction == Real(0) ? table[low] : table[low] + fraction * (table[low + 1] - table[low]);
}

template <typename Real>
Real Prediction<Real>::rates_beyond_table(Real more) const {
  return log_gamma_growth(rate_shape_ + kLastTabulated, more) + more * (log_exposure_ - absence_.log_rate_step());
}

template <typename Real>
Real Prediction<Real>::terms_by_count(Real n) {
  if (n <= kLastTabulated) return interpolated(by_count_, n);
  const Real more = n - kLastTabulated;
  tabulate(kTabulated);
  return by_count_.back() + rates_beyond_table(more) + log_gamma_growth(extent_dof_ + kLastTabulated - Real(4), more) +
         more * (per_detection_ - std::numbers::ln2_v<Real>)-std::log(n / kLastTabulated);
}

template <typename Real>
Real Prediction<Real>::log_count(Real n) {
  if (n <= kLastTabulated) return interpolated(log_count_, n);
  const Real more = n - kLastTabulated;
  tabulate(kTabulated);
  return log_count_.back() + rates_beyond_table(more) - log_gamma_growth(kLastTabulated + Real(1), more);
}

template <typename Real>
Real Prediction<Real>::log_source_ratio(Real n) {
  if (!knows_source_) {
    knows_source_ = true;
    const Real seen = Real(1) - std::exp(absence_.log_none());
    log_source_one_ = std::log((Real(1) - view_.source_more) * std::max(seen, Real(kLeastProbability)));
    log_source_more_ = std::log(view_.source_more);
  }
  const Real whole = std::max(n, Real(1));
  return log_source_one_ + (whole - Real(1)) * log_source_more_ - log_count(whole);
}

template <typename Real>
Real Prediction<Real>::source_place_ratio(const Cell<Real>& cell) const {
  const Real wander = view_.source_wander_m2;
  const Symmetric2<Real> s = places_[0].prior_m2 + (Real(1) / cell.n) * places_[0].scatter_m2;
  const Symmetric2<Real> wide = s + Symmetric2<Real>{wander, 0, wander};
  const Vector2<Real> e = cell.mean() - position_m_ - places_[0].offset_m;
  const Real log_ratio =
      (std::log(determinant(s) / determinant(wide)) + quadratic(inverse(s), e) - quadratic(inverse(wide), e)) / Real(2);
  return std::exp(std::min(Real(0), log_ratio));
}

template <typename Real>
typename Prediction<Real>::ClassWeights Prediction<Real>::class_weights(const Cell<Real>& cell) {
  // More than one detection speak against side lobes and sources; one speaks for neither: some radars report one of
  // each object.
  const Real log_ratio = std::min(Real(0), log_source_ratio(cell.n)), seen = view_.source_seen;
  const Real lobe = source_.side_lobe * seen * std::exp(view_.evidence_share * log_ratio);
  const Real source = seen * source_place_ratio(cell) * std::exp(log_ratio);
  const Real lasting = source_.lasting_source * source;
  return {lobe, lasting, source_.object + lobe + lasting + source_.brief_source() * source};
}

template <typename Real>
Real Prediction<Real>::log_class_weight(const Cell<Real>& cell) {
  return source_.object >= Real(1) ? Real(0) : std::log(class_weights(cell).sum);
}

template <typename Real>
Real Prediction<Real>::place_distance(const Vector2<Real>& position_m) const {
  Real least = quadratic(places_[0].information, position_m - position_m_ - places_[0].offset_m);
  for (std::size_t k = 1; k < view_.number_of_readings; ++k) {
    least = std::min(least, quadratic(places_[k].information, position_m - position_m_ - places_[k].offset_m));
  }
  return least;
}

template <typename Real>
Real Prediction<Real>::log_by(const Place& place, const Cell<Real>& cell) {
  const Real n = cell.n;
  const Symmetric2<Real> s = place.prior_m2 + (Real(1) / n) * place.scatter_m2;
  const Real det = determinant(s), root = std::sqrt(det);
  const Vector2<Real> e = cell.mean() - position_m_ - place.offset_m;
  Real log_p = place.log_weight, determinants = det;
  if (place.knows_scatter) {
    log_p += log_count(n) + std::lgamma(n + Real(1)) + log_detection_ - n * kLogTwoPi<Real> - std::log(n) -
             ((n - Real(1)) * std::log(determinant(place.scatter_m2)) +
              product_trace(inverse(place.scatter_m2), cell.scatter()) + quadratic(inverse(s), e)) /
                 Real(2);
  } else {
    const Real h = Real(1) / std::sqrt(trace(s) + Real(2) * root);
    const Symmetric2<Real> s_root{(s.xx + root) * h, s.xy * h, (s.yy + root) * h};  // determinant: root
    const Vector2<Real> whitened{(s_root.yy * e.x - s_root.xy * e.y) / root,
                                 (s_root.xx * e.y - s_root.xy * e.x) / root};
    const Symmetric2<Real> posterior =
        extent_scale_ + congruent(shape_, cell.scatter()) + outer(extent_root_ * whitened);
    log_p += terms_by_count(n) - (extent_dof_ + n - Real(3)) / Real(2) * std::log(determinant(posterior));
  }
  if (view_.range_rate_variance > 0) {
    const Symmetric2<Real> information{s.yy / det, -s.xy / det, s.xx / det};
    const Matrix2<Real> vp = transpose(position_velocity_covariance_);
    const Vector2<Real> velocity = velocity_mps_ + vp * (information * e);
    const Symmetric2<Real> c = velocity_covariance_ - congruent(vp, information);
    const RateUpdate<Real> rate(cell, velocity, c, view_);
    const Real chi2 =
        (cell.rate_squares - Real(2) * dot(cell.sight_rate, velocity) + quadratic(cell.sight_squares, velocity)) /
            view_.range_rate_variance -
        rate.turn_chi2 - dot(rate.innovation, rate.correction);
    log_p -= (n * log_range_rate_ + chi2) / Real(2);
    determinants *= rate.factor_determinant * rate.turn_determinant;
  }
  return log_p - std::log(determinants) / Real(2);
}

template <typename Real>
Real Prediction<Real>::log_likelihood(const Cell<Real>& cell) {
  Real log_p = log_by(places_[0], cell);
  for (std::size_t k = 1; k < view_.number_of_readings; ++k) {
    const Real other = log_by(places_[k], cell), top = std::max(log_p, other);
    log_p = top + std::log1p(std::exp(std::min(log_p, other) - top));
  }
  return log_p - cell.log_clutter + log_class_weight(cell);
}

template <typename Real>
std::array<Real, View<Real>::kMaxReadings> Prediction<Real>::weights_of(const Cell<Real>& cell) {
  std::array<Real, View<Real>::kMaxReadings> weight{1};
  if (view_.number_of_readings == 1) return weight;
  Real top = std::numeric_limits<Real>::lowest(), sum = 0;
  for (std::size_t k = 0; k < view_.number_of_readings; ++k) top = std::max(top, weight[k] = log_by(places_[k], cell));
  for (std::size_t k = 0; k < view_.number_of_readings; ++k) sum += weight[k] = std::exp(weight[k] - top);
  for (Real& w : weight) w /= sum;
  return weight;
}

template <typename Real>
Real Prediction<Real>::log_intensity(const Measurement<Real>& z) const {
  Real log_p = 0;
  for (std::size_t k = 0; k < view_.number_of_readings; ++k) {
    const Place& p = places_[k];
    const Real of_place = p.log_weight - p.log_half_determinant -
                          quadratic(p.information, z.position_m - position_m_ - p.offset_m) / Real(2);
    log_p = k == 0 ? of_place : std::max(log_p, of_place);
  }
  log_p += log_expected_ - kLogTwoPi<Real>;
  if (view_.range_rate_variance > 0) {
    const Real variance = view_.range_rate_variance + quadratic(velocity_covariance_, z.sight);
    const Real e = z.range_rate_mps - dot(z.sight, velocity_mps_);
    log_p -= (kLogTwoPi<Real> + std::log(variance) + e * e / variance) / Real(2);
  }
  return log_p - z.log_clutter;
}

template <typename Real>
Real Prediction<Real>::range_rate_distance(const Measurement<Real>& z) const {
  if (view_.range_rate_variance <= 0) return 0;
  const Real e = z.range_rate_mps - dot(z.sight, velocity_mps_);
  return e * e / (view_.range_rate_variance + quadratic(velocity_covariance_, z.sight));
}

template <typename Real>
typename Prediction<Real>::Centre Prediction<Real>::centre(const Cell<Real>& cell) {
  const auto weights = weights_of(cell);
  Vector2<Real> offset;
  Symmetric2<Real> r;
  Real by_extent = 0;
  for (std::size_t k = 0; k < view_.number_of_readings; ++k) offset = offset + weights[k] * view_.readings[k].offset_m;
  for (std::size_t k = 0; k < view_.number_of_readings; ++k) {
    const Reading<Real>& reading = view_.readings[k];
    const Symmetric2<Real> scatter =
        reading.knows_scatter ? view_.held * reading.scatter_m2 + view_.noise_m2 : held_scatter_;
    r = r + weights[k] * ((Real(1) / cell.n) * scatter + reading.covariance_m2 + outer(reading.offset_m - offset));
    if (!reading.knows_scatter) by_extent += weights[k];
  }
  return {cell.mean() - offset, r, by_extent};
}

template <typename Real>
Component<Real> Prediction<Real>::updated(const Component<Real>& prior, const Cell<Real>& cell) {
  Component<Real> out = prior;
  const Real n = cell.n;
  const auto [place, r, by_extent] = centre(cell);
  const Symmetric2<Real> s = prior.position_covariance + r, information = inverse(s);
  const Vector2<Real> e = place - prior.position_m, w = information * e;
  const Matrix2<Real> pv = prior.position_velocity_covariance, vp = transpose(pv);
  out.position_m = prior.position_m + prior.position_covariance * w;
  out.velocity_mps = prior.velocity_mps + vp * w;
  const Matrix2<Real> gain = prior.position_covariance * information, v_gain = vp * information;
  const Matrix2<Real> keep = Matrix2<Real>{1, 0, 0, 1} - gain;
  // Joseph form: (I − KH) P (I − KH)ᵀ + K R Kᵀ
  out.position_covariance = congruent(keep, prior.position_covariance) + congruent(gain, r);
  out.position_velocity_covariance = keep * pv;
  const Matrix2<Real> cross = v_gain * pv;
  out.velocity_covariance = prior.velocity_covariance -
                            Symmetric2<Real>{Real(2) * cross.xx, cross.xy + cross.yx, Real(2) * cross.yy} +
                            congruent(v_gain, s);

  out.extent_scale = prior.extent_scale + by_extent * (congruent(shape_, cell.scatter()) +
                                                       outer(extent_root_ * (inverse(square_root(s)) * e)));
  out.extent_dof = prior.extent_dof + by_extent * n;
  out.rate_shape = prior.rate_shape + n;
  out.rate_inverse_scale = prior.rate_inverse_scale + view_.exposure;
  const Real of_mirror = n / (n + rate_shape_);
  out.mirror = prior.mirror + of_mirror * (cell.mirror / n - prior.mirror);
  if (cell.strengths > 0) {
    out.strengths = prior.strengths + cell.strengths;
    out.strength_db = (prior.strengths * prior.strength_db + cell.strength_sum) / out.strengths;
  }

  if (source_.object < Real(1)) {
    const ClassWeights w = class_weights(cell);
    out.source.object = source_.object / w.sum;
    out.source.side_lobe = w.side_lobe / w.sum;
    out.source.lasting_source = w.lasting_source / w.sum;
  }
  if (view_.source_seen < Real(1)) out.source.radar = -1;

  if (view_.range_rate_variance > 0) {
    const Symmetric2<Real> c = out.velocity_covariance;
    const RateUpdate<Real> rate(cell, out.velocity_mps, c, view_);
    out.velocity_mps = out.velocity_mps + rate.correction;
    out.velocity_covariance = rate.covariance;
    // Place: x̂ += P_pv y with y = (I + ΛC)⁻¹d, P_pp −= P_pv (I + ΛC)⁻¹Λ P_vp
    const Real f = Real(1) / rate.factor_determinant;
    const Matrix2<Real> solve = f * (Matrix2<Real>{1, 0, 0, 1} + adjugate(c) * adjugate(rate.information));
    const Vector2<Real> y = solve * rate.innovation;
    const Matrix2<Real> before = out.position_velocity_covariance;
    const Symmetric2<Real> information_of_place = f * (rate.information + rate.information_determinant * adjugate(c));
    out.position_m = out.position_m + before * y;
    out.position_covariance = out.position_covariance - congruent(before, information_of_place);
    out.position_velocity_covariance = before * solve;
  }
  return out;
}

template class Absence<double>;
template class Absence<float>;
template class Prediction<double>;
template class Prediction<float>;

}  // namespace boresight::tracking
