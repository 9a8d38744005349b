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
    for (int j = 0; j < kKnots; ++j)
      alike(i, j) = std::exp(-0.5 * square((i - j) / length_knots)) + (i == j ? 1e-4 : 0.0);
  }
  weights /= weights.sum();
  project.rowwise() -= weights.transpose();
  Square covariance = project * alike * project.transpose();
  covariance *= square(std) / covariance.diagonal().mean();
  covariance.diagonal().array() += 1e-6 * square(std) + 1e-16;
  return covariance.inverse();
}

/// A common fluctuation's means over neighbouring segments as a Markov chain: mean(i) = keep·mean(i − 1) + noise, with
/// the variance of the noise relative to the fluctuation's.
struct ChainLink {
  double keep = 0.0, noise = 1.0;
};

ChainLink chain_link(const Segments& segments, int i, double tau_s) {
  const auto length = [&](int of) { return std::max(segments.segment(of).seconds, 0.1); };
  const double own = share_of_mean(length(i), tau_s);
  if (i == 0) return {0.0, own};
  const double shared = square(tau_s) / (length(i) * length(i - 1)) * (1.0 - std::exp(-length(i) / tau_s)) *
                        (1.0 - std::exp(-length(i - 1) / tau_s));
  const double keep = shared / share_of_mean(length(i - 1), tau_s);
  return {keep, std::max(own - keep * shared, 1e-3 * own)};
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
  const auto scale_of = [](double std) { return std::max(std, 1e-6); };
  scale_(local::kSpeedScale) = scale_of(priors.speed_scale_std);
  scale_(local::kRateScale) = scale_of(priors.rate_scale_std);
  scale_.segment<3>(local::kRotation).setConstant(scale_of(priors.rotation_std_rad));
  scale_(local::kYawRateBias) = scale_of(priors.yaw_rate_bias_std_radps);
  scale_(local::kYawRateGain) = scale_of(priors.yaw_rate_gain_std);
  scale_(local::kSlip) = scale_of(priors.slip_std_radps2pm);
  scale_(local::kStamp) = scale_of(priors.common_stamp_std_s + priors.stamp_std_s);
  scale_.segment<2>(local::kPosition).setConstant(scale_of(priors.position_std_m));
  scale_(local::kPitchPerAcceleration) = scale_of(priors.pitch_per_acceleration_std_radps2pm);
  scale_.segment<kKnots>(local::kCurve).setConstant(scale_of(priors.curve_std_rad));
  scale_(local::kAbove) = scale_of(priors.height_excess_std);
  scale_(local::kMirror) = scale_of(priors.mirror_share_std);
  correlation_s_.fill(priors.common_correlation_s);
  median_correlation_s_ = correlation_s_;
  median_common_std_ = priors.common_std;
  shared_covariance_.setZero();
  shared_covariance_.diagonal() << square(priors.speed_scale_std), square(priors.yaw_rate_bias_std_radps),
      square(priors.yaw_rate_gain_std), square(priors.slip_std_radps2pm),
      square(priors.pitch_per_acceleration_std_radps2pm), square(priors.common_stamp_std_s);
  shared_prior_ = shared_covariance_.diagonal().cwiseMax(1.0 / kFixed).cwiseInverse().asDiagonal();
  for (int k = 0; k < kFluctuations; ++k) {
    const auto i = static_cast<std::size_t>(k);
    common_.variance[i] = radars > 1 ? square(priors.common_std[i]) : 0.0;
  }
}

