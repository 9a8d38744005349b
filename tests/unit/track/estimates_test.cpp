#include "services/boresight/track/estimates.hpp"

#include <cmath>
#include <memory>
#include <string>

#include <gmock/gmock.h>

#include "services/boresight/score/table.hpp"
#include "tests/unit/track/files.hpp"

namespace boresight::track {
namespace {

using ::testing::HasSubstr;

class EstimateTables : public ::testing::Test {
 protected:
  testing::Files files_{"track_estimates"};

  ObjectsByStep read(std::string_view text) { return read_objects(files_.write("estimates.csv", text)); }
  std::string error_of(std::string_view text) {
    try {
      (void)read(text);
    } catch (const score::InputError& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(EstimateTables, WhatIsWrittenIsReadBackExactly) {
  ExtendedObject object;
  object.ellipse.centre_m = {0.1, -1.0 / 3.0};
  object.ellipse.extent_m2 << 4.0, 0.3, 0.3, 1.0 / 7.0;
  object.velocity_mps = {-12.5, 1e-7};
  object.id = 4'000'000'000;
  const ObjectsByStep objects = {{object}, {}, {object, object}};
  EXPECT_EQ(read(estimates_csv(objects)), objects);
  EXPECT_EQ(number_of_objects(objects), 3U);
}

TEST_F(EstimateTables, ColumnsStandInAnyOrderAndAnIdentityIsOptional) {
  const ObjectsByStep truth = read("step,id,cx,cy,vx,vy,X11,X12,X22\n2,7,1,2,3,4,5,1,6\n");
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_TRUE(truth[0].empty());
  EXPECT_EQ(truth[1][0].id, 7U);
  EXPECT_EQ(truth[1][0].ellipse.centre_m, Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(truth[1][0].velocity_mps, Eigen::Vector2d(3.0, 4.0));
  EXPECT_EQ(truth[1][0].ellipse.extent_m2, (Eigen::Matrix2d() << 5.0, 1.0, 1.0, 6.0).finished());
  EXPECT_EQ(read("step,cx,cy,vx,vy,X11,X12,X22\n1,1,2,3,4,5,1,6\n")[0][0].id, 0U);
  EXPECT_TRUE(read("step,cx,cy,vx,vy,X11,X12,X22\n").empty());
}

TEST_F(EstimateTables, AnExtentMustBePositiveDefinite) {
  const std::string header = "step,cx,cy,vx,vy,X11,X12,X22\n";
  EXPECT_THAT(error_of(header + "1,0,0,0,0,-1,0,1\n"), HasSubstr("estimates.csv:2: X11: read \"-1\""));
  EXPECT_THAT(error_of(header + "1,0,0,0,0,1,0,0\n"), HasSubstr("estimates.csv:2: X22: read \"0\""));
  EXPECT_THAT(error_of(header + "1,0,0,0,0,1,2,1\n"),
              HasSubstr("estimates.csv:2: X12: read \"2\", allowed is a positive definite extent"));
  EXPECT_THAT(error_of(header + "0,0,0,0,0,1,0,1\n"), HasSubstr("estimates.csv:2: step: read \"0\""));
}

TEST(EstimatesOfTracks, TracksAboveOneHalfBecomeEllipsesInTheirBoxes) {
  const auto tracks = std::make_unique<TrackList>();
  tracks->number_of_tracks = 2;
  for (Track& track : tracks->tracks) track = {};
  Track& likely = tracks->tracks[0];
  likely.tracking_id = 5;
  likely.existence_probability = 0.51F;
  likely.position_vehicle_m = {10.0F, -2.0F, 0.0F};
  likely.velocity_over_ground_mps = {3.0F, 4.0F};
  likely.length_m = 6.0F;
  likely.width_m = 2.0F;
  likely.heading_rad = static_cast<float>(M_PI_2);
  tracks->tracks[1] = likely;
  tracks->tracks[1].existence_probability = 0.5F;
  tracks->tracks[2] = likely;  // beyond number_of_tracks

  const std::vector<ExtendedObject> estimates = estimates_of(*tracks);
  ASSERT_EQ(estimates.size(), 1U);
  EXPECT_EQ(estimates[0].id, 5U);
  EXPECT_EQ(estimates[0].ellipse.centre_m, Eigen::Vector2d(10.0, -2.0));
  EXPECT_EQ(estimates[0].velocity_mps, Eigen::Vector2d(3.0, 4.0));
  // The length of 6 m lies along y: X = diag((2/2)², (6/2)²).
  EXPECT_TRUE(estimates[0].ellipse.extent_m2.isApprox((Eigen::Matrix2d() << 1.0, 0.0, 0.0, 9.0).finished(), 1e-6));
}

}  // namespace
}  // namespace boresight::track
