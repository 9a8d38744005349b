// Vehicles side by side: whose a detection is.
#include <algorithm>
#include <functional>
#include <utility>

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
  Tracker tracker(two_radars(), RulesConfig{});
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

/// A truck creeps in the right lane, and a car in the own one beside its middle at `car_mps`; the car's rear is seen
/// about `car_y_m` in the scans from `from` to before `to`.
void creep(Tracker& tracker, int scans, double car_mps, double car_y_m, int from, int to,
           const std::function<void(Scene&, int)>& add = {}) {
  constexpr double kTruck_mps = 1.2;
  Scene scene;
  for (int i = 0; i < scans; ++i) {
    scene.begin((1000 + 50 * i) * kMillisecond);
    for (const double along : {-4.0, -2.0, 0.0, 2.0, 4.0}) {
      scene.add({25.0 + 0.05 * i * kTruck_mps + along, -2.35}, {kTruck_mps, 0.0});
    }
    const double rear_x = 24.0 + 0.05 * i * car_mps;
    for (const double across : {car_y_m - 0.3, car_y_m + 0.3}) {
      if (i >= from && i < to) scene.add({rear_x, across}, {car_mps, 0.0});
    }
    if (add) add(scene, i);
    tracker.step(*scene.scan);
  }
}

TEST(TracksBeside, AreNotGivenWhatIsNearAnotherAndMovesAsThatOneDoes) {
  constexpr int kHidden = 100;
  Tracker tracker(two_radars(), RulesConfig{});
  creep(tracker, kHidden + 4, 1.6, -0.3, 0, kHidden, [](Scene& scene, int i) {
    // Noise, or a mirror: nearer to the car's box than to the truck's, with the truck's range rate.
    if (i >= kHidden) scene.add({24.5 + 0.05 * i * 1.6, -1.0}, {1.2, 0.0});
  });
  const auto list = std::make_unique<TrackList>();
  tracker.write(*list);
  ASSERT_EQ(list->number_of_confirmed_tracks, 2u);
  const auto car = std::max_element(list->tracks.begin(), list->tracks.begin() + 2, [](const Track& a, const Track& b) {
    return a.position_vehicle_m[1] < b.position_vehicle_m[1];
  });
  EXPECT_EQ(car->number_of_detections, 0u);
}

TEST(TracksBeside, BeginBesideATruckThatMovesOtherwise) {
  constexpr int kAppears = 100;
  for (const auto& [car_mps, tracks] : {std::pair{1.6, 2u}, {1.25, 1u}}) {
    Tracker tracker(two_radars(), RulesConfig{});
    creep(tracker, kAppears + 10, car_mps, -0.6, kAppears, kAppears + 10);
    const auto list = std::make_unique<TrackList>();
    tracker.write(*list);
    EXPECT_EQ(list->number_of_confirmed_tracks, tracks) << car_mps << " m/s";
  }
}

}  // namespace
}  // namespace boresight::tracking
