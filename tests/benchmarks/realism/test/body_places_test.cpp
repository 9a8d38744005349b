// Places on the body and deviating range rates, on scans whose figures are known.
#include "tests/benchmarks/realism/statistics/body_places.hpp"

#include <gtest/gtest.h>

#include "tests/benchmarks/realism/statistics/rigid_deviations.hpp"
#include "tests/benchmarks/realism/test/scans.hpp"

namespace boresight::bench::realism {
namespace {

constexpr double kTiny = 1e-5;

TEST(BodyPlaces, DepthIsPositiveInsideTheBoxAndNegativeOutside) {
  const ObservedObject car = car_at(1, 20.0);  // x 20 … 24, y −1 … 1
  EXPECT_NEAR(car.depth_m({20.5, 0.0}), 0.5, kTiny);
  EXPECT_NEAR(car.depth_m({22.0, 0.7}), 0.3, kTiny);
  EXPECT_NEAR(car.depth_m({19.6, 0.0}), -0.4, kTiny);
  EXPECT_NEAR(car.depth_m({17.0, 5.0}), -5.0, kTiny);
  ObservedObject turned = car;
  turned.heading_rad = M_PI / 2.0;  // x 21 … 23, y −2 … 2
  EXPECT_NEAR(turned.depth_m({21.2, 0.0}), 0.2, kTiny);
}

TEST(BodyPlaces, ScanShowsLengthWidthAndDistanceBehindTheNearest) {
  BodyPlaces places;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 20.0)};
  scan.detections = {of_car(1, 20.0, 0.0), of_car(1, 21.0, 0.0), of_car(1, 23.0, 0.0), at(20.0, 0.5)};
  scan.detections[1].position_m.y() = 0.6;
  places.add(scan);
  places.end_drive();
  const BodyPlaces::Figures& car = places.of(RoadUser::kCar);
  ASSERT_EQ(car.shown_length_m.size(), 1u);
  EXPECT_NEAR(car.shown_length_m.mean(), 3.0, kTiny);
  EXPECT_NEAR(car.shown_width_m.mean(), 0.6, kTiny);
  EXPECT_EQ(car.behind_nearest_m.values(), (std::vector<float>{1.0F, 3.0F}));
  EXPECT_EQ(car.depth_m.size(), 3u);
  EXPECT_NEAR(car.across_m.variance(), 0.12, kTiny);  // of 0, 0.6, 0
  EXPECT_NEAR(car.across_from_mean_m.quantile(1.0), 0.4, kTiny);
}

TEST(BodyPlaces, TwoDetectionsShowNoLength) {
  BodyPlaces places;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 20.0)};
  scan.detections = {of_car(1, 20.0, 0.0), of_car(1, 24.0, 0.0)};
  places.add(scan);
  EXPECT_EQ(places.of(RoadUser::kCar).shown_length_m.size(), 0u);
  EXPECT_EQ(places.of(RoadUser::kCar).behind_nearest_m.size(), 1u);
}

TEST(RigidDeviations, ShareBeyondALimitIsByAspect) {
  RigidDeviations deviations;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 20.0), car_at(2, 40.0)};
  scan.objects[1].aspect_rad = M_PI / 2.0;
  for (int i = 0; i < 10; ++i) scan.detections.push_back(of_car(1, 20.0, 0.0));
  scan.detections[0].rigid_deviation_mps = -0.8;
  scan.detections.push_back(of_car(2, 40.0, 0.0));
  scan.detections.back().rigid_deviation_mps = 1.2;
  deviations.add(scan);
  EXPECT_NEAR(deviations.percent_beyond({RoadUser::kCar, 0.0, kEndSector_rad}, 0.5), 10.0, kTiny);
  EXPECT_NEAR(deviations.percent_beyond({RoadUser::kCar, 0.0, kEndSector_rad}, 1.0), 0.0, kTiny);
  EXPECT_NEAR(deviations.percent_beyond({RoadUser::kCar, kSideFrom_rad, kSideTo_rad}, 1.0), 100.0, kTiny);
  // 1.2 m/s faster than a body that recedes at 5 m/s.
  EXPECT_NEAR(deviations.ratio({}, 0.5), 0.24, kTiny);
}

TEST(RigidDeviations, DopplerAmbiguityIsNoDeviation) {
  RigidDeviations deviations;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 20.0)};
  scan.detections = {of_car(1, 20.0, 0.0), of_car(1, 20.0, 0.0)};
  scan.detections[0].rigid_deviation_mps = 25.0;
  deviations.add(scan);
  EXPECT_NEAR(deviations.percent_beyond({}, 2.0), 0.0, kTiny);
}

TEST(RigidDeviations, RestIsRobustAgainstTheDeviatingOnes) {
  RigidDeviations deviations;
  ObservedScan scan = scan_of(1);
  scan.objects = {car_at(1, 20.0)};
  for (const double deviation : {-0.2, -0.1, 0.0, 0.1, 0.2, 0.9, 4.0}) {
    scan.detections.push_back(of_car(1, 20.0, 0.0));
    scan.detections.back().rigid_deviation_mps = deviation;
  }
  deviations.add(scan);
  EXPECT_NEAR(deviations.rest_std_mps({}), 0.14826, kTiny);
}

}  // namespace
}  // namespace boresight::bench::realism
