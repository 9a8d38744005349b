// Which components of the sensor's velocity the directions of the detections really span, and how much of that the
// noise of the angles only feigns.
#pragma once

#include <Eigen/Core>

namespace boresight::alignment {

struct Support {
  /// The matrix T by which scores are multiplied, information becomes T·M·Tᵀ: a share 1 − f of the score along each
  /// principal direction, f the feigned share, and nothing where next to all is feigned. Score and information agree
  /// then: E[T·m] = T·M·Tᵀ·δg, and noise alone never adds up to information.
  Eigen::Matrix3d share = Eigen::Matrix3d::Zero();
  /// A: where the angles' variance is exp(δ) times what is assumed, the velocity that is measured is g + δ·A·g (to
  /// first order): so much more of the spread is noise.
  Eigen::Matrix3d by_angle_noise = Eigen::Matrix3d::Zero();
  int directions = 0;  ///< that are supported; two, a plane, say nothing of how it is tilted
};

/// Sliding means of a radar's information and of its feigned part (ScanSums).
class Spread {
 public:
  /// `has_elevation`: else the third component is never supported.
  void add(const Eigen::Matrix3d& information, const Eigen::Matrix3d& feigned, double inliers, double keep);
  void clear() { *this = {}; }
  /// `log_noise_std`: σ of ln of what the angles' variance really is over what was taken for it.
  [[nodiscard]] Support support(bool has_elevation, double log_noise_std) const;

 private:
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d feigned_ = Eigen::Matrix3d::Zero();
  double inliers_ = 0.0;
};

}  // namespace boresight::alignment
