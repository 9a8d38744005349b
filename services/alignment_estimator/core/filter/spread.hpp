// Components of the sensor's velocity that the directions of the detections span, without the part that comes from the
// noise of the angles only.
// Equations: docs/algorithms/alignment.md (A13)(A14).
#pragma once

#include <Eigen/Core>

namespace boresight::alignment {

struct Support {
  /// The matrix T that multiplies scores; information becomes T·M·Tᵀ. Along each principal direction, T keeps the share
  /// 1 − f of the score, with f the share that comes from noise, and nothing if f is close to 1. Score and information
  /// then agree: E[T·m] = T·M·Tᵀ·δg, and noise alone never accumulates as information.
  Eigen::Matrix3d share = Eigen::Matrix3d::Zero();
  /// The same with 1 for each supported direction: for scores and information that already lack the part of the noise.
  Eigen::Matrix3d supported = Eigen::Matrix3d::Zero();
  int directions = 0;  ///< number of supported directions; two form a plane, whose tilt is not determined
};

/// Sliding means of a radar's information and of the part that comes from noise (ScanSums).
class Spread {
 public:
  /// Without `has_elevation` the third component is never supported.
  void add(const Eigen::Matrix3d& information, const Eigen::Matrix3d& from_noise, double inliers, double keep);
  void clear() { *this = {}; }
  /// `log_noise_std`: σ of ln(real / assumed variance of the angles).
  [[nodiscard]] Support support(bool has_elevation, double log_noise_std) const;

 private:
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d from_noise_ = Eigen::Matrix3d::Zero();
  double inliers_ = 0.0;
};

}  // namespace boresight::alignment
