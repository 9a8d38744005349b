#include "services/common/text/near_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boresight {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(NearNames, NearestComeFirstAndDistantOnesAreNotListed) {
  const std::vector<std::string> names{"RANGE_RATE", "RANGE", "AZIMUTH", "RANGES", "rang", "ELEVATION"};
  EXPECT_THAT(near_names("RANGE", names), ElementsAre("RANGE", "RANGES", "rang"));
  EXPECT_THAT(near_names("AZIMUT", names), ElementsAre("AZIMUTH"));
  EXPECT_THAT(near_names("XYZ", names), IsEmpty());
  EXPECT_THAT(near_names(std::string(1000, 'a'), {std::string(1000, 'b')}), IsEmpty());
}

TEST(NearNames, EditDistanceCountsInsertionsDeletionsAndReplacements) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("Range", "rANGE"), 0u);
}

}  // namespace
}  // namespace boresight
