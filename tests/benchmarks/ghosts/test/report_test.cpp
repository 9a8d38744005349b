// Number formats in tables and documents, and which figures are judged.
#include "tests/benchmarks/common/report.hpp"

#include <limits>
#include <sstream>

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

TEST(Report, JudgesNoBarOfAnotherRadarProfile) {
  const auto fill = [](Report report) {
    report.at_most("group", "errors", 5.0, 1.0, "", "");
    report.at_least("group", "share", 5.0, 97.0, "%", "");
    report.within("group", "count", 5.0, 6.0, 7.0, "", "");
    return report;
  };
  const Report judged = fill(Report("ideal", true));
  for (const Bar& bar : judged.bars()) EXPECT_STREQ(bar.verdict(), "FAIL") << bar.what;
  const Report other = fill(Report("series_77ghz", false));
  for (const Bar& bar : other.bars()) {
    EXPECT_STREQ(bar.verdict(), "—") << bar.what;
    EXPECT_EQ(bar.limit(), "—");
    EXPECT_EQ(bar.figure, 5.0);
  }
  std::ostringstream json;
  other.write_json(json);
  EXPECT_NE(json.str().find("\"profile\":\"series_77ghz\""), std::string::npos);
}

}  // namespace
}  // namespace boresight::bench
