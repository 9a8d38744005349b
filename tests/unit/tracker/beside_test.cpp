// Vehicles side by side: whose a detection is.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

TEST(TracksBeside, AreNotDrawnToWhatLiesOnAnother) {
  // A car comes up beside a truck and is hidden then. Of the truck a place on its flank is seen, where the car is, and
  // one farther ahead than it was known to reach: as a part of it, that leaves the first one over.
  constexpr double kTruckFlank_m = -2.35;
  constexpr int kHidden = 110, kEnd = 118;
  const Eigen::Vector2d truck_mps(3.0, 0.0);
  Tracker tracker(two_radars(), Config{});
  Scene scene;
  double truck_x = 30.0, car_x = 16.0;
  for (int i = 0; i < kEnd; ++i) {
    scene.begin((1000 + 50 * i) * kMillisecond);
    const Eigen::Vector2d car_mps(std::clamp(6.0 - 0.15 * (i - 70), 3.2, 6.0), 0.0);
    truck_x += 0.05 * truck_mps.x();
    car_x += 0.05 * car_mps.x();
    if (i < kHidden) {
      for (const double along : {-4.0, -2.0, 0.0, 2.0, 4.0}) scene.add({truck_x + along, kTruckFlank_m}, truck_mps);
      for (const double across : {-0.6, 0.0, 0.6}) scene.add({car_x - 2.2, across}, car_mps);
    } else {
      scene.add({car_x - 1.0, kTruckFlank_m}, truck_mps);
      scene.add({truck_x + 5.4, kTruckFlank_m}, truck_mps);
    }
    tracker.step(*scene.scan);
  }
  const auto list = std::make_unique<TrackList>();
  tracker.write(*list);
  ASSERT_EQ(list->number_of_tracks, 2u);
  const Track& car = list->tracks[1];
  EXPECT_NEAR(car.position_vehicle_m[0], car_x, 0.5);
  EXPECT_NEAR(car.position_vehicle_m[1], 0.0, 0.5);
  EXPECT_EQ(car.number_of_detections, 0u) << "it is hidden";
}

}  // namespace
}  // namespace boresight::tracking
