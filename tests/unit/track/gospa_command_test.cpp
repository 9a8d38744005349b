// `boresight gospa` as a user calls it.
#include <gmock/gmock.h>

#include "tests/unit/track/command_test.hpp"

namespace boresight::track {
namespace {

using ::testing::HasSubstr;

class GospaCommand : public testing::CommandTest {};

TEST_F(GospaCommand, PrintsBothBasesOrOne) {
  // Step 1: 3 m apart. Step 2: missed.
  files_.write("truth.csv", "step,id,cx,cy,vx,vy,X11,X12,X22\n1,1,0,0,0,0,1,0,1\n2,1,0,0,0,0,1,0,1\n");
  files_.write("estimates.csv", "step,cx,cy,vx,vy,X11,X12,X22\n1,0,3,0,0,1,0,1\n");
  EXPECT_EQ(run("gospa truth.csv estimates.csv"), 0);
  EXPECT_THAT(output_, HasSubstr("mean  squared (m²)      9.500          4.500    5.000    0.000\n"
                                 "mean  true (m)          6.500          1.500    5.000    0.000\n"
                                 "2 steps; 1.00 objects and 0.50 estimates a step\n"));
  EXPECT_EQ(run("gospa truth.csv estimates.csv --base true --per-step"), 0);
  EXPECT_THAT(output_, HasSubstr("\n1     true (m)          3.000"));
  EXPECT_THAT(output_, ::testing::Not(HasSubstr("squared")));
}

TEST_F(GospaCommand, NamesWhatItCannotJudge) {
  files_.write("truth.csv", "step,id,cx,cy,vx,vy,X11,X12,X22\n1,1,0,0,0,0,1,0,1\n");
  files_.write("estimates.csv", "step,cx,cy,vx,vy,X11,X12,X22\n1,0,0,0,0,1,0,1\n2,0,0,0,0,1,0,1\n");
  EXPECT_EQ(run("gospa truth.csv estimates.csv"), 1);
  EXPECT_THAT(output_, HasSubstr("estimates.csv: steps after 1, the last of the truth, are not judged"));
  EXPECT_EQ(run("gospa truth.csv estimates.csv --base root"), 2);
  EXPECT_EQ(run("gospa absent.csv estimates.csv"), 3);
  EXPECT_THAT(output_, HasSubstr("absent.csv"));
  files_.write("empty.csv", "step,id,cx,cy,vx,vy,X11,X12,X22\n");
  EXPECT_EQ(run("gospa empty.csv estimates.csv"), 3);
  EXPECT_THAT(output_, HasSubstr("empty.csv: has no object"));
}

}  // namespace
}  // namespace boresight::track
