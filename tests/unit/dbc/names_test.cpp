// Patterns of names, and the names that may have been meant.
#include "services/ingest_gateway/dbc/names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boresight::ingest::dbc {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Names, PatternsTakeTheIndex) {
  EXPECT_EQ(expand("PLAIN", 7), "PLAIN");
  EXPECT_EQ(expand("T_{}", 7), "T_7");
  EXPECT_EQ(expand("T_{:02}_X{}", 7), "T_07_X7");
  EXPECT_EQ(expand("T_{:03}", 1234), "T_1234");
  EXPECT_EQ(expand("", 7), "");
}

TEST(Names, OtherBracesAreNoPattern) {
  for (const std::string_view pattern : {"{", "}", "T{x}", "{:0}", "{:3}", "{:00}", "{:012}", "a}b"}) {
    EXPECT_FALSE(expand(pattern, 7)) << pattern;
  }
}

TEST(Names, NearestComeFirstAndFarOnesNotAtAll) {
  const std::vector<std::string> names{"RANGE_RATE", "RANGE", "AZIMUTH", "RANGES", "rang", "ELEVATION"};
  EXPECT_THAT(near_names("RANGE", names), ElementsAre("RANGE", "RANGES", "rang"));
  EXPECT_THAT(near_names("AZIMUT", names), ElementsAre("AZIMUTH"));
  EXPECT_THAT(near_names("XYZ", names), IsEmpty());
  EXPECT_THAT(near_names(std::string(1000, 'a'), {std::string(1000, 'b')}), IsEmpty());
}

}  // namespace
}  // namespace boresight::ingest::dbc