void Solver::set_prior(std::size_t radar, const Eigen::Matrix3d& nominal, bool has_elevation, double knot_step_rad) {
  RadarSolution& r = radars_[radar];
  r.state = OwnState();
  r.state.sensor_to_vehicle = nominal;
  r.prior_state = r.state;
  r.has_elevation = has_elevation;
  r.prior.setZero();
  r.prior(own::kRateScale, own::kRateScale) = precision_of(priors_.rate_scale_std);
  for (int axis = 0; axis < 3; ++axis) {
    const double precision = axis == 2 || has_elevation ? precision_of(priors_.rotation_std_rad) : kFixed;
    r.prior(own::kRotation + axis, own::kRotation + axis) = precision;
  }
  r.prior(own::kAbove, own::kAbove) = has_elevation ? precision_of(priors_.height_excess_std) : kFixed;
  r.prior(own::kMirror, own::kMirror) = has_elevation ? precision_of(priors_.mirror_share_std) : kFixed;
  r.prior(own::kStamp, own::kStamp) = precision_of(priors_.stamp_std_s);
  r.prior(own::kPosition, own::kPosition) = r.prior(own::kPosition + 1, own::kPosition + 1) =
      precision_of(priors_.position_std_m);
  r.prior.block<kKnots, kKnots>(own::kCurve, own::kCurve) =
      priors_.curve_std_rad > 0.0 ? curve_precision(priors_.curve_std_rad, priors_.curve_length_rad / knot_step_rad)
                                  : kFixed * Eigen::Matrix<double, kKnots, kKnots>::Identity();
  r.drift_variance = {has_elevation ? square(priors_.drift_std_radps) : 0.0, square(priors_.drift_std_radps)};
  r.covariance = r.prior.diagonal().cwiseMax(1e-12).cwiseInverse().asDiagonal();
  r.covariance.diagonal().segment<kKnots>(own::kCurve).setConstant(square(priors_.curve_std_rad));
  r.covariance.diagonal().tail<2>() << r.drift_variance[0], r.drift_variance[1];
  r.conditional = r.covariance;
  r.with_shared.setZero();
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    r.fluctuation.variance[k] = k == 1 && !has_elevation ? 0.0 : square(priors_.own_std[k]);
    r.median_std[k] = priors_.own_std[k];
  }
}

double Solver::drift_time(double middle_s) const {
  return std::max(middle_s - time_s_, -priors_.drift_span_s);
}

double Solver::load_rad(int steps) const {
  double sum = shared_.first_load_rad;
  for (int step = 0; step < steps; ++step) sum += shared_.load_rad[static_cast<std::size_t>(step)];
  return sum;
}

void Solver::turn(std::size_t index, const Eigen::Vector3d& turn_vehicle_rad) {
  stop();
  RadarSolution& radar = radars_[index];
  OwnState& s = radar.state;
  s.sensor_to_vehicle = geometry::so3_exp(turn_vehicle_rad) * s.sensor_to_vehicle;
  s.drift_radps.setZero();
  radar.prior_state.sensor_to_vehicle = s.sensor_to_vehicle;
  radar.drift_variance = {radar.has_elevation ? square(priors_.drift_std_radps) : 0.0, square(priors_.drift_std_radps)};
  for (int axis = 0; axis < 3; ++axis) {
    const int c = own::kRotation + axis;
    const double std_rad = axis == 0 ? priors_.rotation_std_rad : priors_.turned_std_rad;
    const double precision = radar.has_elevation || axis == 2 ? precision_of(std_rad) : kFixed;
    radar.prior.row(c).setZero();
    radar.prior.col(c).setZero();
    radar.prior(c, c) = precision;
    radar.covariance.row(c).setZero();
    radar.covariance.col(c).setZero();
    radar.with_shared.row(c).setZero();
    radar.covariance(c, c) = 1.0 / precision;
    radar.conditional.row(c) = radar.covariance.row(c);
    radar.conditional.col(c) = radar.covariance.col(c);
  }
}

void Solver::remove_load(int step) {
  stop();
  for (int i = step; i + 1 < shared::kLoads; ++i) {
    shared_.load_rad[static_cast<std::size_t>(i)] = shared_.load_rad[static_cast<std::size_t>(i + 1)];
  }
  shared_.load_rad.back() = 0.0;
}

void Solver::absorb_first_load() {
  shared_.first_load_rad += shared_.load_rad.front();
  remove_load(0);
}

