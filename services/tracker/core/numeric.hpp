// Limits of arithmetic that the tracker shares: they keep logarithms and divisions finite. None is a tuning value.
#pragma once

#include <limits>

namespace boresight::tracking {

/// Logarithm of what cannot be (negative), distance of what is nowhere.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Probabilities, shares and expected numbers are no smaller, and no nearer to 1, where their logarithm is taken.
inline constexpr double kLeastProbability = 1e-9;
/// The same of densities and likelihoods; float holds it, too.
inline constexpr double kLeastDensity = 1e-30;
/// Logs of ratios are no larger where exp is taken.
inline constexpr double kMostLog = 600.0;
/// Distances are no smaller where a direction is divided by them.
inline constexpr double kLeastRange_m = 1e-3;

/// A normal variable is no farther from its mean: the chance of it is lost to rounding.
inline constexpr double kCertainDeviations = 8.5;

}  // namespace boresight::tracking
