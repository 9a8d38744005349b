// What is due with a scan: more radars do not make it more often, and scans that come together lose nothing.
#include "services/ghost_filter/core/classify/pace.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

std::size_t taken_in_a_second(int scans, std::size_t wanted) {
  Pace pace(16, 0.0125);
  std::size_t taken = 0;
  for (int i = 0; i < 5 * scans; ++i) {
    pace.advance(1.0 / scans);
    const std::size_t now = pace.take(wanted);
    EXPECT_LE(now, 16U);
    if (i >= 4 * scans) taken += now;  // what was saved in the beginning is spent by then
  }
  return taken;
}

TEST(Pace, IsKeptHoweverManyScansThereAre) {
  EXPECT_EQ(taken_in_a_second(80, 40), 1280U);
  EXPECT_EQ(taken_in_a_second(160, 40), 1280U);
  EXPECT_EQ(taken_in_a_second(40, 40), 640U) << "sixteen in each scan";
  EXPECT_EQ(taken_in_a_second(80, 5), 400U) << "no more than there are";
}

TEST(Pace, ScansThatComeTogetherShareWhatIsDue) {
  Pace pace(16, 0.0125);
  pace.advance(1.0);
  for (int scan = 0; scan < 4; ++scan) EXPECT_EQ(pace.take(100), 16U);
  EXPECT_EQ(pace.take(100), 0U);
  pace.advance(0.05 - 1e-9);
  for (int scan = 0; scan < 4; ++scan) EXPECT_EQ(pace.take(100), 16U) << "a nanosecond does not count";
}

TEST(Pace, TimeThatDoesNotGoOnMakesNothingDue) {
  Pace pace(8, 0.0125);
  EXPECT_EQ(pace.take(100), 8U) << "the first time";
  pace.advance(-1.0);
  pace.advance(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(pace.take(100), 0U);
}

}  // namespace
}  // namespace boresight::ghosts
