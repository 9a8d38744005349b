// Boxes of objects drawn from the reflection model: stated covariances, lengths and classes against the truth.
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/tracker/simulated_object.hpp"

namespace boresight::tracking {
namespace {

using extended_object::kRoadUserClasses;
using extended_object::RoadUserClass;
using support::OneObjectTrack;
using support::Reflections;
using support::SimulatedObject;
using support::SimulatedRadar;

constexpr double kBoxScan_s = 0.075;
constexpr double kNees95 = 5.991;  // of two degrees of freedom
constexpr std::size_t kTruckIndex = support::index_of(RoadUserClass::kTruck);

SimulatedRadar radar_at(double x, double y) {
  SimulatedRadar r;
  r.viewpoint.sensor_m = {x, y};
  return r;
}

/// Ahead of the radar at the origin and driving away from it; at the end the second radar, abeam, detects it.
OneObjectTrack seen_from_behind_then_abeam(SimulatedObject o, std::uint64_t seed) {
  o.centre_m = {12.0, 1.0};
  o.speed_mps = 8.0;
  OneObjectTrack track(o, seed);
  Reflections behind, abeam;
  for (int i = 0; i < 40; ++i) track.scan(radar_at(0.0, 0.0), behind, kBoxScan_s);
  for (int i = 0; i < 20; ++i) track.scan(radar_at(40.0, 12.0), abeam, kBoxScan_s);
  return track;
}

TEST(BoxConsistency, CentreOfACarLiesInItsEllipseWhenAnotherRadarDetectsItAbeam) {
  constexpr int kTracks = 200;
  int inside = 0;
  double error_m = 0.0;
  support::Random random(1);
  for (int i = 0; i < kTracks; ++i) {
    const OneObjectTrack t = seen_from_behind_then_abeam(support::drawn_object(random, RoadUserClass::kCar),
                                                         100 + static_cast<std::uint64_t>(i));
    if (t.centre_nees() < kNees95) ++inside;
    error_m += (t.box().centre_m - t.truth.centre_m).norm() / kTracks;
  }
  std::printf("  car, behind then abeam: %d of %d within 95 %%, mean error %.2f m\n", inside, kTracks, error_m);
  EXPECT_GE(inside, 180);
  EXPECT_LT(error_m, 0.8);
}

struct TrackFigures {
  double centre_nees = 0.0, length_nees = 0.0, length_error_m = 0.0;
};
/// Mean over tracks that one radar detects from behind at first, then another from ahead in turn with it.
TrackFigures figures_between_two_radars(RoadUserClass c, int tracks) {
  TrackFigures f;
  support::Random random(2);
  for (int i = 0; i < tracks; ++i) {
    SimulatedObject o = support::drawn_object(random, c);
    o.centre_m = {-10.0, support::uniform(random, -6.0, 6.0)};
    o.speed_mps = 4.0;
    OneObjectTrack t(o, 500 + static_cast<std::uint64_t>(i));
    Reflections ahead, behind;
    double nees = 0.0;
    constexpr int kAlone = 40, kScans = 160, kFrom = 80;
    for (int scan = 0; scan < kScans; ++scan) {
      if (scan >= kAlone && scan % 2 == 0) {
        t.scan(radar_at(45.0, 0.0), ahead, 0.5 * kBoxScan_s);
      } else {
        t.scan(radar_at(-35.0, 0.0), behind, 0.5 * kBoxScan_s);
      }
      if (scan >= kFrom) nees += t.centre_nees() / (kScans - kFrom);
    }
    f.centre_nees += nees / tracks;
    const ClassBox& box = t.memory.classes[support::index_of(c)];
    const double error_m = box.length_m - o.length_m;
    f.length_nees += error_m * error_m / box.length_variance_m2 / tracks;
    f.length_error_m += std::abs(error_m) / tracks;
  }
  return f;
}

TrackFigures expect_sure_centre(RoadUserClass c) {
  const TrackFigures f = figures_between_two_radars(c, 250);
  std::printf("  %s: NEES of the centre %.2f, of the length %.2f, length off by %.2f m\n",
              std::string(extended_object::name_of(c)).c_str(), f.centre_nees, f.length_nees, f.length_error_m);
  EXPECT_GT(f.centre_nees, 0.4);
  EXPECT_LT(f.centre_nees, 3.0);
  return f;
}

TEST(BoxConsistency, CentreOfCarsIsAsSureAsStated) {
  expect_sure_centre(RoadUserClass::kCar);
}

TEST(BoxConsistency, LengthOfATruckIsLearntFromBothEnds) {
  const TrackFigures f = expect_sure_centre(RoadUserClass::kTruck);
  EXPECT_LT(f.length_nees, 2.0);
  // Of a normal prior with 3 m, the mean error is 2.4 m. The own depths of the ends last, so it does not go to 0.
  EXPECT_LT(f.length_error_m, 1.6);
}

TEST(BoxConsistency, TrueClassHasTheLargestMeanProbability) {
  for (std::size_t c = 0; c < kRoadUserClasses; ++c) {
    constexpr int kTracks = 60;
    std::array<double, kRoadUserClasses> mean{};
    support::Random random(3);
    for (int i = 0; i < kTracks; ++i) {
      SimulatedObject o = support::drawn_object(random, static_cast<RoadUserClass>(c));
      o.centre_m = {support::uniform(random, 12.0, 25.0), support::uniform(random, -8.0, 8.0)};
      o.heading_rad = support::uniform(random, -0.6, 0.6);
      OneObjectTrack t(o, 900 + static_cast<std::uint64_t>(i));
      Reflections first, second;
      for (int scan = 0; scan < 100; ++scan) {
        if (scan % 2 == 0) {
          t.scan(radar_at(0.0, 0.0), first, 0.5 * kBoxScan_s);
        } else {
          t.scan(radar_at(30.0, 25.0), second, 0.5 * kBoxScan_s);
        }
      }
      for (std::size_t k = 0; k < kRoadUserClasses; ++k) mean[k] += t.memory.probability[k] / kTracks;
    }
    std::printf("  drawn %zu: %.2f %.2f %.2f %.2f %.2f\n", c, mean[0], mean[1], mean[2], mean[3], mean[4]);
    // Vans are rare, and cars but for 1 m.
    if (c == support::index_of(RoadUserClass::kVan)) continue;
    EXPECT_EQ(std::max_element(mean.begin(), mean.end()) - mean.begin(), static_cast<std::ptrdiff_t>(c));
  }
}

/// The same draws in a world that is turned as a whole.
OneObjectTrack turned_track(double turn_rad, double mount_turn_rad) {
  const Eigen::Matrix2d turn = support::rotation(turn_rad);
  SimulatedObject o;
  o.object_class = RoadUserClass::kTruck;
  o.length_m = 12.0;
  o.width_m = 2.5;
  o.centre_m = turn * Eigen::Vector2d(14.0, 3.0);
  o.heading_rad = 0.4 + turn_rad;
  OneObjectTrack t(o, 7);
  t.road_rad = turn_rad;
  Reflections first, second;
  for (int scan = 0; scan < 60; ++scan) {
    SimulatedRadar radar;
    radar.viewpoint.sensor_m =
        support::vector_of(turn * (scan % 2 == 0 ? Eigen::Vector2d(0.0, 0.0) : Eigen::Vector2d(30.0, 30.0)));
    radar.viewpoint.facing_rad = turn_rad + mount_turn_rad + (scan % 2 == 0 ? 0.4 : -1.5);
    radar.viewpoint.half_view_rad = 2.2;
    radar.viewpoint.view_edge_rad = 0.05;
    t.scan(radar, scan % 2 == 0 ? first : second, 0.5 * kBoxScan_s);
  }
  return t;
}

TEST(BoxConsistency, TurnedWorldGivesTheTurnedBox) {
  const OneObjectTrack t = turned_track(0.0, 0.0);
  const Box b = t.box();
  for (const double turn_rad : {0.9, 2.6, -1.7}) {
    const Eigen::Matrix2d turn = support::rotation(turn_rad);
    const OneObjectTrack u = turned_track(turn_rad, 0.0);
    const Box c = u.box();
    EXPECT_LT((c.centre_m - turn * b.centre_m).norm(), 1e-6);
    EXPECT_LT((c.covariance_m2 - turn * b.covariance_m2 * turn.transpose()).norm(), 1e-6);
    EXPECT_LT((c.centre_length_covariance_m2 - turn * b.centre_length_covariance_m2).norm(), 1e-6);
    EXPECT_NEAR(std::remainder(c.heading_rad - b.heading_rad - turn_rad, 2.0 * std::numbers::pi), 0.0, 1e-8);
    EXPECT_NEAR(c.length_m, b.length_m, 1e-6);
    for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
      EXPECT_NEAR(u.memory.probability[k], t.memory.probability[k], 1e-6);
    }
  }
}

TEST(BoxConsistency, MountTurnedWithTheBoxStillInViewGivesTheSameBox) {
  const Box b = turned_track(0.0, 0.0).box();
  for (const double mount_turn_rad : {0.3, -0.3}) {
    const Box c = turned_track(0.0, mount_turn_rad).box();
    EXPECT_LT((c.centre_m - b.centre_m).norm(), 1e-3);
    EXPECT_NEAR(c.length_m, b.length_m, 1e-3);
  }
}

}  // namespace
}  // namespace boresight::tracking
