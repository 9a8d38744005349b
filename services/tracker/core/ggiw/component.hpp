// A gamma × Gaussian × inverse-Wishart component (Granström and Orguner 2012): one hypothesis about one extended
// object. Covariances stay positive definite: the position block is updated in Joseph form, the rest by symmetric
// differences.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "services/tracker/core/ggiw/cell.hpp"
#include "services/tracker/core/ggiw/planar.hpp"

namespace boresight::tracking {

/// What a source of detections is; the rest to 1 is a source of clutter that lasts less than a second.
template <typename Real>
struct SourceClasses {
  Real object = 1;          ///< a road user
  Real side_lobe = 0;       ///< a side lobe of an object: same range and range rate, other azimuth
  Real lasting_source = 0;  ///< clutter that lasts as long as objects do
  int radar = -1;           ///< index of the only radar that has detected it; −1: several
  // Of a side lobe, as the model of the world judges it from scan to scan.
  Real hidden_parent = 0;   ///< odds to an object that its parent is not established
  Real kept_ring = 1;       ///< likelihood of the scans so far in which it was on the ring of no known object
  Real side_lobe_odds = 0;  ///< to an object, by place, range rate and strength in the latest scan

  [[nodiscard]] Real brief_source() const {
    const Real rest = Real(1) - object - side_lobe - lasting_source;
    return rest > 0 ? rest : Real(0);
  }
};

template <typename Real>
struct Component {
  std::uint32_t label = 0;                      ///< of the object; 0: none yet
  Real rate_shape = 1, rate_inverse_scale = 1;  ///< α, β of the gamma: detections a scan at unit exposure
  Vector2<Real> position_m, velocity_mps;
  Symmetric2<Real> position_covariance;        ///< m²
  Matrix2<Real> position_velocity_covariance;  ///< rows: position
  Symmetric2<Real> velocity_covariance;        ///< m²/s²
  Real extent_dof = 8;                         ///< v of the inverse Wishart
  Symmetric2<Real> extent_scale;               ///< V, m²
  SourceClasses<Real> source;
  Real mirror = 0;                      ///< probability that its detections are mirror images, mean of the latest
  Real strength_db = 0, strengths = 0;  ///< mean over the latest detections, and their number
};

/// E[X] = V / (v − 6), m².
template <typename Real>
[[nodiscard]] Symmetric2<Real> extent(const Component<Real>& c) {
  return (Real(1) / (c.extent_dof - Real(6))) * c.extent_scale;
}

/// Motion with white acceleration; forgetting of rate and extent.
struct MotionParameters {
  double acceleration_density = 2.0;  ///< q, m²/s³
  double rate_memory_s = 1.0;         ///< α and β decay by exp(−t/memory)
  double rate_min_shape = 0.0;        ///< α stays above it, the mean α/β kept
  double extent_memory_s = 5.0;       ///< v − 6 and V decay by exp(−t/memory)
  double extent_min_dof = 7.0;        ///< v stays above it, the mean extent kept
  /// Eigenvalues of the mean extent stay above it, m². Far below the measurement noise an extent is not observable: the
  /// factor X^½ R^−½ of its update then makes it wander, smaller and thinner, until it is singular.
  double extent_min_m2 = 1e-4;
};

/// Prediction by `elapsed_s` (Granström and Orguner 2012, (20)…(23)); negative: a retrodiction without noise.
template <typename Real>
void predict(Component<Real>& c, const MotionParameters& motion, double elapsed_s);

template <typename Real>
struct WeightedComponent {
  Real weight = 0;
  const Component<Real>* component = nullptr;
};

/// One component with the moments of the mixture; weights need not be normalised.
template <typename Real>
[[nodiscard]] Component<Real> merge(std::span<const WeightedComponent<Real>> mixture);

/// Dissimilarity: half the symmetric squared Mahalanobis distances of place and velocity, and terms of extent and rate.
/// Above `limit` it is a lower bound.
template <typename Real>
[[nodiscard]] Real distance(const Component<Real>& a, const Component<Real>& b,
                            Real limit = std::numeric_limits<Real>::infinity());

}  // namespace boresight::tracking
