// Ratio of a radar's actual range-rate noise to the noise that it states, learnt from stationary reflectors.
// Equations: docs/algorithms/correction.md (C10)–(C13).
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "services/detection_corrector/core/config.hpp"

namespace boresight::corrector {

/// Range rate of a detection less that of a stationary reflector, and the variances of this difference.
struct Innovation {
  Eigen::Vector3d direction;      ///< unit vector, vehicle axes
  double value_mps;               ///< in the radar's own scale of range rates
  double stated_variance_m2ps2;   ///< of the range rate, as stated by the radar
  double angular_variance_m2ps2;  ///< by the angles of this detection; not scaled
};

/// Recursive maximum likelihood for a mixture. A stationary reflector's innovation has the variance s²·stated + angular
/// and an error common to the scan. Anything else has a wide distribution. The evidence is forgotten exponentially. The
/// prior is never forgotten, so a radar without stationary detections returns to it. It is s = 1, the stated noise,
/// until set_prior().
class RangeRateNoise {
 public:
  explicit RangeRateNoise(const StatedNoiseConfig& config) : config_(config), other_share_(config.other_share) {}

  /// Takes `scale` as the prior s, as far as it is within the limits; one that is not positive and finite as s = 1.
  void set_prior(double scale);

  /// s²: actual / stated variance.
  [[nodiscard]] double variance_factor() const { return factor_; }

  /// `common`: covariance C of the scan's error δ, which adds direction·δ to each innovation. Ignores innovations
  /// that are not finite or without a positive stated variance.
  void learn(std::span<const Innovation> scan, const Eigen::Matrix3d& common, std::int64_t time_ns);

 private:
  /// Equation (C13), the second line.
  void weigh();

  StatedNoiseConfig config_;
  double prior_factor_ = 1.0;
  double factor_ = 1.0;
  double other_share_;
  double weight_ = 0.0, sum_ = 0.0;   // of the evidence, in detections; sum_/weight_ is its s²
  double seen_ = 0.0, others_ = 0.0;  // detections, and those that are not of a stationary reflector
  bool has_time_ = false;
  std::int64_t time_ns_ = 0;
};

}  // namespace boresight::corrector
