// `boresight track` as a user calls it.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>

#include "services/boresight/track/estimates.hpp"
#include "tests/unit/track/command_test.hpp"

namespace boresight::track {
namespace {

using ::testing::HasSubstr;

class TrackCommand : public testing::CommandTest {};

TEST_F(TrackCommand, WritesEstimatesOfEachTracker) {
  files_.write("params.txt", testing::kParameters);
  std::string table = "step,x,y\n";
  for (const int step : {1, 2, 3}) {
    for (const char* const point : {"80,-2", "80.5,-1.5", "79.5,-2.5", "80,-1", "79.4,-2", "81,-2.2", "80.2,-2.9"}) {
      table += std::to_string(step) + "," + point + "\n";
    }
  }
  files_.write("measurements.csv", table);
  for (const std::string tracker : {"pmbm", "phd"}) {
    EXPECT_EQ(
        run("track --measurements measurements.csv --params params.txt --out estimates.csv --repeat 3 --tracker " +
            tracker),
        0);
    EXPECT_THAT(output_, HasSubstr(tracker + ": 3 scans, "));
    EXPECT_THAT(output_, HasSubstr(" ms, of each scan the least of 3 passes\n"));
    const ObjectsByStep estimates = read_objects(files_.path("estimates.csv"));
    ASSERT_EQ(estimates.size(), 3U) << tracker;
    ASSERT_EQ(estimates[2].size(), 1U) << tracker;
    EXPECT_NEAR(estimates[2][0].ellipse.centre_m.x(), 80.0, 1.0);
    EXPECT_NEAR(estimates[2][0].ellipse.centre_m.y(), -2.0, 1.0);
    EXPECT_NE(estimates[2][0].id, 0U);
  }
}

TEST_F(TrackCommand, NamesFileLineAndAllowedValues) {
  const std::string command = "track --measurements measurements.csv --params params.txt --out estimates.csv ";
  files_.write("params.txt", testing::kParameters);
  files_.write("measurements.csv", "step,x,y\n1,0,east\n");
  EXPECT_EQ(run(command), 3);
  EXPECT_THAT(output_, HasSubstr("measurements.csv:2: y: read \"east\", allowed is a number"));
  files_.write("measurements.csv", "step,x,y,range_rate\n1,0,0,1\n");
  EXPECT_EQ(run(command), 2);
  EXPECT_THAT(output_, HasSubstr("params.txt lacks their keys range_rate_std and range_rate_span"));
  files_.write("params.txt", std::string(testing::kParameters) + "Pb = 1\n");
  EXPECT_EQ(run(command), 2);
  EXPECT_THAT(output_, HasSubstr("params.txt:25: unknown key \"Pb\""));
  EXPECT_EQ(run(command + "--tracker kalman"), 2);
  EXPECT_FALSE(std::filesystem::exists(files_.path("estimates.csv")));
}

}  // namespace
}  // namespace boresight::track
