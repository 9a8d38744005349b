#include "tests/benchmarks/ghosts/common/reliability.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace boresight::bench {
namespace {

TEST(Reliability, HasNoErrorWhenSharesEqualProbabilities) {
  Reliability r;
  EXPECT_TRUE(std::isnan(r.calibration_error()));
  for (int i = 0; i < 10; ++i) r.add(0.8, i < 8);
  for (int i = 0; i < 100; ++i) r.add(0.02, i < 2);
  EXPECT_NEAR(r.calibration_error(), 0.0, 1e-12);
  EXPECT_NEAR(r.brier_score(), (8 * 0.04 + 2 * 0.64 + 2 * 0.9604 + 98 * 0.0004) / 110.0, 1e-12);
}

TEST(Reliability, CountsByBinAndMeasuresTheError) {
  Reliability a, b;
  for (int i = 0; i < 4; ++i) a.add(0.75, false);
  b.add(1.0, true);
  b.add(0.0, false);
  a.add(b);
  EXPECT_EQ(a.count(), 6u);
  EXPECT_EQ(a.bins().front().count, 1u);
  EXPECT_EQ(a.bins().back().count, 1u);
  EXPECT_DOUBLE_EQ(a.bins()[9].mean_probability(), 0.75);
  EXPECT_DOUBLE_EQ(a.calibration_error(), 4 * 0.75 / 6.0);
}

TEST(Reliability, ValuesOutsideZeroToOneCountAsWorst) {
  Reliability r;
  r.add(std::numeric_limits<double>::quiet_NaN(), true);
  r.add(1.5, false);
  EXPECT_DOUBLE_EQ(r.brier_score(), 1.0);
  EXPECT_DOUBLE_EQ(r.calibration_error(), 1.0);
}

}  // namespace
}  // namespace boresight::bench
