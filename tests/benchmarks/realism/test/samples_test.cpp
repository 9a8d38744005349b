// Quantiles by selection.
#include "tests/benchmarks/realism/common/samples.hpp"

#include <gtest/gtest.h>

#include "tests/benchmarks/common/statistics.hpp"

namespace boresight::bench::realism {
namespace {

TEST(Samples, QuantileOfTwoValuesIsBetweenThem) {
  Samples samples;
  EXPECT_TRUE(std::isnan(samples.quantile(0.5)));
  samples.add(8.0);
  EXPECT_DOUBLE_EQ(samples.quantile(0.9), 8.0);
  samples.add(4.0);
  EXPECT_DOUBLE_EQ(samples.quantile(0.25), 5.0);
  EXPECT_DOUBLE_EQ(samples.quantile(1.0), 8.0);
}

TEST(Samples, QuantileBySelectionIsThatBySorting) {
  std::vector<double> values;
  for (unsigned i = 0; i < 501; ++i) values.push_back(static_cast<double>(i * 7919u % 1009u));
  for (const double share : {0.0, 0.013, 0.5, 0.777, 0.99, 1.0}) {
    EXPECT_DOUBLE_EQ(quantile_of(values, share), bench::quantile(values, share)) << share;
  }
}

TEST(Samples, StandardDeviationIsAboutTheMean) {
  Samples samples;
  EXPECT_TRUE(std::isnan(samples.std_dev()));
  for (const double v : {1.0, 3.0, 5.0}) samples.add(v);
  EXPECT_DOUBLE_EQ(samples.std_dev(), 2.0);
}

}  // namespace
}  // namespace boresight::bench::realism
