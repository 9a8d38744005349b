// Flags of tracks: why an object may be undetected. Each in a scene that sets
// it, and in one that does not.
#include <algorithm>

#include <gtest/gtest.h>

#include "services/tracker/core/output/detectability.hpp"
#include "tests/unit/tracker/any_tracker.hpp"

namespace boresight::tracking {
namespace {

constexpr Sight kFreeSight{1.0, 0.0, 1.0};

TEST(Detectability, ObstacleIsTheFirstThatHolds) {
  const DetectabilityParameters p;
  EXPECT_EQ(obstacle(kFreeSight, 0.0, p), Obstacle::kNone);
  EXPECT_EQ(obstacle({0.4, 0.9, 0.1}, 1.0, p), Obstacle::kOutOfView);
  EXPECT_EQ(obstacle({0.6, 0.9, 0.1}, 1.0, p), Obstacle::kOccluded);
  EXPECT_EQ(obstacle({0.6, 0.4, 0.1}, 1.0, p), Obstacle::kZeroDoppler);
  EXPECT_EQ(obstacle({0.6, 0.4, 0.6}, 1.0, p), Obstacle::kMerged);
  EXPECT_EQ(obstacle({0.6, 0.4, 0.6}, 0.1, p), Obstacle::kNone);
}

TEST(Detectability, FlagIsThatOfTheRadarNearestToADetection) {
  const DetectabilityParameters p;
  RecentScans scans;
  Detectability object;
  EXPECT_EQ(object.flags(scans, p), track_flag::kOutOfView) << "no radar has delivered";
  scans.add(0, 0.05);
  object.set(0, Obstacle::kOccluded);
  EXPECT_EQ(object.flags(scans, p), track_flag::kOccluded);
  scans.add(3, 0.05);
  object.set(3, Obstacle::kZeroDoppler);
  EXPECT_EQ(object.flags(scans, p), track_flag::kZeroDoppler);
  scans.add(1, 0.05);
  object.set(1, Obstacle::kOutOfView);
  EXPECT_EQ(object.flags(scans, p), track_flag::kZeroDoppler);
  object.set(0, Obstacle::kNone);
  EXPECT_EQ(object.flags(scans, p), 0U);
}

TEST(Detectability, RadarThatIsSilentAndScansOfNoRadarDoNotCount) {
  const DetectabilityParameters p;
  RecentScans scans;
  Detectability object;
  scans.add(0, 0.05);
  object.set(0, Obstacle::kNone);
  scans.add(-1, 0.5 * p.recent_scan_s);
  object.set(-1, Obstacle::kMerged);
  EXPECT_EQ(object.flags(scans, p), 0U);
  scans.add(1, 0.6 * p.recent_scan_s);
  EXPECT_EQ(object.flags(scans, p), track_flag::kOutOfView);
  scans.add(0, 0.05);
  EXPECT_EQ(object.flags(scans, p), 0U);
  scans.clear();
  EXPECT_EQ(object.flags(scans, p), track_flag::kOutOfView);
}

class TrackFlags : public AnyTracker {
 protected:
  /// Of the track nearest to a place, tentative ones included.
  [[nodiscard]] const Track& track_at(const Eigen::Vector2d& place_m) {
    const TrackList& tracks = list();
    const auto distance_m = [&place_m](const Track& t) {
      return (Eigen::Vector2d(t.position_vehicle_m[0], t.position_vehicle_m[1]) - place_m).norm();
    };
    EXPECT_GT(tracks.number_of_tracks, 0U);
    return *std::min_element(tracks.tracks.begin(), tracks.tracks.begin() + tracks.number_of_tracks,
                             [&](const Track& a, const Track& b) { return distance_m(a) < distance_m(b); });
  }
  [[nodiscard]] std::uint32_t flags_at(const Eigen::Vector2d& place_m) { return track_at(place_m).flags; }
};

TEST_P(TrackFlags, OutOfViewIsSetOnceAnObjectHasLeftTheViewOfAllRadars) {
  const Moving car = drive({{20.0, -8.0}, {-8.0, 0.0}}, 25);
  EXPECT_EQ(flags_at(car.position_m), 0U);
  for (int i = 0; i < 5; ++i) step_empty(2);
  EXPECT_EQ(flags_at(car.position_m), 0U) << "radar 1 had it in view lately";
  for (int i = 0; i < 16; ++i) step_empty(1U + static_cast<std::uint32_t>(i % 2));
  const Track& abeam = track_at(car.after(21 * kScan_s).position_m);
  EXPECT_EQ(abeam.flags, track_flag::kOutOfView);
  EXPECT_EQ(abeam.update, TrackUpdate::kPredicted);
}

TEST_P(TrackFlags, OccludedIsSetBehindAnotherObjectAndNotBesideIt) {
  const Moving front{{20.0, 0.0}, {8.0, 0.0}}, behind{{50.0, 0.0}, {8.0, 0.0}}, beside{{50.0, 14.0}, {8.0, 0.0}};
  for (int i = 0; i < 30; ++i) {
    scene_.begin(now_);
    for (const Moving& o : {front, behind, beside}) add(o.after(kScan_s * i));
    take();
  }
  const double last_s = 29 * kScan_s;
  EXPECT_EQ(flags_at(front.after(last_s).position_m), 0U);
  EXPECT_EQ(flags_at(behind.after(last_s).position_m), track_flag::kOccluded);
  EXPECT_EQ(flags_at(beside.after(last_s).position_m), 0U);
}

TEST_P(TrackFlags, ZeroDopplerIsSetWhileAnObjectCrossesTheLineOfSight) {
  Moving car{{25.0, -12.0}, {0.0, 8.0}};
  car = drive(car, 20);
  EXPECT_EQ(flags_at(car.position_m), 0U);
  for (int i = 0; i < 40; ++i) {
    car = car.after(kScan_s);
    step(car);
    if (std::abs(car.position_m.y()) < 0.5) {
      EXPECT_EQ(flags_at(car.position_m), track_flag::kZeroDoppler) << car.position_m.y();
    }
    if (std::abs(car.position_m.y()) > 4.0) {
      EXPECT_EQ(flags_at(car.position_m), 0U) << car.position_m.y();
    }
  }
}

/// Two people who come together and walk abreast, `apart_m` from each other. In
/// the last scan there is one detection, `off_m` from the first.
class MergedFlag : public TrackFlags {
 protected:
  struct Flags {
    std::uint32_t first = 0, second = 0;
  };
  Flags last_scan(double apart_m, double off_m) {
    const auto place_m = [apart_m](int scan, double side) {
      return Eigen::Vector2d(12.0 + 1.4 * kScan_s * scan, side * std::max(0.5 * apart_m, 4.0 - 0.6 * kScan_s * scan));
    };
    constexpr int kScans = 130;
    for (int i = 0; i < kScans; ++i) {
      scene_.begin(now_);
      for (const double side : {1.0, -1.0}) {
        add({place_m(i, side), (place_m(i + 1, side) - place_m(i, side)) / kScan_s, 0.4, 0.4}, 1.0, 2);
      }
      take();
    }
    EXPECT_EQ(flags_at(place_m(kScans - 1, 1.0)), 0U);
    EXPECT_EQ(flags_at(place_m(kScans - 1, -1.0)), 0U);
    scene_.begin(now_);
    scene_.add(place_m(kScans, 1.0) - Eigen::Vector2d(0.0, off_m), {1.4, 0.0});
    take();
    EXPECT_NE(track_at(place_m(kScans, 1.0)).tracking_id, track_at(place_m(kScans, -1.0)).tracking_id);
    return {flags_at(place_m(kScans, 1.0)), flags_at(place_m(kScans, -1.0))};
  }
};

TEST_P(MergedFlag, IsSetIfTheDetectionInTheGateIsAnothers) {
  const Flags flags = last_scan(1.2, 0.6);
  EXPECT_EQ(flags.first + flags.second, track_flag::kMerged) << "one of the two has the detection";
}

TEST_P(MergedFlag, IsNotSetIfThereIsNoDetectionInTheGate) {
  const Flags flags = last_scan(8.0, 0.0);
  EXPECT_EQ(flags.first, 0U);
  EXPECT_EQ(flags.second, 0U) << "missed without a reason that is known";
}

INSTANTIATE_TEST_SUITE_P(Trackers, TrackFlags, testing::ValuesIn(tracker_names()),
                         [](const auto& info) { return info.param; });
INSTANTIATE_TEST_SUITE_P(Trackers, MergedFlag, testing::Values(std::string("pmbm")),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace boresight::tracking
