// Tracks as objects at the time of a scan.
#include "services/ghost_filter/core/classify/predicted_object.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

Track car() {
  Track track{};
  track.tracking_id = 7;
  track.status = TrackStatus::kConfirmed;
  track.position_vehicle_m = {20.0F, 3.0F};
  track.velocity_over_ground_mps = {15.0F, 0.0F};
  track.length_m = 4.5F;
  track.width_m = 1.8F;
  track.existence_probability = 0.9F;
  return track;
}

TEST(PredictedObject, IsWhereItIsThenAsTheOwnVehicleSeesIt) {
  const auto object = predicted(car(), {}, 0.1, geometry::ego_step(10.0, 0.0, 0.1), 0.1);
  ASSERT_TRUE(object);
  EXPECT_NEAR(object->position_m.x(), 20.0 + 0.1 * (15.0 - 10.0), 1e-6);
  EXPECT_NEAR(object->position_m.y(), 3.0, 1e-6);
  EXPECT_NEAR(object->velocity_mps.x(), 15.0, 1e-6);
}

TEST(PredictedObject, CountsAsFarAsItIsThoughtToBeNoImage) {
  const geometry::EgoStep none = geometry::ego_step(0.0, 0.0, 0.0);
  const auto real = predicted(car(), {.log_odds = -3.0}, 0.0, none, 0.1);
  const auto image = predicted(car(), {.log_odds = 3.0}, 0.0, none, 0.1);
  EXPECT_GT(real->weight, 0.88);
  EXPECT_LT(image->weight, 0.01);
  EXPECT_NEAR(image->weight + image->image, 0.9, 1e-6);
  Track tentative = car();
  tentative.status = TrackStatus::kTentative;
  EXPECT_NEAR(predicted(tentative, {.log_odds = -3.0}, 0.0, none, 0.1)->weight, 0.1 * real->weight, 1e-6);
}

TEST(PredictedObject, IsNoneWhereTheTrackIsNotANumber) {
  Track track = car();
  track.velocity_over_ground_mps[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(predicted(track, {}, 0.0, geometry::ego_step(0.0, 0.0, 0.0), 0.1));
}

}  // namespace
}  // namespace boresight::ghosts
