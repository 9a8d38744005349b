// The effects of a real car also concern the dense stationary field of a radar profile.
#include <gtest/gtest.h>

#include "services/simulator/scenario/read_profile.hpp"
#include "tests/unit/simulator/car/observed_drive.hpp"

namespace boresight::simulator {
namespace {

struct FieldCount {
  int points = 0, images = 0;
};

/// Stationary detections on a road without any reflector of a scenario: points of the field of series_77ghz.
FieldCount count_field(double road_mirror_share) {
  Scenario s = clean_scenario({}, 2.0);
  s.scatter.clear();
  use_profile(s, "series_77ghz");
  s.effects.real_car.road_mirror_share = road_mirror_share;
  const AlignmentDrive statistical(clean_spec({}, 2.0));
  Drive drive(s, statistical.vehicle(), kSeed, 2.0);
  FieldCount count;
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) continue;
    for (const DetectionTruth& truth : *event->truth) {
      if (truth.provenance != Provenance::kStationary) continue;
      if (truth.cause == Cause::kNone || truth.cause == Cause::kRoadMirror) ++count.points;
      if (truth.cause == Cause::kRoadMirror) ++count.images;
    }
  }
  return count;
}

// Two thirds of the points are low: their heights are uniform from 0 to 1.5 m, and reflectors below 1 m are mirrored.
TEST(RealCarField, RoadMirrorsPointsOfTheStationaryField) {
  const FieldCount plain = count_field(0.0), tenth = count_field(0.1), all = count_field(1.0);
  ASSERT_GT(plain.points, 5000);
  EXPECT_EQ(plain.images, 0);
  EXPECT_EQ(all.points, plain.points);
  const auto share = [](const FieldCount& c) { return static_cast<double>(c.images) / static_cast<double>(c.points); };
  EXPECT_GT(share(all), 0.4);
  EXPECT_LT(share(all), 0.7);
  EXPECT_NEAR(share(tenth), 0.1 * share(all), 0.01);
}

}  // namespace
}  // namespace boresight::simulator
