// Strength of vehicles, false movers and ghosts, on scans whose figures are known.
#include "tests/benchmarks/realism/statistics/strength.hpp"

#include <gtest/gtest.h>

#include "tests/benchmarks/realism/statistics/ghost_strength.hpp"
#include "tests/benchmarks/realism/test/scans.hpp"

namespace boresight::bench::realism {
namespace {

ObservedDetection with_rcs(ObservedDetection detection, double rcs_dbsm) {
  detection.rcs_dbsm = rcs_dbsm;
  return detection;
}

TEST(Strength, LevelsAreByKindAndRange) {
  Strength strength;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 15.0)};
  scan.detections = {with_rcs(of_car(1, 15.0, 0.0), 5.0), with_rcs(false_mover_at(15.0, 0.0, 3.0), -5.0),
                     with_rcs(at(15.0, 0.0), -15.0), with_rcs(at(25.0, 0.0), -25.0)};
  strength.add(scan);
  EXPECT_DOUBLE_EQ(strength.quantile_dbsm(Sort::kVehicle, 10.0, 20.0, 0.5), 5.0);
  EXPECT_DOUBLE_EQ(strength.quantile_dbsm(Sort::kFalseMover, 10.0, 20.0, 0.5), -5.0);
  EXPECT_DOUBLE_EQ(strength.quantile_dbsm(Sort::kStationary, 10.0, 20.0, 0.5), -15.0);
  EXPECT_DOUBLE_EQ(strength.quantile_dbsm(Sort::kStationary, 20.0, 30.0, 0.5), -25.0);
  EXPECT_TRUE(std::isnan(strength.quantile_dbsm(Sort::kVehicle, 20.0, 30.0, 0.5)));
  EXPECT_DOUBLE_EQ(strength.vehicle_is_stronger(10.0, 20.0), 1.0);
}

TEST(Strength, ValidOnesAreComparedByThemselves) {
  Strength strength;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 15.0)};
  scan.detections = {with_rcs(of_car(1, 15.0, 0.0), 5.0), with_rcs(false_mover_at(15.0, 0.0, 3.0), -5.0),
                     with_rcs(false_mover_at(15.0, 0.0, 3.0), 9.0)};
  scan.detections[1].is_valid = false;
  strength.add(scan);
  EXPECT_DOUBLE_EQ(strength.vehicle_is_stronger(10.0, 20.0), 0.5);
  EXPECT_DOUBLE_EQ(strength.valid_vehicle_is_stronger(10.0, 20.0), 0.0);
}

TEST(Strength, ChanceOfAStrongerVehicleCountsTiesByHalf) {
  EXPECT_DOUBLE_EQ(chance_that_first_exceeds({1.0F, 3.0F}, {1.0F, 2.0F}), (0.5 + 2.0) / 4.0);
  EXPECT_DOUBLE_EQ(chance_that_first_exceeds({1.0F}, {2.0F}), 0.0);
  EXPECT_TRUE(std::isnan(chance_that_first_exceeds({}, {2.0F})));
}

TEST(Strength, SpreadsAreWithinAScanWithinABinAndFromScanToScan) {
  Strength strength;
  for (std::uint64_t i = 1; i <= 100; ++i) {
    ObservedScan scan = scan_of(i);
    scan.objects = {car_at(1, 15.0)};
    const double middle = i % 2 == 0 ? 10.0 : 0.0;
    scan.detections = {with_rcs(of_car(1, 15.0, 0.0), middle + 2.0), with_rcs(of_car(1, 15.0, 0.0), middle - 2.0)};
    strength.add(scan);
  }
  strength.end_drive();
  EXPECT_NEAR(strength.std_in_scan_db(), std::sqrt(8.0), 1e-9);
  EXPECT_NEAR(strength.std_scan_to_scan_db(), 10.0 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(strength.std_in_bin_db(1), std::sqrt(25.0 + 4.0), 0.05);
  EXPECT_DOUBLE_EQ(strength.strongest_median_dbsm(10.0, 20.0), 7.0);  // between 2 and 12
  EXPECT_DOUBLE_EQ(strength.percent_strongest_below(RoadUser::kCar, 0.0, 20.0, 5.0), 50.0);
}

TEST(GhostStrength, PairsAreBesideTheObjectAtItsRangeAndRangeRate) {
  GhostStrength ghosts;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 30.0)};
  ObservedDetection car = with_rcs(of_car(1, 30.0, 0.0), 8.0);
  car.range_rate_mps = -10.0;
  const ObservedDetection ghost = with_rcs(false_mover_at(0.0, 31.0, -10.0), -2.0);
  const ObservedDetection near = with_rcs(false_mover_at(30.5, 1.0, -10.0), 20.0);     // 2° beside
  const ObservedDetection farther = with_rcs(false_mover_at(0.0, 35.0, -10.0), 20.0);  // 5 m farther
  const ObservedDetection slower = with_rcs(false_mover_at(0.0, 31.0, -9.0), 20.0);
  scan.detections = {car, ghost, near, farther, slower};
  ghosts.add(scan);
  EXPECT_EQ(ghosts.pairs(), 1u);
  EXPECT_DOUBLE_EQ(ghosts.quantile_db(0.5), -10.0);
  EXPECT_DOUBLE_EQ(ghosts.percent_stronger(), 0.0);
}

TEST(GhostStrength, PairsByChanceAreTakenOff) {
  GhostStrength ghosts;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 30.0)};
  scan.detections = {of_car(1, 30.0, 0.0), with_rcs(false_mover_at(0.0, -30.0, 10.0), 6.0)};
  scan.detections[0].range_rate_mps = 10.0;
  // Weak ones at every range rate are there without the object.
  for (const double rate_mps : {7.0, 10.0, 13.0}) {
    scan.detections.push_back(with_rcs(false_mover_at(0.0, 30.0, rate_mps), -20.0));
  }
  ghosts.add(scan);
  EXPECT_EQ(ghosts.pairs(), 2u);
  EXPECT_DOUBLE_EQ(ghosts.quantile_db(0.1), 6.0);
  EXPECT_DOUBLE_EQ(ghosts.percent_stronger(), 100.0);
}

TEST(GhostStrength, MirrorImagesByTheTruthNeedNoPair) {
  GhostStrength ghosts;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 30.0)};
  scan.detections = {with_rcs(of_car(1, 30.0, 0.0), 8.0), with_rcs(false_mover_at(0.0, 60.0, 2.0), -4.0)};
  scan.detections[1].provenance = Provenance::kGhostType2;
  scan.detections[1].object = 1;
  ghosts.add(scan);
  EXPECT_DOUBLE_EQ(ghosts.mirror_image_quantile_db(0.5), -12.0);
}

}  // namespace
}  // namespace boresight::bench::realism
