// False movers, on scans whose figures are known.
#include "tests/benchmarks/realism/statistics/false_movers.hpp"

#include <gtest/gtest.h>

#include "tests/benchmarks/realism/test/scans.hpp"

namespace boresight::bench::realism {
namespace {

using simulator::Cause;

TEST(FalseMovers, DetectionsOfMoversAndSlowOnesAreNone) {
  FalseMovers movers;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 20.0)};
  scan.detections = {of_car(1, 20.0, 0.0), at(10.0, 0.0), false_mover_at(30.0, 0.0, 0.7),
                     false_mover_at(30.0, 0.0, 3.0), false_mover_at(70.0, 0.0, -15.0)};
  movers.add(scan);
  EXPECT_DOUBLE_EQ(movers.per_scan(), 2.0);
  EXPECT_DOUBLE_EQ(movers.per_scan_beyond(0), 3.0);
  EXPECT_DOUBLE_EQ(movers.per_scan_beyond(2), 1.0);
  EXPECT_DOUBLE_EQ(movers.percent_of_unlabelled(), 50.0);
  EXPECT_DOUBLE_EQ(movers.percent_of_deviation(1), 50.0);
  EXPECT_DOUBLE_EQ(movers.percent_of_deviation(3), 50.0);
  EXPECT_DOUBLE_EQ(movers.range_m().quantile(1.0), 70.0);
  EXPECT_DOUBLE_EQ(movers.near_per_scan(), 1.0);
}

TEST(FalseMovers, DensityIsPerAreaOfTheViewAndRangeRate) {
  FalseMovers movers;
  ObservedScan scan = scan_of(1);  // 2 rad
  scan.detections = {false_mover_at(5.0, 0.0, 3.0)};
  movers.add(scan);
  EXPECT_NEAR(movers.density_per_m2_mps(0), 1.0 / (100.0 * 60.0), 1e-12);
  EXPECT_DOUBLE_EQ(movers.density_per_m2_mps(1), 0.0);
}

TEST(FalseMovers, ChainGoesOnWhereTheRangeRateLeads) {
  FalseMovers movers;
  for (std::uint64_t i = 1; i <= 8; ++i) {
    ObservedScan scan = scan_of(i);
    scan.detections = {false_mover_at(30.0 + 10.0 * scan.t_s, 0.0, 10.0)};
    // Another one that jumps: never seen again.
    scan.detections.push_back(false_mover_at(20.0, i % 2 == 0 ? 20.0 : -20.0, -10.0));
    movers.add(scan);
  }
  movers.end_drive();
  EXPECT_DOUBLE_EQ(movers.seen_again(), 0.5);
  EXPECT_DOUBLE_EQ(movers.seen_again_by_chance(), 0.0);
  EXPECT_DOUBLE_EQ(movers.percent_in_chains_of(6), 50.0);
  EXPECT_NEAR(movers.percent_of_chains_single(), 100.0 * 8.0 / 9.0, 1e-9);
}

TEST(FalseMovers, CountsThatChangeSlowlyCorrelate) {
  FalseMovers movers;
  const auto add_drive = [&movers](std::uint64_t half_period_scans) {
    for (std::uint64_t i = 1; i <= 1000; ++i) {
      ObservedScan scan = scan_of(i);
      const int count = (i / half_period_scans) % 2 == 0 ? 2 : 6;
      for (int k = 0; k < count; ++k) scan.detections.push_back(false_mover_at(20.0 + 5.0 * k, 0.0, 5.0 + 3.0 * k));
      movers.add(scan);
    }
    movers.end_drive();
  };
  add_drive(100);
  EXPECT_GT(movers.correlation(0), 0.97);
  EXPECT_NEAR(movers.correlation(1), 1.0 - 2.0 * 12.5 / 100.0, 0.03);  // after 1 s, 12.5 scans
  EXPECT_LT(movers.variance_over_mean(), 0.1);
}

