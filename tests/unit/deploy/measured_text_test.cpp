// Digits of measured values.
#include <limits>

#include <gtest/gtest.h>

#include "services/common/text/measured.hpp"

namespace boresight::text {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(MeasuredText, ValueHasTheDecimalsOfItsStandardDeviation) {
  EXPECT_EQ(with_std(2.51234, 0.0312, "°", Sign::kAlways), "+2.512 ± 0.031°");
  EXPECT_EQ(with_std(1.0119, 0.0000312), "1.011900 ± 0.000031");
  EXPECT_EQ(with_std(-1.5, 0.4, " m/s"), "-1.50 ± 0.40 m/s");
  EXPECT_EQ(with_std(1234.5, 12.3), "1234 ± 12");
  EXPECT_EQ(with_std(12345.6, 345.6), "12346 ± 346");
}

TEST(MeasuredText, StandardDeviationThatRoundsUpToATenKeepsTwoDigits) {
  EXPECT_EQ(with_std(0.5, 0.0996), "0.50 ± 0.10");
  EXPECT_EQ(with_std(0.5, 0.00999), "0.500 ± 0.010");
  EXPECT_EQ(with_std(7.0, 9.96), "7 ± 10");
}

TEST(MeasuredText, ZeroHasNoMinusSign) {
  EXPECT_EQ(with_std(-0.0004, 0.12), "0.00 ± 0.12");
  EXPECT_EQ(with_std(-0.0004, 0.12, "°", Sign::kAlways), "+0.00 ± 0.12°");
  EXPECT_EQ(fixed(-0.0, 2), "0.00");
  EXPECT_EQ(fixed(-0.004, 2, "°"), "0.00°");
  EXPECT_EQ(fixed(-0.006, 2, "°"), "-0.01°");
}

TEST(MeasuredText, UnknownStandardDeviationIsNotShown) {
  EXPECT_EQ(with_std(1.01194321, 0.0), "1.012");
  EXPECT_EQ(with_std(1.01194321, kNaN, "°", Sign::kAlways), "+1.012°");
  EXPECT_EQ(with_std(0.0, 0.0), "0");
  EXPECT_EQ(with_std(0.0123456, -1.0), "0.01235");
}

TEST(MeasuredText, UnknownValueIsADash) {
  EXPECT_EQ(with_std(kNaN, 0.1, "°"), "–");
  EXPECT_EQ(fixed(std::numeric_limits<double>::infinity(), 1, " s"), "–");
  EXPECT_EQ(error_in_stds(kNaN, 0.1, "°"), "–");
}

TEST(MeasuredText, ErrorIsAlsoStatedInStandardDeviations) {
  EXPECT_EQ(error_in_stds(0.0213, 0.0412, "°"), "+0.021° (0.5 σ)");
  EXPECT_EQ(error_in_stds(-1.2e-5, 4e-5), "-0.000012 (0.3 σ)");
  EXPECT_EQ(error_in_stds(0.02, 0.0, "°"), "+0.02000°");
}

TEST(MeasuredText, LargeCountsAreGrouped) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(308299), "308,299");
  EXPECT_EQ(grouped(12345678), "12,345,678");
}

}  // namespace
}  // namespace boresight::text
