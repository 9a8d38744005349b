// Places of the parameters in the equations of the solution.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/alignment_estimator/core/windows/reduced.hpp"
#include "services/alignment_estimator/core/windows/solver.hpp"

namespace boresight::alignment::windows {

/// Precision of a parameter that is not estimated.
inline constexpr double kFixedPrecision = 1e18;

[[nodiscard]] inline double precision_of(double std) {
  return std > 0.0 ? 1.0 / square(std) : kFixedPrecision;
}

/// Where a local parameter stands among the radar's own; −1: it is the vehicle's.
[[nodiscard]] inline int own_column(int local) {
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
[[nodiscard]] inline int shared_column(int local) {
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
[[nodiscard]] inline LocalMatrix covariance_of_constants(
    const OwnMatrix& own, const Eigen::Matrix<double, own::kCount, shared::kConstants>& cross,
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

/// A radar's own parameter and the local one that it acts on. The drifts act on the rotation. A load turns the axes of
/// the mounting: Exp(λ·y)·Exp(δ) = Exp(d)·Exp(λ·y) with d = Exp(λ·y)·δ, so that its roll acts on yaw.
struct OwnAction {
  int own, local;
  double factor;
};
struct OwnActions {
  std::array<OwnAction, own::kCount + 2> actions;
  OwnActions(double drift_time_s, double load_rad) {
    std::size_t n = 0;
    for (int c = 0; c < local::kCount; ++c) {
      if (own_column(c) >= 0) actions[n++] = {own_column(c), c, 1.0};
    }
    actions[n++] = {own::kPitchDrift, local::kRotation + 1, drift_time_s};
    actions[n++] = {own::kYawDrift, local::kRotation + 2, drift_time_s};
    actions[n++] = {own::kRotation, local::kRotation + 2, -load_rad};
    actions[n++] = {own::kRotation + 2, local::kRotation, load_rad};
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

[[nodiscard]] inline TouchedColumns touched(const Segment& segment, int index) {
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

/// A common fluctuation's means over neighbouring segments as a Markov chain: mean(i) = keep·mean(i − 1) + noise, with
/// the variance of the noise relative to the fluctuation's.
struct ChainLink {
  double keep = 0.0, noise = 1.0;
};

[[nodiscard]] inline ChainLink chain_link(const Segments& segments, int i, double tau_s) {
  const auto length = [&](int of) { return std::max(segments.segment(of).seconds, 0.1); };
  const double own = share_of_mean(length(i), tau_s);
  if (i == 0) return {0.0, own};
  const double shared = square(tau_s) / (length(i) * length(i - 1)) * (1.0 - std::exp(-length(i) / tau_s)) *
                        (1.0 - std::exp(-length(i - 1) / tau_s));
  const double keep = shared / share_of_mean(length(i - 1), tau_s);
  return {keep, std::max(own - keep * shared, 1e-3 * own)};
}

}  // namespace boresight::alignment::windows