TEST(FalseMovers, DopplerAmbiguityIsOnTheOtherSideOfZero) {
  FalseMovers movers;
  ObservedScan scan = scan_of(1);
  // Stationary ones ahead have −15 m/s.
  ObservedDetection ambiguous = false_mover_at(20.0, 0.0, 25.0), other = ambiguous, standing = at(30.0, 0.0);
  ambiguous.range_rate_mps = 10.0;
  ambiguous.cause = Cause::kDopplerAmbiguity;
  other.deviation_mps = -25.0;  // the same side
  other.range_rate_mps = -40.0;
  standing.range_rate_mps = -15.0;
  scan.detections = {ambiguous, other, standing};
  movers.add(scan);
  EXPECT_DOUBLE_EQ(movers.percent_doppler_measured(), 50.0);
  EXPECT_DOUBLE_EQ(movers.percent_doppler_by_truth(), 50.0);
  EXPECT_DOUBLE_EQ(movers.percent_doppler_of_stationary(), 50.0);
  EXPECT_DOUBLE_EQ(movers.percent_doppler_of_stationary_by_truth(), 50.0);
}

TEST(FalseMovers, AmbiguousMoverIsAtItsPlaceWithAWrongRangeRate) {
  FalseMovers movers;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 20.0)};
  scan.detections = {of_car(1, 20.0, 0.0), of_car(1, 20.0, 0.0)};
  scan.detections[0].rigid_deviation_mps = -25.0;
  movers.add(scan);
  EXPECT_DOUBLE_EQ(movers.percent_doppler_of_movers(), 50.0);
}

TEST(FalseMovers, AzimuthAmbiguityRepeatsAStationaryDetectionAtItsStep) {
  FalseMovers movers;
  ObservedScan scan = scan_of(1);
  ObservedDetection parent = at(20.0, 0.0);
  parent.range_rate_mps = -15.0;
  const double azimuth = std::asin(0.72);
  ObservedDetection copy = false_mover_at(20.0 * std::cos(azimuth), 20.0 * std::sin(azimuth), -4.0);
  copy.range_rate_mps = -15.0;
  copy.cause = Cause::kAzimuthAmbiguity;
  scan.detections = {parent, copy, false_mover_at(20.0, 1.0, 6.0)};
  movers.add(scan);
  EXPECT_DOUBLE_EQ(movers.percent_azimuth_measured(), 50.0);
  EXPECT_DOUBLE_EQ(movers.percent_azimuth_by_truth(), 50.0);
  EXPECT_DOUBLE_EQ(movers.azimuth_by_truth_per_scan(), 1.0);
}

TEST(FalseMovers, SensorsFlagsAreCountedApartForRealAndFalse) {
  FalseMovers movers;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 20.0)};
  scan.detections = {of_car(1, 20.5, 0.0), false_mover_at(40.0, 0.0, 4.0), false_mover_at(45.0, 0.0, 4.0)};
  scan.detections[0].is_in_box = true;
  scan.detections[0].existence = 0.9;
  scan.detections[1].existence = scan.detections[2].existence = 0.3;
  scan.detections[1].is_valid = false;
  movers.add(scan);
  EXPECT_DOUBLE_EQ(movers.percent_valid(true), 100.0);
  EXPECT_DOUBLE_EQ(movers.percent_valid(false), 50.0);
  EXPECT_DOUBLE_EQ(movers.near_valid_per_scan(), 1.0);
  EXPECT_DOUBLE_EQ(movers.existence_separates(), 1.0);
}

TEST(FalseMovers, DrivesAddUp) {
  FalseMovers movers, other;
  ObservedScan scan = scan_of(1);
  movers.add(scan);
  scan.detections = {false_mover_at(30.0, 0.0, 3.0), false_mover_at(30.0, 0.0, 3.0)};
  other.add(scan);
  movers.merge(other);
  EXPECT_DOUBLE_EQ(movers.per_scan(), 1.0);
}

}  // namespace
}  // namespace boresight::bench::realism