Point Solver::point(std::size_t radar, double time_s, int load) const {
  const OwnState& own = radars_[radar].state;
  Point p;
  const double since_s = drift_time(time_s);
  const double pitch_rad = own.drift_radps(0) * since_s + load_rad(load);
  p.speed_scale = shared_.speed_scale;
  p.rate_scale = own.rate_scale;
  p.sensor_to_vehicle = geometry::so3_exp({0.0, pitch_rad, own.drift_radps(1) * since_s}) * own.sensor_to_vehicle;
  p.yaw_rate_bias_radps = shared_.yaw_rate_bias_radps;
  p.yaw_rate_gain = shared_.yaw_rate_gain;
  p.slip_radps2pm = shared_.slip_radps2pm;
  p.stamp_s = shared_.stamp_s + own.stamp_s;
  p.position_error_m = own.position_error_m;
  p.pitch_per_acceleration_radps2pm = shared_.pitch_per_acceleration_radps2pm;
  p.curve_rad = own.curve_rad;
  p.height_excess = own.height_excess;
  p.mirror_share = own.mirror_share;
  return p;
}

namespace {

/// Where a local parameter stands among the radar's own; −1: it is the vehicle's.
int own_column(int local) {
  if (local == local::kRateScale) return own::kRateScale;
  if (local >= local::kRotation && local < local::kRotation + 3) return own::kRotation + local - local::kRotation;
  if (local == local::kStamp) return own::kStamp;
  if (local == local::kPosition || local == local::kPosition + 1) return own::kPosition + local - local::kPosition;
  if (local == local::kAbove) return own::kAbove;
  if (local == local::kMirror) return own::kMirror;
  if (local >= local::kCurve) return own::kCurve + local - local::kCurve;
  return -1;
}

/// Where the others stand among the vehicle's.
int shared_column(int local) {
  switch (local) {
    case local::kSpeedScale:
      return shared::kSpeedScale;
    case local::kYawRateBias:
      return shared::kYawRateBias;
    case local::kYawRateGain:
      return shared::kYawRateGain;
    case local::kSlip:
      return shared::kSlip;
    case local::kPitchPerAcceleration:
      return shared::kPitchPerAcceleration;
    default:
      return -1;
  }
}

/// Covariance of the local parameters. The stamp is the sum of one of the radar and one of the vehicle.
LocalMatrix covariance_of_constants(const OwnMatrix& own,
                                    const Eigen::Matrix<double, own::kCount, shared::kConstants>& cross,
                                    const SharedMatrix& shared) {
  LocalMatrix p = LocalMatrix::Zero();
  for (int a = 0; a < local::kCount; ++a) {
    const int oa = own_column(a), sa = a == local::kStamp ? static_cast<int>(shared::kStamp) : shared_column(a);
    for (int b = 0; b < local::kCount; ++b) {
      const int ob = own_column(b), sb = b == local::kStamp ? static_cast<int>(shared::kStamp) : shared_column(b);
      if (oa >= 0 && ob >= 0) p(a, b) += own(oa, ob);
      if (sa >= 0 && sb >= 0) p(a, b) += shared(sa, sb);
      if (oa >= 0 && sb >= 0) p(a, b) += cross(oa, sb);
      if (sa >= 0 && ob >= 0) p(a, b) += cross(ob, sa);
    }
  }
  return p;
}

/// A radar's own parameter and the local one that it acts on; the drifts act on the rotation.
struct OwnAction {
  int own, local;
  double factor;
};
struct OwnActions {
  std::array<OwnAction, own::kCount> actions;
  explicit OwnActions(double drift_time_s) {
    std::size_t n = 0;
    for (int c = 0; c < local::kCount; ++c) {
      if (own_column(c) >= 0) actions[n++] = {own_column(c), c, 1.0};
    }
    actions[n++] = {own::kPitchDrift, local::kRotation + 1, drift_time_s};
    actions[n++] = {own::kYawDrift, local::kRotation + 2, drift_time_s};
  }
};

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

void Solver::gather(Segments& segments, std::size_t index) {
  Eliminated& w = work_[index];
  const RadarSolution& radar = radars_[index];
  w.system = radar.prior;
  w.cross.leftCols(border_).setZero();
  OwnVector off;  // of the prior's mean from the present point
  const OwnState &mean = radar.prior_state, &now = radar.state;
  off(own::kRateScale) = mean.rate_scale - now.rate_scale;
  off.segment<3>(own::kRotation) = geometry::so3_log(mean.sensor_to_vehicle * now.sensor_to_vehicle.transpose());
  off(own::kStamp) = mean.stamp_s - now.stamp_s;
  off.segment<2>(own::kPosition) = mean.position_error_m - now.position_error_m;
  off.segment<kKnots>(own::kCurve) = mean.curve_rad - now.curve_rad;
  off(own::kAbove) = mean.height_excess - now.height_excess;
  off(own::kMirror) = mean.mirror_share - now.mirror_share;
  off.tail<2>() = -now.drift_radps;
  for (int axis = 0; axis < 2; ++axis) {
    const double variance = radar.drift_variance[static_cast<std::size_t>(axis)];
    w.system(own::kPitchDrift + axis, own::kPitchDrift + axis) = variance > 0.0 ? 1.0 / variance : kFixed;
  }
  w.score = w.system * off;
  for (int i = 0; i < segments.size(); ++i) {
    Share& share = segments.share(i, index);
    if (share.seconds <= 0.0) continue;
    if (!share.positive) make_positive(share, scale_);
    const Segment& segment = segments.segment(i);
    const Reduced r =
        reduce(share, point(index, segment.middle_s, segment.load), own_variances(radar.fluctuation, segment, share));
    const OwnActions of_own(drift_time(segment.middle_s));
    const TouchedColumns t = touched(segment, i);
    for (const OwnAction& a : of_own.actions) {
      w.score(a.own) += a.factor * r.score(a.local);
      for (const OwnAction& b : of_own.actions) {
        w.system(a.own, b.own) += a.factor * b.factor * r.information(a.local, b.local);
      }
      for (int b = 0; b < t.count; ++b) {
        const Touched& touch = t.columns[static_cast<std::size_t>(b)];
        w.cross(a.own, touch.border) += a.factor * r.information(a.local, touch.local);
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
  Eigen::LLT<OwnMatrix> solver(w.system);
  // Few detections with much noise of the angles: less than nothing. The prior holds.
  for (double more = 1.0; solver.info() != Eigen::Success && more < 1e9; more *= 10.0) {
    w.system.diagonal() += more * radars_[index].prior.diagonal().cwiseMax(1e-6);
    solver.compute(w.system);
  }
  w.inverse = solver.solve(OwnMatrix::Identity());
  w.solved.noalias() = w.inverse * w.score;
  const auto cross = w.cross.leftCols(border_);
  border_score_.head(border_).noalias() -= cross.transpose() * w.solved;
  for (int first = 0; first < border_; first += 32) {  // in strips, so that the product needs no memory of its own
    const int width = std::min(32, border_ - first);
    Eigen::Matrix<double, own::kCount, Eigen::Dynamic, Eigen::ColMajor, own::kCount, 32> strip(own::kCount, width);
    strip.noalias() = w.inverse * cross.middleCols(first, width);
    border_system_.topLeftCorner(border_, border_).middleCols(first, width).noalias() -= cross.transpose() * strip;
  }
}

MergeNoise Solver::merge_noise() const {
  MergeNoise noise;
  noise.common = common_;
  noise.correlation_s = correlation_s_;
  for (std::size_t r = 0; r < radars_.size(); ++r) noise.own[r] = radars_[r].fluctuation;
  return noise;
}

void Solver::begin(double time_s) {
  // The rotations move with their drift to the new time.
  const double since_s = time_s - time_s_;
  for (RadarSolution& r : radars_) {
    const Eigen::Vector2d turn = r.state.drift_radps * since_s;
    r.state.sensor_to_vehicle = geometry::so3_exp({0.0, turn(0), turn(1)}) * r.state.sensor_to_vehicle;
  }
  time_s_ = time_s;
  stage_ = Stage::kPrior;
}

bool Solver::step(Segments& segments) {
  switch (stage_) {
    case Stage::kIdle:
      return true;
    case Stage::kPrior:
      if (segments.size() == 0) {
        stage_ = Stage::kIdle;
        return true;
      }
      begin_border(segments);
      next_ = 0;
      stage_ = Stage::kRadars;
      return false;
    case Stage::kRadars:
      gather(segments, next_);
      eliminate(next_);
      if (++next_ == radars_.size()) stage_ = Stage::kBorder;
      return false;
    case Stage::kBorder:
      solve_border();
      next_ = 0;
      stage_ = Stage::kLearn;
      return false;
    case Stage::kLearn:
      learn(segments, next_);
      if (++next_ == radars_.size()) stage_ = Stage::kCommit;
      return false;
    case Stage::kCommit:
      learn_common(segments);
      commit();
      stage_ = Stage::kIdle;
      return true;
  }
  return true;
}

void Solver::begin_border(const Segments& segments) {
  const int count = segments.size();
  border_ = shared::kFirstFluctuation + kFluctuations * count;
  border_system_.topLeftCorner(border_, border_).setZero();
  border_score_.head(border_).setZero();
  const auto prior = [&](int column, double std, double off) {
    const double precision = precision_of(std);
    border_system_(column, column) += precision;
    border_score_(column) += precision * off;
  };
  border_system_.topLeftCorner<shared::kConstants, shared::kConstants>() = shared_prior_;
  Eigen::Matrix<double, shared::kConstants, 1> off_constants;
  off_constants << prior_shared_.speed_scale - shared_.speed_scale,
      prior_shared_.yaw_rate_bias_radps - shared_.yaw_rate_bias_radps,
      prior_shared_.yaw_rate_gain - shared_.yaw_rate_gain, prior_shared_.slip_radps2pm - shared_.slip_radps2pm,
      prior_shared_.pitch_per_acceleration_radps2pm - shared_.pitch_per_acceleration_radps2pm,
      prior_shared_.stamp_s - shared_.stamp_s;
  border_score_.head<shared::kConstants>().noalias() = shared_prior_ * off_constants;
  for (int step = 0; step < shared::kLoads; ++step) {
    prior(shared::kLoad + step, priors_.load_std_rad, -shared_.load_rad[static_cast<std::size_t>(step)]);
  }
  for (int k = 0; k < kFluctuations; ++k) {
    const double variance = common_.variance[static_cast<std::size_t>(k)];
    for (int i = 0; i < count; ++i) {
      const int column = shared::kFirstFluctuation + kFluctuations * i + k;
      if (!(variance > 0.0)) {
        border_system_(column, column) += kFixed;
        continue;
      }
      const ChainLink link = chain_link(segments, i, correlation_s_[static_cast<std::size_t>(k)]);
      const double precision = 1.0 / (variance * link.noise);
      border_system_(column, column) += precision;
      if (i == 0) continue;
      const int last = column - kFluctuations;
      border_system_(last, last) += link.keep * link.keep * precision;
      border_system_(column, last) -= link.keep * precision;
      border_system_(last, column) -= link.keep * precision;
    }
  }
}

void Solver::solve_border() {
  Eigen::Ref<Eigen::MatrixXd> system = border_system_.topLeftCorner(border_, border_);
  auto inverse = border_inverse_.topLeftCorner(border_, border_);
  inverse.setIdentity();
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> solver(system);
  solver.solveInPlace(inverse);
  border_step_.head(border_).noalias() = inverse * border_score_.head(border_);
}

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
  std::array<double, kFluctuations> sum{};
  double segments_used = 0.0;
  for (int i = 0; i < segments.size(); ++i) {
    Share& share = segments.share(i, index);
    if (share.seconds < 1.5) continue;
    const Segment& segment = segments.segment(i);
    const double relative = own_relative(segment);
    const Reduced reduced =
        reduce(share, point(index, segment.middle_s, segment.load), own_variances(radar.fluctuation, segment, share));
    LocalVector d = LocalVector::Zero();
    for (const OwnAction& a : OwnActions(drift_time(segment.middle_s)).actions) d(a.local) += a.factor * w.step(a.own);
    const TouchedColumns t = touched(segment, i);
    for (int b = 0; b < t.count; ++b) {
      const Touched& touch = t.columns[static_cast<std::size_t>(b)];
      d(touch.local) += border_step_(touch.border);
    }
    const FluctuationVector mean = reduced.posterior * reduced.raw_score - reduced.gain.transpose() * d;
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
    const FluctuationColumns spread = of_static * reduced.gain;
    const FluctuationMatrix covariance = reduced.posterior + reduced.gain.transpose() * spread;
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
    }
    segments_used += 1.0;
  }
  if (segments_used >= 2.0) {
    for (std::size_t k = 0; k < kFluctuations; ++k) {
      radar.fluctuation.variance[k] = learnt_variance(radar.fluctuation.variance[k], sum[k], segments_used,
                                                      radar.median_std[k], priors_.log_fluctuation_std);
    }
    for (int axis = 0; axis < 2; ++axis) {
      const int c = own::kPitchDrift + axis;
      double& variance = radar.drift_variance[static_cast<std::size_t>(axis)];
      variance = learnt_variance(variance, square(radar.state.drift_radps(axis) + w.step(c)) + w.covariance(c, c), 1.0,
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
    // Expected log likelihood of the chain with this correlation time and the variance that fits best to it.
    double fitting = variance;
    const auto likelihood = [&](double tau_s) {
      double sum = 0.0, log_noise = 0.0;
      for (int i = 0; i < segments.size(); ++i) {
        const int column = shared::kFirstFluctuation + kFluctuations * i + k;
        const ChainLink link = chain_link(segments, i, tau_s);
        double square_of_noise = square(border_step_(column)) + inverse(column, column);
        if (i > 0) {
          const int last = column - kFluctuations;
          square_of_noise += square(link.keep) * (square(border_step_(last)) + inverse(last, last)) -
                             2.0 * link.keep * (border_step_(column) * border_step_(last) + inverse(column, last));
        }
        sum += square_of_noise / link.noise;
        log_noise += std::log(link.noise);
      }
      const double median_std = median_common_std_[static_cast<std::size_t>(k)];
      fitting = learnt_variance(variance, sum, segments.size(), median_std, priors_.log_fluctuation_std);
      return -0.5 * (log_noise + segments.size() * std::log(fitting) + sum / fitting) -
             0.5 * square(0.5 * std::log(fitting / square(median_std)) / priors_.log_fluctuation_std) -
             0.5 * square(std::log(tau_s / median_correlation_s_[static_cast<std::size_t>(k)]) /
                          priors_.log_correlation_std);
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
    (void)likelihood(tau_s);
    variance = fitting;
  }
}

void Solver::commit() {
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const Eliminated& w = work_[r];
    RadarSolution& radar = radars_[r];
    OwnState& s = radar.state;
    s.rate_scale += w.step(own::kRateScale);
    s.sensor_to_vehicle = geometry::so3_exp(w.step.segment<3>(own::kRotation)) * s.sensor_to_vehicle;
    s.stamp_s += w.step(own::kStamp);
    s.position_error_m += w.step.segment<2>(own::kPosition);
    s.curve_rad += w.step.segment<kKnots>(own::kCurve);
    s.height_excess += w.step(own::kAbove);
    s.mirror_share += w.step(own::kMirror);
    s.drift_radps += w.step.tail<2>();
    radar.covariance = w.covariance;
    radar.conditional = w.inverse;
    radar.with_shared = w.with_shared;
  }
  shared_.speed_scale += border_step_(shared::kSpeedScale);
  shared_.yaw_rate_bias_radps += border_step_(shared::kYawRateBias);
  shared_.yaw_rate_gain += border_step_(shared::kYawRateGain);
  shared_.slip_radps2pm += border_step_(shared::kSlip);
  shared_.pitch_per_acceleration_radps2pm += border_step_(shared::kPitchPerAcceleration);
  shared_.stamp_s += border_step_(shared::kStamp);
  const auto inverse = border_inverse_.topLeftCorner(border_, border_);
  for (int step = 0; step < shared::kLoads; ++step) {
    shared_.load_rad[static_cast<std::size_t>(step)] += border_step_(shared::kLoad + step);
    load_variance_[static_cast<std::size_t>(step)] = inverse(shared::kLoad + step, shared::kLoad + step);
  }
  shared_covariance_ = inverse.topLeftCorner<shared::kConstants, shared::kConstants>();
}

LocalMatrix Solver::local_covariance(std::size_t index) const {
  const RadarSolution& radar = radars_[index];
  return covariance_of_constants(radar.covariance, radar.with_shared, shared_covariance_);
}

}  // namespace boresight::alignment::windows
