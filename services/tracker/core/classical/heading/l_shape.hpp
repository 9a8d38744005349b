// Heading of a box from the outline of its detections: L-shape fitting by a search of the direction (Zhang et
// al. 2017).
//
// For each direction θ in [0, π/2) the detections have the coordinates c₁ = p·(cos θ, sin θ) and c₂ = p·(−sin θ, cos
// θ). The two faces that the sensor sees are the nearer ends of both coordinates. With D₁ and D₂ the distances of a
// detection from them, the criteria are
//   area        −(max c₁ − min c₁)(max c₂ − min c₂),
//   closeness   Σ 1 / max(min(D₁, D₂), d₀),
//   variance    −Var{D₁ | D₁ < D₂} − Var{D₂ | D₂ ≤ D₁}.
// The largest value wins. The variance of θ is that of the weights exp(−χ²(θ)/2), χ²(θ) being the sum of min(D₁, D₂)²
// over the variance of a distance.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "services/tracker/core/classical/heading/heading.hpp"

namespace boresight::tracking::classical {

enum class ShapeCriterion { kArea, kCloseness, kVariance };

struct ShapeParameters {
  ShapeCriterion criterion = ShapeCriterion::kVariance;
  std::size_t least_points = 6;  ///< fewer have no outline
  double face_std_m = 0.7;       ///< of a reflection about its face, beside the radar's noise
  double nearest_m = 0.1;        ///< d₀
};

/// The length axis up to multiples of π/2, as the one nearest to `near_rad`. Empty with too few points. Does not
/// allocate.
[[nodiscard]] std::optional<Heading> l_shape_heading(std::span<const HistoryPoint> points, double near_rad,
                                                     const ShapeParameters& parameters);

}  // namespace boresight::tracking::classical
