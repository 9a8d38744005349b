#include "services/common/estimation/latency_histogram.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace boresight {
namespace {

TEST(LatencyHistogram, PercentilesAreThoseOfTheSortedValuesWithinABucket) {
  std::mt19937 random(1);
  std::lognormal_distribution<double> duration(5.0, 1.2);  // µs
  LatencyHistogram histogram;
  std::vector<double> values;
  for (int i = 0; i < 20'000; ++i) {
    values.push_back(std::clamp(duration(random), 1.0, 9e5));
    histogram.add(static_cast<std::int64_t>(values.back() * 1e3));
  }
  std::sort(values.begin(), values.end());
  for (const double share : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const double exact = values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    EXPECT_NEAR(histogram.percentile_us(share) / exact, 1.0, 0.065) << share;
  }
  EXPECT_NEAR(histogram.max_us(), values.back(), 1e-3 + 1e-6 * values.back());
  EXPECT_EQ(histogram.total(), values.size());
}

TEST(LatencyHistogram, EmptyAndExtremeValues) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.percentile_us(0.5), 0.0);
  histogram.add(0);
  histogram.add(-5);
  histogram.add(50'000'000'000);
  EXPECT_EQ(histogram.total(), 3u);
  EXPECT_LE(histogram.percentile_us(0.5), 1.2);
  EXPECT_NEAR(histogram.max_us(), 5e7, 1.0);
}

}  // namespace
}  // namespace boresight
