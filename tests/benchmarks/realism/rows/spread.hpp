// A figure over the seeds of a run.
#pragma once

#include <cstddef>
#include <vector>

#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

/// Up to this number of seeds the interval is the span of their figures, which is then the narrower one.
inline constexpr std::size_t kFewSeeds = 5;

/// Median over the seeds, and the interval that a verdict uses: the span of few seeds, the 95 % interval of the mean
/// (Student) of more. NaN without figures.
struct Spread {
  double median = kNoFigure, low = kNoFigure, high = kNoFigure;
  Spread() = default;
  Spread(double figure) : median(figure), low(figure), high(figure) {}  // NOLINT(google-explicit-constructor): one seed
  Spread(double middle, double from, double to) : median(middle), low(from), high(to) {}
};

/// `figures`: one of each seed; those that are not numbers have no data and do not count.
[[nodiscard]] Spread spread_of(const std::vector<double>& figures);

/// Quantile 97.5 % of Student's t with `freedom` ≥ 3 degrees of freedom, within 0.3 % from 5 on, by the first terms of
/// its expansion about the normal distribution.
[[nodiscard]] double student_t(double freedom);

}  // namespace boresight::bench::realism
