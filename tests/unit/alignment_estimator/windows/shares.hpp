// Information of segments for tests: random, with every parameter observable.
#pragma once

#include <random>

#include "services/alignment_estimator/core/windows/priors.hpp"
#include "services/alignment_estimator/core/windows/segment.hpp"
#include "tests/unit/alignment_estimator/windows/points.hpp"

namespace boresight::alignment::windows {

/// Prior standard deviations of the local parameters.
inline LocalVector local_stds(const Priors& p) {
  LocalVector s;
  s(local::kSpeedScale) = p.speed_scale_std;
  s(local::kRateScale) = p.rate_scale_std;
  s.segment<3>(local::kRotation).setConstant(p.rotation_std_rad);
  s(local::kYawRateBias) = p.yaw_rate_bias_std_radps;
  s(local::kYawRateGain) = p.yaw_rate_gain_std;
  s(local::kSlip) = p.slip_std_radps2pm;
  s(local::kStamp) = p.stamp_std_s;
  s.segment<2>(local::kPosition).setConstant(p.position_std_m);
  s(local::kPitchPerAcceleration) = p.pitch_per_acceleration_std_radps2pm;
  s.segment<kKnots>(local::kCurve).setConstant(p.curve_std_rad);
  s(local::kAbove) = p.height_excess_std;
  s(local::kMirror) = p.mirror_share_std;
  return s;
}

class RandomShares {
 public:
  explicit RandomShares(unsigned seed) : random_(seed) {}
  /// Information of some priors' size and more, and a score that asks for steps of the priors' size.
  [[nodiscard]] Share next(const Point& point, double seconds) {
    std::normal_distribution<double> normal(0.0, 1.0);
    const LocalVector inverse = local_stds(Priors{}).cwiseInverse();
    LocalMatrix root;
    LocalVector score;
    for (int i = 0; i < local::kCount; ++i) {
      score(i) = normal(random_);
      for (int j = 0; j < local::kCount; ++j) root(i, j) = normal(random_);
    }
    LocalMatrix information = 0.3 * root * root.transpose();
    information.diagonal().array() += 0.5;
    Share share;
    share.point = point;
    share.information = inverse.asDiagonal() * information * inverse.asDiagonal();
    share.score = inverse.asDiagonal() * score;
    share.seconds = seconds;
    return share;
  }
  /// The same as a block of a second.
  [[nodiscard]] Block block(const Point& point) {
    const Share share = next(point, 1.0);
    Block b;
    b.clear(point);
    b.information = share.information;
    b.score = share.score;
    b.seconds = 1.0;
    b.scans = 20;
    return b;
  }

 private:
  std::mt19937 random_;
};

}  // namespace boresight::alignment::windows
