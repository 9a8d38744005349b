#include "services/boresight/track/measurement_table.hpp"

#include <cmath>
#include <string>

#include <gmock/gmock.h>

#include "interfaces/messages/header.hpp"
#include "services/boresight/score/table.hpp"
#include "tests/unit/track/files.hpp"

namespace boresight::track {
namespace {

using ::testing::HasSubstr;

class MeasurementTables : public ::testing::Test {
 protected:
  testing::Files files_{"track_measurements"};

  MeasurementTable read(std::string_view text, std::size_t scans = 3) {
    return read_measurements(files_.write("measurements.csv", text), scans);
  }
  std::string error_of(std::string_view text) {
    try {
      (void)read(text);
    } catch (const score::InputError& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(MeasurementTables, RowsAreSortedByStepAndAScanMayBeEmpty) {
  const MeasurementTable table = read("step,x,y\n3,1,2\n1,-3.5,4e1\n3,5,6\n");
  EXPECT_FALSE(table.has_range_rates);
  ASSERT_EQ(table.scans.size(), 3U);
  ASSERT_EQ(table.scans[0].size(), 1U);
  EXPECT_EQ(table.scans[0][0].position_m, Eigen::Vector2d(-3.5, 40.0));
  EXPECT_TRUE(std::isnan(table.scans[0][0].range_rate_mps));
  EXPECT_TRUE(table.scans[1].empty());
  ASSERT_EQ(table.scans[2].size(), 2U);
  EXPECT_EQ(table.scans[2][1].position_m, Eigen::Vector2d(5.0, 6.0));
}

TEST_F(MeasurementTables, RangeRateIsTheOptionalFourthColumn) {
  const MeasurementTable table = read("step,x,y,range_rate\n2,1,2,-7.25\n");
  EXPECT_TRUE(table.has_range_rates);
  EXPECT_EQ(table.scans[1][0].range_rate_mps, -7.25);
  EXPECT_THAT(error_of("step,x,y,range_rate\n2,1,2,\n"), HasSubstr("measurements.csv:2: range_rate: read \"\""));
}

TEST_F(MeasurementTables, ErrorsNameFileLineColumnAndAllowedValues) {
  EXPECT_THAT(error_of("step,x,y\n1,0,0\n4,0,0\n"),
              HasSubstr("measurements.csv:3: step: read \"4\", allowed is a whole number 1 … 3"));
  EXPECT_THAT(error_of("step,x,y\n0,0,0\n"), HasSubstr("measurements.csv:2: step: read \"0\""));
  EXPECT_THAT(error_of("step,x,y\n1,nan,0\n"), HasSubstr("measurements.csv:2: x: read \"nan\", allowed is a number"));
  EXPECT_THAT(error_of("step,x,y\n1,0,left\n"), HasSubstr("measurements.csv:2: y: read \"left\""));
  EXPECT_THAT(error_of("step,x,y\n1,0\n"), HasSubstr("measurements.csv:2: has 2 columns, the header has 3"));
  EXPECT_THAT(error_of("step,x\n1,0\n"), HasSubstr("measurements.csv:1: the header lacks the column y"));
}

TEST_F(MeasurementTables, MoreMeasurementsThanAScanHoldsAreRefused) {
  std::string text = "step,x,y\n";
  for (std::size_t i = 0; i < kMaxDetections; ++i) text += "2,1,1\n";
  EXPECT_EQ(read(text).scans[1].size(), kMaxDetections);
  EXPECT_THAT(error_of(text + "2,1,1\n"),
              HasSubstr("measurements.csv:1026: step: read \"2\", allowed is at most 1024"));
}

}  // namespace
}  // namespace boresight::track
