#include "services/simulator/judge/gospa.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace boresight::judge {

Ellipse ellipse_in_box(const Eigen::Vector2d& centre_m, double heading_rad, double length_m, double width_m) {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  const double along = 0.25 * length_m * length_m, across = 0.25 * width_m * width_m;
  Ellipse ellipse{centre_m, {}};
  ellipse.extent_m2 << c * c * along + s * s * across, c * s * (along - across),  //
      c * s * (along - across), s * s * along + c * c * across;
  return ellipse;
}

double gaussian_wasserstein_squared(const Ellipse& a, const Ellipse& b) {
  // The trace of the root of a 2 × 2 matrix A is √(tr A + 2 √det A); for A = X^½ X̂ X^½, tr A = tr(X X̂) and
  // det A = det X · det X̂.
  const double product_trace = (a.extent_m2 * b.extent_m2).trace();
  const double product_determinant = a.extent_m2.determinant() * b.extent_m2.determinant();
  const double root_trace =
      std::sqrt(std::max(0.0, product_trace + 2.0 * std::sqrt(std::max(0.0, product_determinant))));
  const double shape = a.extent_m2.trace() + b.extent_m2.trace() - 2.0 * root_trace;
  return (a.centre_m - b.centre_m).squaredNorm() + std::max(0.0, shape);
}

GospaParts& GospaParts::operator+=(const GospaParts& other) {
  localisation += other.localisation;
  missed += other.missed;
  false_tracks += other.false_tracks;
  return *this;
}

GospaParts Gospa::evaluate(std::span<const Ellipse> objects, std::span<const Ellipse> tracks, GospaBase base) {
  pairs_.clear();
  for (std::size_t o = 0; o < objects.size(); ++o) {
    for (std::size_t k = 0; k < tracks.size(); ++k) {
      const double squared_m2 = gaussian_wasserstein_squared(objects[o], tracks[k]);
      const double distance = base == GospaBase::kSquared ? squared_m2 : std::sqrt(squared_m2);
      if (distance < kCutOff) pairs_.push_back({o, k, distance});
    }
  }
  // A pair saves the cost of a missed object and of a false track, together c.
  pairing_.solve(objects.size(), tracks.size(), pairs_, kCutOff);
  GospaParts parts{pairing_.cost_of_pairs(), 0.0, 0.0};
  for (std::size_t o = 0; o < objects.size(); ++o) {
    if (pairing_.column_of(o) == Pairing::kNoPartner) parts.missed += kCostAlone;
  }
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (pairing_.row_of(k) == Pairing::kNoPartner) parts.false_tracks += kCostAlone;
  }
  return parts;
}

}  // namespace boresight::judge
