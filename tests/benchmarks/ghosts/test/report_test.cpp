// Number formats in tables and documents.
#include "tests/benchmarks/common/report.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace boresight::bench {
namespace {

TEST(ReportNumber, ReadsAsPeopleWriteIt) {
  EXPECT_EQ(number(0.0123456), "0.0123");
  EXPECT_EQ(number(97.84), "97.8");
  EXPECT_EQ(number(999.4), "999");
  EXPECT_EQ(number(999.6), "1000");
  EXPECT_EQ(number(24256.4), "24256");
  EXPECT_EQ(number(-1814.0), "-1814");
  EXPECT_EQ(number(2.5e9), "2.5e+09");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "—");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity()), "never");
}

}  // namespace
}  // namespace boresight::bench
