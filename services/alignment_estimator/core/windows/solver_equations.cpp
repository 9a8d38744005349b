// The equations of the solution: gathered from the segments, each radar eliminated on its own.
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/alignment_estimator/core/windows/equations.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment::windows {

Reduced Solver::reduced(const Share& share, const Segment& segment, std::size_t index) const {
  const std::array<double, kFluctuations> own = own_variances(radars_[index].fluctuation, segment, share);
  return reduce(share, point(index, segment.middle_s, segment.load), own, square(priors_.roll_per_pitch) * own[1]);
}

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
    w.system(own::kPitchDrift + axis, own::kPitchDrift + axis) = variance > 0.0 ? 1.0 / variance : kFixedPrecision;
  }
  w.score = w.system * off;
  for (int i = 0; i < segments.size(); ++i) {
    Share& share = segments.share(i, index);
    if (share.seconds <= 0.0) continue;
    if (!share.positive) make_positive(share, scale_);
    const Segment& segment = segments.segment(i);
    const Reduced r = reduced(share, segment, index);
    const OwnActions of_own(drift_time(segment.middle_s), load_rad(segment.load));
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
        border_system_(column, column) += kFixedPrecision;
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
  // Some columns at a time: the work space of all of them would be on the heap.
  constexpr Eigen::Index kColumns = 32;
  for (Eigen::Index first = 0; first < border_; first += kColumns) {
    auto columns = inverse.middleCols(first, std::min<Eigen::Index>(kColumns, border_ - first));
    solver.solveInPlace(columns);
  }
  border_step_.head(border_).noalias() = inverse * border_score_.head(border_);
}

}  // namespace boresight::alignment::windows
