#include "tests/benchmarks/realism/rows/spread.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::bench::realism {

double student_t(double freedom) {
  constexpr double kZ = 1.959964;  // of the normal distribution
  const double z2 = kZ * kZ, z3 = kZ * z2, z5 = z3 * z2, z7 = z5 * z2;
  return kZ + (z3 + kZ) / (4.0 * freedom) + (5.0 * z5 + 16.0 * z3 + 3.0 * kZ) / (96.0 * freedom * freedom) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * kZ) / (384.0 * freedom * freedom * freedom);
}

Spread spread_of(const std::vector<double>& figures) {
  std::vector<double> known;
  std::copy_if(figures.begin(), figures.end(), std::back_inserter(known), [](double f) { return !std::isnan(f); });
  if (known.empty()) return {};
  const double middle = quantile_of(known, 0.5);
  if (known.size() <= kFewSeeds) {
    const auto [low, high] = std::minmax_element(known.begin(), known.end());
    return {middle, *low, *high};
  }
  const auto n = static_cast<double>(known.size());
  double sum = 0.0;
  for (const double f : known) sum += f;
  WithinGroups all;
  all.add_group(known);
  const double mean = sum / n, half = student_t(n - 1.0) * all.std_dev() / std::sqrt(n);
  return {middle, mean - half, mean + half};
}

}  // namespace boresight::bench::realism
