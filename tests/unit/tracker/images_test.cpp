// What may be another track's image in a mirror, and waits.
#include "services/tracker/core/images.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

const Eigen::Vector2d kMirrorSensor_m(3.6, 0.0);

TrackedObject object_at(double x_m, double y_m, double speed_mps, double length_m, double dbsm, double age_s) {
  TrackedObject track;
  track.confirmed = age_s > 1.0;
  track.age_s = age_s;
  track.extent.length_m = length_m;
  track.extent.strongest_dbsm = dbsm;
  track.state.mean << x_m, y_m, speed_mps, 0.0, 0.0, 0.0;
  return track;
}

/// How long what is new and weak, seen there at that speed, waits beside a truck of 16 m with its rear at 24 m.
double wait_s(double x_m, double y_m, double speed_mps) {
  const std::vector<TrackedObject> tracks{object_at(x_m, y_m, speed_mps, 4.5, -6.0, 0.2),
                                          object_at(32.0, -3.6, 1.2, 16.0, 15.0, 9.0)};
  return image_wait_s(tracks[0], tracks, kMirrorSensor_m, RulesConfig{});
}

TEST(Images, OfATrucksRearAreNearerThanItsMiddle) {
  EXPECT_EQ(wait_s(26.0, 7.6, 1.2), RulesConfig{}.confirm_image_age_s);
  EXPECT_EQ(wait_s(40.0, 7.6, 1.2), RulesConfig{}.confirm_image_age_s) << "of its front";
  EXPECT_EQ(wait_s(20.0, 7.6, 1.2), 0.0) << "nearer than its rear is";
  EXPECT_EQ(wait_s(52.0, 7.6, 1.2), 0.0) << "farther than any detour by the next lane";
}

TEST(Images, MoveAsTheirObjects) {
  EXPECT_EQ(wait_s(28.0, 0.0, 1.5), 0.0) << "in a jam, the next lane's 0.3 m/s are a car's own";
  EXPECT_EQ(wait_s(28.0, 0.0, 1.3), RulesConfig{}.confirm_image_age_s);
}

}  // namespace
}  // namespace boresight::tracking
