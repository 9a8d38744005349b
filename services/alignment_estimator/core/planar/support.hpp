// Which of k_v, α, β, γ the detections of a radar determine, as distinct from the effect of their noise.
#pragma once

#include <Eigen/Core>

#include "services/alignment_estimator/core/planar/planar_sums.hpp"

namespace boresight::alignment::planar {

/// Noise of the angles makes equal directions look different, so β and γ look measured even if all detections lie at
/// one elevation. Parameter directions whose information does not clearly exceed that of noise alone are excluded. The
/// part of the noise is subtracted from the others.
class Support {
 public:
  /// Sums fade by `keep` (0…1).
  void add(const Sums& sums, double keep);
  /// Updates the support for the next scans from the sums so far. Without elevation, or with all detections at one
  /// elevation, β and γ are excluded: their rows then come from the error of the estimate.
  void renew(bool has_elevation);
  /// Whether elevations are measured and spread by more than their noise.
  [[nodiscard]] bool has_elevation() const { return has_elevation_; }
  [[nodiscard]] Square information(const Square& information) const {
    return share_ * information * share_.transpose();
  }
  [[nodiscard]] Parameters score(const Parameters& score) const { return kept_ * score; }

 private:
  Eigen::Matrix4d information_ = Eigen::Matrix4d::Zero(), from_noise_ = Eigen::Matrix4d::Zero();
  double inliers_ = 0.0, elevation_ = 0.0, elevation_square_ = 0.0, elevation_variance_ = 0.0;
  bool has_elevation_ = false;
  Square share_ = Square::Zero(), kept_ = Square::Zero();
};

}  // namespace boresight::alignment::planar
