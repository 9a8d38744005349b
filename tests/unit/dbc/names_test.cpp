// Patterns of names with an index.
#include "services/ingest_gateway/dbc/names.hpp"

#include <gtest/gtest.h>

namespace boresight::ingest::dbc {
namespace {

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

}  // namespace
}  // namespace boresight::ingest::dbc
