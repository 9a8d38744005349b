#include "services/common/extended_object/truncated_exponential.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace boresight::extended_object {
namespace {

MeanVariance by_quadrature(double rate, double half) {
  constexpr int kSteps = 200000;
  double sum = 0.0, first = 0.0, second = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = half * ((2.0 * i + 1.0) / kSteps - 1.0), w = std::exp(rate * x - std::abs(rate) * half);
    sum += w;
    first += w * x;
    second += w * x * x;
  }
  return {first / sum, second / sum - first * first / (sum * sum)};
}

TEST(TruncatedExponential, MomentsEqualQuadrature) {
  for (const double half : {0.3, 2.0, 8.0}) {
    for (const double rate : {-3.0, -0.5, -1e-3, 0.0, 1e-6, 0.02, 0.3, 1.0, 4.0}) {
      const MeanVariance exact = truncated_exponential(rate, half), numeric = by_quadrature(rate, half);
      EXPECT_NEAR(exact.mean, numeric.mean, 1e-7 * half) << rate << " " << half;
      EXPECT_NEAR(exact.variance, numeric.variance, 1e-7 * half * half) << rate << " " << half;
    }
  }
}

TEST(TruncatedExponential, SeriesAndClosedFormMeet) {
  const MeanVariance below = truncated_exponential(0.05 - 1e-12, 1.0), above = truncated_exponential(0.05 + 1e-12, 1.0);
  EXPECT_NEAR(below.mean, above.mean, 1e-11);
  EXPECT_NEAR(below.variance, above.variance, 1e-10);
}

TEST(TruncatedExponential, StaysFiniteAtTheLimits) {
  EXPECT_DOUBLE_EQ(truncated_exponential(5.0, 0.0).mean, 0.0);
  const MeanVariance steep = truncated_exponential(1e9, 2.0);
  EXPECT_NEAR(steep.mean, 2.0, 1e-6);
  EXPECT_NEAR(steep.variance, 0.0, 1e-6);
}

}  // namespace
}  // namespace boresight::extended_object
