// A cell: the measurements of one object in one scan, kept as sums. The collapsed likelihood of a cell needs no more,
// so moving one measurement from cell to cell costs two evaluations.
#pragma once

#include <cstdint>

#include "services/tracker/core/ggiw/planar.hpp"

namespace boresight::tracking {

/// One detection in the tracker's local axes.
template <typename Real>
struct Measurement {
  Vector2<Real> position_m;
  Vector2<Real> sight;       ///< unit vector from the sensor
  Real range_rate_mps = 0;   ///< over ground
  Real log_clutter = 0;      ///< log of the expected clutter per m² (and m/s) there
  Real side_lobe_share = 0;  ///< share of that clutter which is side lobes of objects
  Real partner = 0;          ///< chance that the scan shows the object whose side lobe it may be
  Real wide_share = 0;       ///< share of that clutter which is objects' detections of other range rates
  Real mirror = 0;           ///< probability that it is a mirror image, by the ghost filter
  Real moving = 1;           ///< probability of a moving object's direct echo, by the ghost filter without tracks
  Real strength_db = 0;      ///< over the radar's usual detection
  Real strengths = 0;        ///< 1 where the radar states the strength
};

/// Sums over measurements; the number is fractional where measurements are shared between cells.
template <typename Real>
struct Cell {
  Real n = 0;
  Vector2<Real> sum;               ///< Σ z
  Symmetric2<Real> sum_squares;    ///< Σ z zᵀ
  Symmetric2<Real> sight_squares;  ///< Σ u uᵀ
  Vector2<Real> sight_rate;        ///< Σ u ṙ
  Real rate_squares = 0;           ///< Σ ṙ²
  Real log_clutter = 0, side_lobe_share = 0, partner = 0, wide_share = 0, mirror = 0;
  Real strength_sum = 0, strengths = 0;  ///< of detections whose strength the radar states; dB
  std::uint64_t key = 0;                 ///< exclusive or of the measurements' keys: equal cells have equal keys

  void add(const Measurement<Real>& z, Real weight) {
    n += weight;
    sum = sum + weight * z.position_m;
    sum_squares = sum_squares + weight * outer(z.position_m);
    sight_squares = sight_squares + weight * outer(z.sight);
    sight_rate = sight_rate + (weight * z.range_rate_mps) * z.sight;
    rate_squares += weight * z.range_rate_mps * z.range_rate_mps;
    log_clutter += weight * z.log_clutter;
    side_lobe_share += weight * z.side_lobe_share;
    partner += weight * z.partner;
    wide_share += weight * z.wide_share;
    mirror += weight * z.mirror;
    strength_sum += weight * z.strengths * z.strength_db;
    strengths += weight * z.strengths;
  }
  void add(const Measurement<Real>& z, std::uint64_t z_key) {
    add(z, Real(1));
    key ^= z_key;
  }
  void remove(const Measurement<Real>& z, std::uint64_t z_key) {
    add(z, Real(-1));
    key ^= z_key;
  }
  void join(const Cell& other) {
    n += other.n;
    sum = sum + other.sum;
    sum_squares = sum_squares + other.sum_squares;
    sight_squares = sight_squares + other.sight_squares;
    sight_rate = sight_rate + other.sight_rate;
    rate_squares += other.rate_squares;
    log_clutter += other.log_clutter;
    side_lobe_share += other.side_lobe_share;
    partner += other.partner;
    wide_share += other.wide_share;
    mirror += other.mirror;
    strength_sum += other.strength_sum;
    strengths += other.strengths;
    key ^= other.key;
  }
  [[nodiscard]] Vector2<Real> mean() const { return (Real(1) / n) * sum; }
  /// Σ (z − z̄)(z − z̄)ᵀ; rounding may not make it negative definite.
  [[nodiscard]] Symmetric2<Real> scatter() const {
    const Symmetric2<Real> s = sum_squares - n * outer(mean());
    const Real xx = s.xx > 0 ? s.xx : Real(0), yy = s.yy > 0 ? s.yy : Real(0);
    const Real bound = std::sqrt(xx * yy);
    return {xx, s.xy > bound ? bound : s.xy < -bound ? -bound : s.xy, yy};
  }
};

}  // namespace boresight::tracking
