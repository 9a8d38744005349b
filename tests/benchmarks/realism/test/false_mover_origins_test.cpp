// What a false mover is by the measured definitions, on scans made by hand.
#include "tests/benchmarks/realism/statistics/false_mover_origins.hpp"

#include <gtest/gtest.h>

#include "tests/benchmarks/realism/test/scans.hpp"

namespace boresight::bench::realism {
namespace {

/// A car at 30 m straight ahead that recedes at 5 m/s, without detections.
ObservedScan scan_with_car() {
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 30.0)};
  scan.objects[0].velocity_mps = {5.0, 0.0};
  return scan;
}

ObservedDetection polar(double range_m, double azimuth_deg, double rate_mps) {
  const double azimuth = azimuth_deg * M_PI / 180.0;
  return false_mover_at(range_m * std::cos(azimuth), range_m * std::sin(azimuth), rate_mps);
}

FalseMoverOrigins origins_of(ObservedScan scan, const ObservedDetection& mover) {
  scan.detections.push_back(mover);
  FalseMoverOrigins origins;
  origins.add(scan);
  return origins;
}

TEST(FalseMoverOrigins, BesideAnObjectThatWasNotDetected) {
  const ObservedScan scan = scan_with_car();
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(31.0, 20.0, 5.3)).percent_beside_tracked_object(), 100.0);
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(31.0, 3.0, 5.3)).percent_beside_tracked_object(), 0.0) << "not beside";
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(34.0, 20.0, 5.3)).percent_beside_tracked_object(), 0.0) << "farther";
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(31.0, 20.0, 6.0)).percent_beside_tracked_object(), 0.0) << "faster";
}

TEST(FalseMoverOrigins, RangeRateOfAnObjectIsRelativeToTheSensor) {
  ObservedScan scan = scan_with_car();
  scan.sensor_velocity_mps = {15.0, 0.0};
  ObservedDetection mover = polar(31.0, 20.0, 5.0);
  mover.range_rate_mps = -10.0;
  EXPECT_DOUBLE_EQ(origins_of(scan, mover).percent_beside_tracked_object(), 100.0);
}

TEST(FalseMoverOrigins, StandingVehicleIsNoTrackedObject) {
  ObservedScan scan = scan_with_car();
  scan.objects[0].user = RoadUser::kStandingCar;
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(31.0, 20.0, 5.0)).percent_beside_tracked_object(), 0.0);
}

TEST(FalseMoverOrigins, BehindAnObjectAndBesideThatDirection) {
  const ObservedScan scan = scan_with_car();  // its far end is at 34 m
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(40.0, 2.0, 5.0)).percent_behind_object(), 100.0);
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(33.0, 2.0, 5.0)).percent_behind_object(), 0.0);
  const FalseMoverOrigins beside = origins_of(scan, polar(40.0, -11.0, 5.0));
  EXPECT_DOUBLE_EQ(beside.percent_behind_object(), 0.0);
  EXPECT_DOUBLE_EQ(beside.percent_beside_behind_object(), 50.0) << "one of two sides";
}

TEST(FalseMoverOrigins, TwiceTheRangeHasTwiceTheRangeRate) {
  const ObservedScan scan = scan_with_car();
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(60.0, 0.0, 10.0)).percent_at_twice_the_range(), 100.0);
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(60.0, 0.0, 5.0)).percent_at_twice_the_range(), 0.0);
}

TEST(FalseMoverOrigins, UnlabelledRestLiesAtALabelledDetection) {
  ObservedScan scan = scan_with_car();
  scan.detections = {of_car(1, 30.0, 0.0)};
  scan.detections[0].range_rate_mps = 5.0;
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(31.0, 1.0, 5.8)).percent_rest_of_object(), 100.0);
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(31.0, 1.0, 6.5)).percent_rest_of_object(), 0.0);
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(32.0, 1.0, 5.8)).percent_rest_of_object(), 0.0);
}

TEST(FalseMoverOrigins, SingleOneHasNoOriginAndAnAmbiguousOneHas) {
  const ObservedScan scan = scan_with_car();
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(80.0, 20.0, -3.0)).percent_of_no_origin(), 100.0);
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(31.0, 20.0, 5.0)).percent_of_no_origin(), 0.0);
  ObservedDetection ambiguous = polar(80.0, 20.0, 25.0);
  ambiguous.range_rate_mps = 10.0;
  EXPECT_DOUBLE_EQ(origins_of(scan, ambiguous).percent_of_no_origin(), 0.0);
}

TEST(FalseMoverOrigins, SineStepIsTheMostFrequentDistance) {
  FalseMoverOrigins origins, other;
  ObservedScan scan = scan_of(1);
  scan.detections = {at(20.0, 0.0), polar(20.0, std::asin(0.74) * 180.0 / M_PI, 4.0)};
  scan.detections[0].range_rate_mps = 4.0;
  EXPECT_TRUE(std::isnan(origins.sine_step()));
  origins.add(scan);
  other.add(scan);
  scan.detections[1] = polar(20.0, std::asin(0.5) * 180.0 / M_PI, 4.0);
  other.add(scan);
  origins.merge(other);
  EXPECT_NEAR(origins.sine_step(), 0.74, 0.021);
}

TEST(FalseMoverOrigins, MirrorImagesAreThoseOfTheTruth) {
  ObservedScan scan = scan_with_car();
  scan.detections = {polar(50.0, 20.0, 4.0)};
  scan.detections[0].provenance = Provenance::kGhostType2;
  EXPECT_DOUBLE_EQ(origins_of(scan, polar(60.0, 20.0, 9.0)).percent_mirror_images(), 50.0);
}

}  // namespace
}  // namespace boresight::bench::realism
