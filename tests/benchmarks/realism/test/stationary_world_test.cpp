// The stationary world, on scans whose figures are known.
#include "tests/benchmarks/realism/statistics/stationary_world.hpp"

#include <gtest/gtest.h>

#include "tests/benchmarks/realism/test/scans.hpp"

namespace boresight::bench::realism {
namespace {

constexpr std::uint64_t kSearched = 4;  // neighbours are searched in every fourth scan

TEST(StationaryWorld, NumbersAndSharesByRangeAreOfStationaryDetectionsOnly) {
  StationaryWorld world;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 15.0)};
  scan.detections = {at(5.0, 0.0),  at(15.0, 0.0),        at(0.0, 15.0),
                     at(95.0, 0.0), of_car(1, 15.0, 0.0), false_mover_at(5.0, 0.0, -4.0)};
  world.add(scan);
  EXPECT_DOUBLE_EQ(world.per_scan(Facing::kForward).mean(), 4.0);
  EXPECT_DOUBLE_EQ(world.all_per_scan().mean(), 6.0);
  EXPECT_DOUBLE_EQ(world.percent_of_rings(0, 0), 25.0);
  EXPECT_DOUBLE_EQ(world.percent_of_rings(0, 1), 75.0);
  EXPECT_DOUBLE_EQ(world.percent_of_rings(9, 9), 25.0);
}

TEST(StationaryWorld, NearestNeighbourAndGroupsAreFound) {
  StationaryWorld world;
  ObservedScan scan = scan_of(kSearched);
  scan.detections = {at(10.0, 0.0), at(10.0, 0.4), at(10.0, 0.8), at(50.0, 0.0)};
  world.add(scan);
  EXPECT_DOUBLE_EQ(world.percent_with_two_near(), 75.0);
  EXPECT_NEAR(world.nearest_m().quantile(0.0), 0.4, 1e-6);
  EXPECT_NEAR(world.nearest_m().quantile(1.0), std::hypot(40.0, 0.0), 0.01);
}

TEST(StationaryWorld, SeenAgainIsWithinHalfAMetreInTheNextScan) {
  StationaryWorld world;
  ObservedScan first = scan_of(kSearched - 1), second = scan_of(kSearched);
  first.detections = {at(20.0, 0.0), at(20.0, 5.0), at(60.0, 0.0), at(60.0, 5.0)};
  second.detections = {at(20.0, 0.4), at(60.0, 0.6)};
  world.add(first);
  world.add(second);
  EXPECT_DOUBLE_EQ(world.seen_again(), 0.25);
  EXPECT_DOUBLE_EQ(world.seen_again_by_chance(), 0.0);
}

TEST(StationaryWorld, ChanceIsFoundByTurningTheScan) {
  StationaryWorld world;
  ObservedScan first = scan_of(kSearched - 1), second = scan_of(kSearched);
  first.detections = {at(10.0, 0.0)};
  for (int degree = -10; degree <= 10; ++degree) {
    const double angle = degree * M_PI / 180.0;
    second.detections.push_back(at(10.0 * std::cos(angle), 10.0 * std::sin(angle)));
  }
  world.add(first);
  world.add(second);
  EXPECT_DOUBLE_EQ(world.seen_again_by_chance(), 1.0);
}

TEST(StationaryWorld, TailsOfTheRangeRateAreOfAllStrengths) {
  StationaryWorld world;
  ObservedScan scan = scan_of(1);
  for (int i = 0; i < 100; ++i) {
    ObservedDetection d = at(20.0, 0.0);
    d.rcs_dbsm = i % 2 == 0 ? -15.0 : 15.0;
    d.deviation_mps = i < 5 ? 0.5 : i < 10 ? -0.5 : 0.0;
    scan.detections.push_back(d);
  }
  world.add(scan);
  EXPECT_NEAR(world.rate_kurtosis(), 10.0, 1e-6);  // 1 / the share of the deviating ones
  EXPECT_NEAR(world.rate_p95_mps(), 0.5, 1e-6);
}

TEST(StationaryWorld, NothingIsSeenAgainInAnotherDrive) {
  StationaryWorld world;
  ObservedScan first = scan_of(kSearched - 1), second = scan_of(kSearched);
  first.detections = second.detections = {at(20.0, 0.0)};
  world.add(first);
  world.end_drive();
  world.add(second);
  EXPECT_TRUE(std::isnan(world.seen_again()));
}

}  // namespace
}  // namespace boresight::bench::realism
