#include "services/alignment_estimator/core/windows/solver.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/alignment_estimator/core/windows/reduced.hpp"

namespace boresight::alignment::windows {

namespace {

constexpr double kFixed = 1e18;  ///< precision of a parameter that is not estimated
/// Degrees of freedom of the t distribution of a segment's fluctuation: a segment that contradicts counts less.
constexpr double kSegmentFreedom = 5.0;

double precision_of(double std) {
  return std > 0.0 ? 1.0 / square(std) : kFixed;
}

/// Covariance of a smooth curve over the knots: neighbours within `length_rad` are alike; its mean, weighted to the
/// middle of the view, is zero, so that it is not a yaw.
Eigen::Matrix<double, kKnots, kKnots> curve_precision(double std, double length_knots) {
  using Square = Eigen::Matrix<double, kKnots, kKnots>;
  Square alike, project = Square::Identity();
  Eigen::Matrix<double, kKnots, 1> weights;
  for (int i = 0; i < kKnots; ++i) {
    weights(i) = i == 0 || i == kKnots - 1 ? 0.5 : 1.0;
    for (int j = 0; j < kKnots; ++j) alike(i, j) = std::exp(-0.5 * square((i - j) / length_knots)) + (i == j ? 1e-4 : 0.0);
  }
  weights /= weights.sum();
  project.rowwise() -= weights.transpose();
  Square covariance = project * alike * project.transpose();
  covariance *= square(std) / covariance.diagonal().mean();
  covariance.diagonal().array() += 1e-6 * square(std) + 1e-16;
  return covariance.inverse();
}

/// Step of λ = ln q towards the maximum of −n/2·λ − sum/(2q) − (λ − λ₀)²/(2τ²).
double learnt_variance(double variance, double sum, double count, double median_std, double log_std) {
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

Solver::Solver(std::size_t radars, const Priors& priors)
    : priors_(priors),
      radars_(radars),
      work_(radars),
      border_system_(kMaxShared, kMaxShared),
      border_inverse_(kMaxShared, kMaxShared),
      border_score_(kMaxShared),
      border_step_(kMaxShared) {
  shared_covariance_.setZero();
  shared_covariance_.diagonal() << square(priors.speed_scale_std), square(priors.yaw_rate_bias_std_radps),
      square(priors.yaw_rate_gain_std), square(priors.slip_std_radps2pm),
      square(priors.pitch_per_acceleration_std_radps2pm), square(priors.common_stamp_std_s);
  for (int k = 0; k < kFluctuations; ++k) {
    const auto i = static_cast<std::size_t>(k);
    common_.variance[i] = radars > 1 ? square(priors.common_std[i]) : 0.0;
  }
}

void Solver::set_prior(std::size_t radar, const Eigen::Matrix3d& nominal, bool has_elevation) {
  RadarSolution& r = radars_[radar];
  r.state.sensor_to_vehicle = r.state.earlier = nominal;
  r.prior_state = r.state;
  r.has_elevation = has_elevation;
  r.prior.setZero();
  r.prior(own::kRateScale, own::kRateScale) = precision_of(priors_.rate_scale_std);
  for (int axis = 0; axis < 3; ++axis) {
    const double precision =
        axis == 2 || has_elevation ? precision_of(priors_.rotation_std_rad) : kFixed;
    r.prior(own::kRotation + axis, own::kRotation + axis) = precision;
    r.prior(own::kEarlierRotation + axis, own::kEarlierRotation + axis) = precision;
  }
  r.prior(own::kMirror, own::kMirror) = has_elevation ? precision_of(priors_.mirror_share_std) : kFixed;
  r.prior(own::kStamp, own::kStamp) = precision_of(priors_.stamp_std_s);
  r.prior(own::kPosition, own::kPosition) = r.prior(own::kPosition + 1, own::kPosition + 1) =
      precision_of(priors_.position_std_m);
  r.covariance = r.prior.diagonal().cwiseMax(1e-12).cwiseInverse().asDiagonal();
  for (int k = 0; k < kFluctuations; ++k) {
    const auto i = static_cast<std::size_t>(k);
    r.fluctuation.variance[i] = k == 1 && !has_elevation ? 0.0 : square(priors_.own_std[i]);
  }
}

void Solver::set_curve_prior(std::size_t radar, double knot_step_rad) {
  RadarSolution& r = radars_[radar];
  r.prior.block<kKnots, kKnots>(own::kCurve, own::kCurve) =
      priors_.curve_std_rad > 0.0 ? curve_precision(priors_.curve_std_rad, priors_.curve_length_rad / knot_step_rad)
                                  : kFixed * Eigen::Matrix<double, kKnots, kKnots>::Identity();
  r.covariance.block<kKnots, kKnots>(own::kCurve, own::kCurve) =
      square(priors_.curve_std_rad) * Eigen::Matrix<double, kKnots, kKnots>::Identity();
}

Point Solver::point(std::size_t radar, int load, bool earlier) const {
  const OwnState& own = radars_[radar].state;
  Point p;
  double pitch_rad = 0.0;
  for (int step = 0; step < load; ++step) pitch_rad += shared_.load_rad[static_cast<std::size_t>(step)];
  p.speed_scale = shared_.speed_scale;
  p.rate_scale = own.rate_scale;
  p.sensor_to_vehicle =
      geometry::so3_exp({0.0, pitch_rad, 0.0}) * (earlier ? own.earlier : own.sensor_to_vehicle);
  p.yaw_rate_bias_radps = shared_.yaw_rate_bias_radps;
  p.yaw_rate_gain = shared_.yaw_rate_gain;
  p.slip_radps2pm = shared_.slip_radps2pm;
  p.stamp_s = shared_.stamp_s + own.stamp_s;
  p.position_error_m = own.position_error_m;
  p.pitch_per_acceleration_radps2pm = shared_.pitch_per_acceleration_radps2pm;
  p.curve_rad = own.curve_rad;
  p.mirror_share = own.mirror_share;
  return p;
}

namespace {

/// Where a local parameter stands among the radar's own; −1: it is the vehicle's.
int own_column(int local, bool earlier) {
  if (local == local::kRateScale) return own::kRateScale;
  if (local >= local::kRotation && local < local::kRotation + 3) {
    return (earlier ? own::kEarlierRotation : own::kRotation) + local - local::kRotation;
  }
  if (local == local::kStamp) return own::kStamp;
  if (local == local::kPosition || local == local::kPosition + 1) return own::kPosition + local - local::kPosition;
  if (local == local::kMirror) return own::kMirror;
  if (local >= local::kCurve) return own::kCurve + local - local::kCurve;
  return -1;
}

struct Touched {
  int border, local;
};
/// The shared columns that a segment touches: constants, loads and its common fluctuations.
struct TouchedColumns {
  std::array<Touched, shared::kConstants + shared::kLoads + kFluctuations> columns;
  int count = 0;
  void add(int border, int local) { columns[static_cast<std::size_t>(count++)] = {border, local}; }
};

TouchedColumns touched(const Segment& segment, int index) {
  TouchedColumns t;
  t.add(shared::kSpeedScale, local::kSpeedScale);
  t.add(shared::kYawRateBias, local::kYawRateBias);
  t.add(shared::kYawRateGain, local::kYawRateGain);
  t.add(shared::kSlip, local::kSlip);
  t.add(shared::kPitchPerAcceleration, local::kPitchPerAcceleration);
  t.add(shared::kStamp, local::kStamp);
  for (int step = 0; step < segment.load; ++step) t.add(shared::kLoad + step, local::kRotation + 1);
  for (int k = 0; k < kFluctuations; ++k) {
    t.add(shared::kFirstFluctuation + kFluctuations * index + k, kFluctuating[static_cast<std::size_t>(k)]);
  }
  return t;
}

}  // namespace

void Solver::gather(const Segments& segments, std::size_t index) {
  Eliminated& w = work_[index];
  const RadarSolution& radar = radars_[index];
  w.system = radar.prior;
  w.cross.leftCols(border_).setZero();
  OwnVector off;  // of the prior's mean from the present point
  const OwnState &mean = radar.prior_state, &now = radar.state;
  off(own::kRateScale) = mean.rate_scale - now.rate_scale;
  off.segment<3>(own::kRotation) = geometry::so3_log(mean.sensor_to_vehicle * now.sensor_to_vehicle.transpose());
  off.segment<3>(own::kEarlierRotation) = geometry::so3_log(mean.earlier * now.earlier.transpose());
  off(own::kStamp) = mean.stamp_s - now.stamp_s;
  off.segment<2>(own::kPosition) = mean.position_error_m - now.position_error_m;
  off.segment<kKnots>(own::kCurve) = mean.curve_rad - now.curve_rad;
  off(own::kMirror) = mean.mirror_share - now.mirror_share;
  w.score = radar.prior * off;
  for (int i = 0; i < segments.size(); ++i) {
    const Share& share = segments.share(i, index);
    if (share.seconds <= 0.0) continue;
    const Segment& segment = segments.segment(i);
    const Reduced r = reduce(share, point(index, segment.load, share.is_earlier),
                             own_variances(radar.fluctuation, segment, share));
    std::array<int, local::kCount> own_of;
    for (int c = 0; c < local::kCount; ++c) own_of[static_cast<std::size_t>(c)] = own_column(c, share.is_earlier);
    const TouchedColumns t = touched(segment, i);
    for (int c = 0; c < local::kCount; ++c) {
      const int column = own_of[static_cast<std::size_t>(c)];
      if (column < 0) continue;
      w.score(column) += r.score(c);
      for (int d = 0; d < local::kCount; ++d) {
        const int other = own_of[static_cast<std::size_t>(d)];
        if (other >= 0) w.system(column, other) += r.information(c, d);
      }
      for (int b = 0; b < t.count; ++b) {
        const Touched& touch = t.columns[static_cast<std::size_t>(b)];
        w.cross(column, touch.border) += r.information(c, touch.local);
      }
    }
    for (int b = 0; b < t.count; ++b) {
      const Touched& one = t.columns[static_cast<std::size_t>(b)];
      border_score_(one.border) += r.score(one.local);
      for (int c = 0; c < t.count; ++c) {
        const Touched& two = t.columns[static_cast<std::size_t>(c)];
        border_system_(one.border, two.border) += r.information(one.local, two.local);
      }
    }
  }
}

void Solver::eliminate(std::size_t index) {
  Eliminated& w = work_[index];
  const Eigen::LDLT<OwnMatrix> solver(w.system);
  w.inverse = solver.solve(OwnMatrix::Identity());
  w.solved.noalias() = w.inverse * w.score;
  const auto cross = w.cross.leftCols(border_);
  border_score_.head(border_).noalias() -= cross.transpose() * w.solved;
  for (int first = 0; first < border_; first += 32) {  // in strips, so that the product needs no memory of its own
    const int width = std::min(32, border_ - first);
    Eigen::Matrix<double, own::kCount, Eigen::Dynamic, Eigen::ColMajor, own::kCount, 32> strip(own::kCount, width);
    strip.noalias() = w.inverse * cross.middleCols(first, width);
    border_system_.topLeftCorner(border_, border_).middleCols(first, width).noalias() -=
        cross.transpose() * strip;
  }
}

void Solver::begin_segment(Segments& segments, int load) const {
  MergeNoise noise;
  noise.common = common_;
  noise.correlation_s = priors_.common_correlation_s;
  for (std::size_t r = 0; r < radars_.size(); ++r) noise.own[r] = radars_[r].fluctuation;
  segments.begin(load, noise);
}

double Solver::common_share(const Segment& segment) const {
  return share_of_mean(std::max(segment.seconds, 0.1), priors_.common_correlation_s);
}

void Solver::solve(Segments& segments) {
  const int count = segments.size();
  if (count == 0) return;
  border_ = shared::kFirstFluctuation + kFluctuations * count;
  border_system_.topLeftCorner(border_, border_).setZero();
  border_score_.head(border_).setZero();
  const auto prior = [&](int column, double std, double off) {
    const double precision = precision_of(std);
    border_system_(column, column) += precision;
    border_score_(column) += precision * off;
  };
  prior(shared::kSpeedScale, priors_.speed_scale_std, 1.0 - shared_.speed_scale);
  prior(shared::kYawRateBias, priors_.yaw_rate_bias_std_radps, -shared_.yaw_rate_bias_radps);
  prior(shared::kYawRateGain, priors_.yaw_rate_gain_std, -shared_.yaw_rate_gain);
  prior(shared::kSlip, priors_.slip_std_radps2pm, -shared_.slip_radps2pm);
  prior(shared::kPitchPerAcceleration, priors_.pitch_per_acceleration_std_radps2pm,
        -shared_.pitch_per_acceleration_radps2pm);
  prior(shared::kStamp, priors_.common_stamp_std_s, -shared_.stamp_s);
  for (int step = 0; step < shared::kLoads; ++step) {
    prior(shared::kLoad + step, priors_.load_std_rad, -shared_.load_rad[static_cast<std::size_t>(step)]);
  }
  for (int k = 0; k < kFluctuations; ++k) {
    const double variance = common_.variance[static_cast<std::size_t>(k)];
    double before = 0.0, length_before = 0.0;
    for (int i = 0; i < count; ++i) {
      const int column = shared::kFirstFluctuation + kFluctuations * i + k;
      if (!(variance > 0.0)) {
        border_system_(column, column) += kFixed;
        continue;
      }
      const double length = std::max(segments.segment(i).seconds, 0.1), tau = priors_.common_correlation_s;
      const double own = variance * common_share(segments.segment(i));
      if (i == 0) {
        border_system_(column, column) += 1.0 / own;
      } else {
        const double shared = variance * square(tau) / (length * length_before) * (1.0 - std::exp(-length / tau)) *
                              (1.0 - std::exp(-length_before / tau));
        const double keep = shared / before, noise = 1.0 / std::max(own - keep * shared, 1e-3 * own);
        border_system_(column, column) += noise;
        border_system_(column - kFluctuations, column - kFluctuations) += keep * keep * noise;
        border_system_(column, column - kFluctuations) -= keep * noise;
        border_system_(column - kFluctuations, column) -= keep * noise;
      }
      before = own;
      length_before = length;
    }
  }
  for (std::size_t r = 0; r < radars_.size(); ++r) gather(segments, r);
  for (std::size_t r = 0; r < radars_.size(); ++r) eliminate(r);
  Eigen::Ref<Eigen::MatrixXd> system = border_system_.topLeftCorner(border_, border_);
  auto inverse = border_inverse_.topLeftCorner(border_, border_);
  inverse.setIdentity();
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> solver(system);
  solver.solveInPlace(inverse);
  border_step_.head(border_).noalias() = inverse * border_score_.head(border_);
  learn(segments);
  for (std::size_t r = 0; r < radars_.size(); ++r) apply(r);
  shared_.speed_scale += border_step_(shared::kSpeedScale);
  shared_.yaw_rate_bias_radps += border_step_(shared::kYawRateBias);
  shared_.yaw_rate_gain += border_step_(shared::kYawRateGain);
  shared_.slip_radps2pm += border_step_(shared::kSlip);
  shared_.pitch_per_acceleration_radps2pm += border_step_(shared::kPitchPerAcceleration);
  shared_.stamp_s += border_step_(shared::kStamp);
  for (int step = 0; step < shared::kLoads; ++step) {
    shared_.load_rad[static_cast<std::size_t>(step)] += border_step_(shared::kLoad + step);
    load_variance_[static_cast<std::size_t>(step)] = inverse(shared::kLoad + step, shared::kLoad + step);
  }
  shared_covariance_ = inverse.topLeftCorner<shared::kConstants, shared::kConstants>();
}

void Solver::apply(std::size_t index) {
  Eliminated& w = work_[index];
  RadarSolution& radar = radars_[index];
  const auto cross = w.cross.leftCols(border_);
  OwnVector back = cross * border_step_.head(border_);
  const OwnVector step = w.solved - w.inverse * back;
  OwnState& s = radar.state;
  s.rate_scale += step(own::kRateScale);
  s.sensor_to_vehicle = geometry::so3_exp(step.segment<3>(own::kRotation)) * s.sensor_to_vehicle;
  s.earlier = geometry::so3_exp(step.segment<3>(own::kEarlierRotation)) * s.earlier;
  s.stamp_s += step(own::kStamp);
  s.position_error_m += step.segment<2>(own::kPosition);
  s.curve_rad += step.segment<kKnots>(own::kCurve);
  s.mirror_share += step(own::kMirror);
  // Covariance: of the own parameters if the shared ones were known, and by those.
  Eigen::Matrix<double, own::kCount, kMaxShared> by_shared;
  by_shared.leftCols(border_).noalias() = cross * border_inverse_.topLeftCorner(border_, border_);
  OwnMatrix spread;
  spread.noalias() = by_shared.leftCols(border_) * cross.transpose();
  radar.covariance = w.inverse + w.inverse * spread * w.inverse;
  radar.with_shared = -w.inverse * by_shared.leftCols<shared::kConstants>();
}

void Solver::learn(Segments& segments) {
  const auto inverse = border_inverse_.topLeftCorner(border_, border_);
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    RadarSolution& radar = radars_[r];
    const Eliminated& w = work_[r];
    const OwnVector step = w.solved - w.inverse * (w.cross.leftCols(border_) * border_step_.head(border_));
    Eigen::Matrix<double, kFluctuations, own::kCount> rows;
    std::array<double, kFluctuations> sum{};
    double segments_used = 0.0;
    for (int i = 0; i < segments.size(); ++i) {
      Share& share = segments.share(i, r);
      if (share.seconds < 1.5) continue;
      const Segment& segment = segments.segment(i);
      const double relative = own_relative(segment);
      const Reduced reduced =
          reduce(share, point(r, segment.load, share.is_earlier), own_variances(radar.fluctuation, segment, share));
      LocalVector d = LocalVector::Zero();
      for (int c = 0; c < local::kCount; ++c) {
        const int column = own_column(c, share.is_earlier);
        if (column >= 0) d(c) += step(column);
      }
      const TouchedColumns t = touched(segment, i);
      for (int b = 0; b < t.count; ++b) {
        const Touched& touch = t.columns[static_cast<std::size_t>(b)];
        d(touch.local) += border_step_(touch.border);
      }
      const Eigen::Matrix<double, kFluctuations, 1> mean =
          reduced.posterior * reduced.raw_score - reduced.gain.transpose() * d;
      // Variance by the parameters: of the radar's own rotation and scale, and of the common fluctuation.
      FluctuationMatrix of_static;
      for (int a = 0; a < kFluctuations; ++a) {
        rows.row(a) = w.inverse.row(own_column(kFluctuating[static_cast<std::size_t>(a)], share.is_earlier));
      }
      const Eigen::Matrix<double, kFluctuations, kMaxShared> along = [&] {
        Eigen::Matrix<double, kFluctuations, kMaxShared> m;
        m.leftCols(border_).noalias() = -rows * w.cross.leftCols(border_);
        for (int a = 0; a < kFluctuations; ++a) m(a, shared::kFirstFluctuation + kFluctuations * i + a) += 1.0;
        return m;
      }();
      for (int a = 0; a < kFluctuations; ++a) {
        for (int b = 0; b < kFluctuations; ++b) {
          of_static(a, b) = rows(a, own_column(kFluctuating[static_cast<std::size_t>(b)], share.is_earlier));
        }
      }
      of_static.noalias() +=
          along.leftCols(border_) * inverse * along.leftCols(border_).transpose();
      FluctuationMatrix gain;
      for (int a = 0; a < kFluctuations; ++a) gain.row(a) = reduced.gain.row(kFluctuating[static_cast<std::size_t>(a)]);
      const FluctuationMatrix covariance = reduced.posterior + gain.transpose() * of_static * gain;
      double distance = 0.0, freedom = 0.0;
      for (int a = 0; a < kFluctuations; ++a) {
        const double variance = relative * radar.fluctuation.variance[static_cast<std::size_t>(a)];
        if (!(variance > 0.0)) continue;
        distance += (square(mean(a)) + covariance(a, a)) / variance;
        freedom += 1.0;
      }
      share.weight = (kSegmentFreedom + freedom) / (kSegmentFreedom + std::max(distance, freedom));
      for (int a = 0; a < kFluctuations; ++a) {
        const auto k = static_cast<std::size_t>(a);
        sum[k] += share.weight * (square(mean(a)) + covariance(a, a)) / relative;
      }
      segments_used += 1.0;
    }
    if (segments_used < 2.0) continue;
    for (std::size_t k = 0; k < kFluctuations; ++k) {
      radar.fluctuation.variance[k] = learnt_variance(radar.fluctuation.variance[k], sum[k], segments_used,
                                                      priors_.own_std[k], priors_.log_fluctuation_std);
    }
  }
  for (int k = 0; k < kFluctuations; ++k) {
    double& variance = common_.variance[static_cast<std::size_t>(k)];
    if (!(variance > 0.0) || segments.size() < 2) continue;
    double sum = 0.0, before = 0.0, length_before = 0.0;
    const double tau = priors_.common_correlation_s;
    for (int i = 0; i < segments.size(); ++i) {
      const int column = shared::kFirstFluctuation + kFluctuations * i + k;
      const double length = std::max(segments.segment(i).seconds, 0.1);
      const double own = common_share(segments.segment(i));
      const double mean_square = square(border_step_(column)) + inverse(column, column);
      if (i == 0) {
        sum += mean_square / own;
      } else {
        const int last = column - kFluctuations;
        const double shared = square(tau) / (length * length_before) * (1.0 - std::exp(-length / tau)) *
                              (1.0 - std::exp(-length_before / tau));
        const double keep = shared / before, noise = std::max(own - keep * shared, 1e-3 * own);
        const double product = border_step_(column) * border_step_(last) + inverse(column, last);
        sum += (mean_square - 2.0 * keep * product +
                keep * keep * (square(border_step_(last)) + inverse(last, last))) /
               noise;
      }
      before = own;
      length_before = length;
    }
    variance = learnt_variance(variance, sum, segments.size(), priors_.common_std[static_cast<std::size_t>(k)],
                               priors_.log_fluctuation_std);
  }
}

LocalMatrix Solver::local_covariance(std::size_t index) const {
  const RadarSolution& radar = radars_[index];
  LocalMatrix p = LocalMatrix::Zero();
  const auto shared_of = [](int c) {
    switch (c) {
      case local::kSpeedScale: return static_cast<int>(shared::kSpeedScale);
      case local::kYawRateBias: return static_cast<int>(shared::kYawRateBias);
      case local::kYawRateGain: return static_cast<int>(shared::kYawRateGain);
      case local::kSlip: return static_cast<int>(shared::kSlip);
      case local::kPitchPerAcceleration: return static_cast<int>(shared::kPitchPerAcceleration);
      case local::kStamp: return static_cast<int>(shared::kStamp);
      default: return -1;
    }
  };
  for (int a = 0; a < local::kCount; ++a) {
    for (int b = 0; b < local::kCount; ++b) {
      const int oa = own_column(a, false), ob = own_column(b, false), sa = shared_of(a), sb = shared_of(b);
      if (oa >= 0 && ob >= 0) p(a, b) += radar.covariance(oa, ob);
      if (sa >= 0 && sb >= 0) p(a, b) += shared_covariance_(sa, sb);
      if (oa >= 0 && sb >= 0) p(a, b) += radar.with_shared(oa, sb);
      if (sa >= 0 && ob >= 0) p(a, b) += radar.with_shared(ob, sa);
    }
  }
  return p;
}

}  // namespace boresight::alignment::windows
