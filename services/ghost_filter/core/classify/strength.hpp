// What the strength of a detection tells: each bounce costs power, so that a ghost is weaker than its object.
#pragma once

#include <algorithm>
#include <cmath>

#include "services/ghost_filter/core/density/exponential.hpp"
#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

/// How strong detections of one origin are, relative to what a body reflects directly; densities for each dB.
struct Strength {
  double mean_db, std_db;
};

/// Of a part of the body, of a wheel or a limb (small, and seen from the side), of a ghost whose path is not known; of
/// clutter and of a new object, beside the usual.
inline constexpr Strength kBodyStrength{0.0, 6.0}, kWheelStrength{-13.0, 7.0}, kGhostStrength{-22.0, 8.0},
    kClutterStrength{-18.0, 9.0}, kNewStrength{-5.0, 10.0};

/// What a body reflects if nothing is known of it: from a pedestrian to a truck.
inline constexpr double kUsualRcs_dbsm = 5.0, kUsualRcsStd_db = 5.0;

/// Of one reflection from scan to scan.
inline constexpr double kFluctuation_db = 4.0;

/// Of a ghost whose waves met mirrors `bounces` times on their way out and back, and came back from the object at an
/// angle to where they had come from: vehicles' strong reflections are corners, which send waves back to there, so that
/// a ghost by a detour of a few degrees is far stronger than one from aside.
[[nodiscard]] inline Strength strength_of_ghost(int bounces, double cosine_between) {
  constexpr double kBounce_db = 13.0, kMost_db = 18.0;
  constexpr double kStd_db = 6.0, kDoubt = 0.1;  // what is lost more is known less
  constexpr double kHalfPower_rad = 0.12;
  const double angle2 = 2.0 * (1.0 - cosine_between);  // of small angles
  const double loss = kBounce_db * bounces + std::min(kMost_db, 3.0 * angle2 / (kHalfPower_rad * kHalfPower_rad));
  return {-loss, kStd_db + kDoubt * (loss - kBounce_db)};
}

/// How likely a strength beside the body's is. Losses of reflectors, aspects and dirt are known so badly that strength
/// is one argument among others: `doubt` is the share of cases in which it tells nothing.
class StrengthLikelihood {
 public:
  StrengthLikelihood(const Strength& strength, double more_std_db, double doubt)
      : mean_db_(strength.mean_db), per_twice_variance_(0.5 / (square(strength.std_db) + square(more_std_db))) {
    constexpr double kSpread_db = 60.0;
    least_ = doubt / kSpread_db;
    peak_ = (1.0 - doubt) * std::sqrt(per_twice_variance_ / M_PI);
  }
  /// 1 for what is not measured.
  [[nodiscard]] double operator()(double above_db) const {
    if (!std::isfinite(above_db)) return 1.0;
    const double residual = above_db - mean_db_;
    return least_ + peak_ * exponential(-per_twice_variance_ * residual * residual);
  }

 private:
  double mean_db_, per_twice_variance_, least_, peak_;
};

[[nodiscard]] inline double likelihood(const Strength& strength, double above_db, double more_std_db, double doubt) {
  return StrengthLikelihood(strength, more_std_db, doubt)(above_db);
}

}  // namespace boresight::ghosts
