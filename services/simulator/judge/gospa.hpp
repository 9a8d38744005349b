// Generalised optimal sub-pattern assignment metric (Rahmathullah, García-Fernández and Svensson 2017) of extended
// objects, with p = 1, c = 20 and α = 2 as in Le Ba Thanh 2023.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/simulator/judge/pairing.hpp"

namespace boresight::judge {

/// An extended object: an ellipse {x: (x − m)ᵀ X⁻¹ (x − m) ≤ 1}.
struct Ellipse {
  Eigen::Vector2d centre_m;   ///< m
  Eigen::Matrix2d extent_m2;  ///< X
};

/// The ellipse that touches the four sides of a box: X = R(heading) diag((length/2)², (width/2)²) R(heading)ᵀ. Nothing
/// is divided: the half axes are half the length and half the width.
[[nodiscard]] Ellipse ellipse_in_box(const Eigen::Vector2d& centre_m, double heading_rad, double length_m,
                                     double width_m);

/// Squared Gaussian-Wasserstein distance in m²: ‖m − m̂‖² + tr(X + X̂ − 2 (X^½ X̂ X^½)^½).
[[nodiscard]] double gaussian_wasserstein_squared(const Ellipse& a, const Ellipse& b);

enum class GospaBase {
  kSquared,  ///< the squared distance, as Le Ba Thanh 2023 uses it; c = 20 m² cuts at 4.5 m
  kRoot      ///< its root, a metric; c = 20 m
};

struct GospaParts {
  double localisation = 0.0, missed = 0.0, false_tracks = 0.0;
  [[nodiscard]] double total() const { return localisation + missed + false_tracks; }
  GospaParts& operator+=(const GospaParts& other);
};

class Gospa {
 public:
  static constexpr double kCutOff = 20.0;  ///< c (literature: Le Ba Thanh 2023), in m² or m as the base distance
  /// Cost of a missed object or of a false track: c/α with α = 2.
  static constexpr double kCostAlone = kCutOff / 2.0;

  /// Pairs that no evaluation considered (pairing.hpp).
  [[nodiscard]] std::size_t not_considered() const { return pairing_.not_considered(); }
  [[nodiscard]] GospaParts evaluate(std::span<const Ellipse> objects, std::span<const Ellipse> tracks, GospaBase base);

 private:
  std::vector<PairCost> pairs_;
  Pairing pairing_;
};

}  // namespace boresight::judge
