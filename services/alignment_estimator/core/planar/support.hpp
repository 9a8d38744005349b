// Which of k_v, α, β, γ the detections of a radar really tell apart, and which are only feigned by their noise.
#pragma once

#include <Eigen/Core>

#include "services/alignment_estimator/core/planar/planar_sums.hpp"

namespace boresight::alignment::planar {

/// Noise of the angles makes equal directions look different, and so β and γ look measured where all that is seen lies
/// at one elevation. Directions of the parameters whose information does not clearly exceed what that noise makes of
/// none are left out; of the others the noise's part is taken off.
class Support {
 public:
  /// Sums fade by `keep` (0…1).
  void add(const Sums& sums, double keep);
  /// For scans from now on, from what was added until now. Without elevation, or if all is seen at one, β and γ are
  /// left out: what their rows hold then comes of the estimate's own error.
  void renew(bool has_elevation);
  /// Whether elevations are measured and spread by more than their noise.
  [[nodiscard]] bool has_elevation() const { return has_elevation_; }
  [[nodiscard]] Square information(const Square& information) const {
    return share_ * information * share_.transpose();
  }
  [[nodiscard]] Parameters score(const Parameters& score) const { return kept_ * score; }

 private:
  Eigen::Matrix4d information_ = Eigen::Matrix4d::Zero(), feigned_ = Eigen::Matrix4d::Zero();
  double inliers_ = 0.0, elevation_ = 0.0, elevation_square_ = 0.0, elevation_variance_ = 0.0;
  bool has_elevation_ = false;
  Square share_ = Square::Zero(), kept_ = Square::Zero();
};

}  // namespace boresight::alignment::planar
