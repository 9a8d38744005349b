// The radar's own azimuth error as a curve over the azimuth. Equation: docs/algorithms/correction.md (C9).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "interfaces/messages/alignment_estimate.hpp"

namespace boresight::corrector {

class AzimuthCurve {
 public:
  struct Error {
    double value_rad = 0.0;  ///< measured − true azimuth
    double std_rad = 0.0;
  };

  /// No error at any azimuth.
  AzimuthCurve() = default;
  /// Without a curve, or with a value that is not finite, the same.
  explicit AzimuthCurve(const AlignmentNuisance& nuisance) {
    if (!(nuisance.azimuth_curve_step_rad > 0.0F) || !std::isfinite(nuisance.azimuth_curve_step_rad) ||
        !std::isfinite(nuisance.azimuth_curve_first_rad)) {
      return;
    }
    for (std::size_t i = 0; i < kAzimuthCurveKnots; ++i) {
      knots_[i] = {nuisance.azimuth_curve_rad[i], nuisance.azimuth_curve_std_rad[i]};
      if (!std::isfinite(knots_[i].value_rad) || !(knots_[i].std_rad >= 0.0) || !std::isfinite(knots_[i].std_rad))
        return;
    }
    first_rad_ = nuisance.azimuth_curve_first_rad;
    step_rad_ = nuisance.azimuth_curve_step_rad;
  }

  /// Linear between the knots, the last knot's value beyond it. `azimuth_rad`: as measured.
  [[nodiscard]] Error at(double azimuth_rad) const {
    if (step_rad_ <= 0.0) return {};
    constexpr double kLast = static_cast<double>(kAzimuthCurveKnots - 1);
    const double place = std::clamp((azimuth_rad - first_rad_) / step_rad_, 0.0, kLast);
    const std::size_t below = std::min(static_cast<std::size_t>(place), kAzimuthCurveKnots - 2);
    const double share = place - static_cast<double>(below);
    const Error &a = knots_[below], &b = knots_[below + 1];
    return {a.value_rad + share * (b.value_rad - a.value_rad), a.std_rad + share * (b.std_rad - a.std_rad)};
  }

 private:
  std::array<Error, kAzimuthCurveKnots> knots_{};
  double first_rad_ = 0.0;
  double step_rad_ = 0.0;  // 0: no curve
};

}  // namespace boresight::corrector
