// Sizes and correlation times of the fluctuations, learnt after each solution.
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/alignment_estimator/core/windows/equations.hpp"

namespace boresight::alignment::windows {

namespace {

/// Degrees of freedom of the t distribution of a segment's fluctuation: a segment that contradicts counts less.
constexpr double kSegmentFreedom = 5.0;

/// Fisher's scoring of λ = ln q: `sum` of E[x²] over the data, `known` of (1 − Var[x]/q)², the share of q that the data
/// determine. Expectation maximisation, with known = n, would need as many solutions as n/known.
double scored_variance(double variance, double sum, double count, double known, double median_std, double log_std) {
  if (!(variance > 0.0)) return variance;
  const double prior = 1.0 / square(2.0 * log_std), start = 2.0 * std::log(median_std);
  const double slope = 0.5 * (sum / variance - count) - (std::log(variance) - start) * prior;
  const double step = slope / (0.5 * known + prior);
  return variance * std::exp(std::clamp(step, -1.5, 1.5));
}

/// The maximum of −n/2·λ − sum/(2q) − (λ − λ₀)²/(2τ²).
double fitting_variance(double variance, double sum, double count, double median_std, double log_std) {
  if (!(variance > 0.0)) return variance;
  const double prior = 1.0 / square(2.0 * log_std), start = 2.0 * std::log(median_std);
  double log_variance = std::log(variance);
  for (int i = 0; i < 8; ++i) {
    const double expected = 0.5 * sum * std::exp(-log_variance);
    const double slope = -0.5 * count + expected - (log_variance - start) * prior;
    log_variance += std::clamp(slope / (expected + prior), -1.0, 1.0);
  }
  return std::exp(log_variance);
}

}  // namespace

void Solver::learn(Segments& segments, std::size_t index) {
  Eliminated& w = work_[index];
  RadarSolution& radar = radars_[index];
  const auto cross = w.cross.leftCols(border_);
  const auto of_border = border_inverse_.topLeftCorner(border_, border_);
  // Covariance between the own parameters and the border: −inverse·cross·border⁻¹.
  Eigen::Matrix<double, own::kCount, kMaxShared> with_border;
  {
    Eigen::Matrix<double, own::kCount, kMaxShared> by_own;
    by_own.leftCols(border_).noalias() = w.inverse * cross;
    with_border.leftCols(border_).noalias() = -by_own.leftCols(border_) * of_border;
    w.covariance = w.inverse;
    w.covariance.noalias() -= with_border.leftCols(border_) * by_own.leftCols(border_).transpose();
    w.step = w.solved;
    w.step.noalias() -= by_own.leftCols(border_) * border_step_.head(border_);
  }
  w.with_shared = with_border.leftCols<shared::kConstants>();

  const LocalMatrix of_constants = covariance_of_constants(
      w.covariance, w.with_shared, of_border.topLeftCorner<shared::kConstants, shared::kConstants>());
  std::array<double, kFluctuations> sum{}, known{};
  double segments_used = 0.0;
  for (int i = 0; i < segments.size(); ++i) {
    Share& share = segments.share(i, index);
    if (share.seconds < 1.5) continue;
    const Segment& segment = segments.segment(i);
    const double relative = own_relative(segment);
    const Reduced r = reduced(share, segment, index);
    LocalVector d = LocalVector::Zero();
    for (const OwnAction& a : OwnActions(drift_time(segment.middle_s), load_rad(segment.load)).actions) {
      d(a.local) += a.factor * w.step(a.own);
    }
    const TouchedColumns t = touched(segment, i);
    for (int b = 0; b < t.count; ++b) {
      const Touched& touch = t.columns[static_cast<std::size_t>(b)];
      d(touch.local) += border_step_(touch.border);
    }
    const FluctuationVector mean = r.posterior * r.raw_score - r.gain.transpose() * d;
    // Variance by the other parameters: all constants, and the common fluctuation.
    LocalMatrix of_static = of_constants;
    for (int a = 0; a < kFluctuations; ++a) {
      const int border_a = shared::kFirstFluctuation + kFluctuations * i + a;
      const int local_a = kFluctuating[static_cast<std::size_t>(a)];
      LocalVector with_common;
      for (int c = 0; c < local::kCount; ++c) {
        const int own = own_column(c);
        with_common(c) = own >= 0 ? with_border(own, border_a) : of_border(shared_column(c), border_a);
      }
      of_static.col(local_a) += with_common;
      of_static.row(local_a) += with_common.transpose();
      for (int b = 0; b < kFluctuations; ++b) {
        of_static(local_a, kFluctuating[static_cast<std::size_t>(b)]) +=
            of_border(border_a, shared::kFirstFluctuation + kFluctuations * i + b);
      }
    }
    const FluctuationColumns spread = of_static * r.gain;
    const FluctuationMatrix covariance = r.posterior + r.gain.transpose() * spread;
    double distance = 0.0, freedom = 0.0;
    for (int a = 0; a < kFluctuations; ++a) {
      const double variance = relative * radar.fluctuation.variance[static_cast<std::size_t>(a)];
      if (!(variance > 0.0)) continue;
      distance += (square(mean(a)) + covariance(a, a)) / variance;
      freedom += 1.0;
    }
    share.weight = (kSegmentFreedom + freedom) / (kSegmentFreedom + std::max(distance, freedom));
    for (int a = 0; a < kFluctuations; ++a) {
      sum[static_cast<std::size_t>(a)] += share.weight * (square(mean(a)) + covariance(a, a)) / relative;
      const double variance = relative * radar.fluctuation.variance[static_cast<std::size_t>(a)] / share.weight;
      if (variance > 0.0)
        known[static_cast<std::size_t>(a)] += square(std::max(1.0 - covariance(a, a) / variance, 0.0));
    }
    segments_used += 1.0;
  }
  if (segments_used >= 2.0) {
    for (std::size_t k = 0; k < kFluctuations; ++k) {
      double& variance = radar.fluctuation.variance[k];
      variance =
          k == 1 ? scored_variance(variance, sum[k], segments_used, known[k], radar.median_std[k],
                                   priors_.log_fluctuation_std)
                 : fitting_variance(variance, sum[k], segments_used, radar.median_std[k], priors_.log_fluctuation_std);
    }
    for (int axis = 0; axis < 2; ++axis) {
      const int c = own::kPitchDrift + axis;
      double& variance = radar.drift_variance[static_cast<std::size_t>(axis)];
      variance = fitting_variance(variance, square(radar.state.drift_radps(axis) + w.step(c)) + w.covariance(c, c), 1.0,
                                  priors_.drift_std_radps, priors_.log_fluctuation_std);
    }
  }
}

void Solver::learn_common(const Segments& segments) {
  if (segments.size() < 2) return;
  const auto inverse = border_inverse_.topLeftCorner(border_, border_);
  for (int k = 0; k < kFluctuations; ++k) {
    double& variance = common_.variance[static_cast<std::size_t>(k)];
    if (!(variance > 0.0)) continue;
    const double median_std = median_common_std_[static_cast<std::size_t>(k)];
    // Innovations of the chain: sums of their expected squares, relative to the variance of the fluctuation.
    struct Chain {
      double sum = 0.0, log_noise = 0.0;
    };
    const auto chain_of = [&](double tau_s) {
      Chain chain;
      for (int i = 0; i < segments.size(); ++i) {
        const int column = shared::kFirstFluctuation + kFluctuations * i + k;
        const ChainLink link = chain_link(segments, i, tau_s);
        double mean = border_step_(column), spread = inverse(column, column);
        if (i > 0) {
          const int last = column - kFluctuations;
          mean -= link.keep * border_step_(last);
          spread += square(link.keep) * inverse(last, last) - 2.0 * link.keep * inverse(column, last);
        }
        chain.sum += (square(mean) + spread) / link.noise;
        chain.log_noise += std::log(link.noise);
      }
      return chain;
    };
    // Expected log likelihood with this correlation time and the variance that fits best to it.
    const auto likelihood = [&](double tau_s) {
      const Chain chain = chain_of(tau_s);
      const double fitting =
          fitting_variance(variance, chain.sum, segments.size(), median_std, priors_.log_fluctuation_std);
      return -0.5 * (chain.log_noise + segments.size() * std::log(fitting) + chain.sum / fitting) -
             0.5 * square(0.5 * std::log(fitting / square(median_std)) / priors_.log_fluctuation_std) -
             0.5 * square(std::log(tau_s / priors_.common_correlation_s) / priors_.log_correlation_std);
    };
    double& tau_s = correlation_s_[static_cast<std::size_t>(k)];
    const double now_s = tau_s;
    double best = likelihood(now_s);
    for (const double factor : {0.5, 0.8, 1.25, 2.0}) {
      const double other_s = std::clamp(now_s * factor, 0.3, 60.0), value = likelihood(other_s);
      if (value <= best) continue;
      best = value;
      tau_s = other_s;
    }
    const Chain chain = chain_of(tau_s);
    variance = fitting_variance(variance, chain.sum, segments.size(), median_std, priors_.log_fluctuation_std);
  }
}

}  // namespace boresight::alignment::windows
