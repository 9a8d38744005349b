// First and last detections of vehicles, on drives whose figures are known.
#include "tests/benchmarks/realism/statistics/births.hpp"

#include <gtest/gtest.h>

#include "tests/benchmarks/realism/test/scans.hpp"

namespace boresight::bench::realism {
namespace {

constexpr std::uint64_t kScans = 150;  // 12 s

/// A car with one detection in each of the scans from `first` to `last`, from `from_m` to `to_m` along x.
void add_drive(Births& births, std::uint64_t first, std::uint64_t last, double from_m, double to_m, double y_m = 0.0) {
  for (std::uint64_t i = 1; i <= kScans; ++i) {
    ObservedScan scan = scan_of(i);
    if (i >= first && i <= last) {
      const double share = static_cast<double>(i - first) / static_cast<double>(last - first);
      const double x_m = from_m + share * (to_m - from_m);
      scan.objects = {car_at(1, x_m)};
      scan.detections = {of_car(1, x_m, y_m)};
    }
    births.add(scan);
  }
  births.end_drive();
}

TEST(Births, FirstDetectionAtTheLargestRangeAndLastOneAtTheEdgeOfTheView) {
  Births births;
  add_drive(births, 20, 100, 97.0, 3.0, 4.2);  // the last one at 54°, of ±57° in view
  EXPECT_NEAR(births.first_range_m(RoadUser::kCar).quantile(0.5), std::hypot(97.0, 4.2), 1e-5);
  EXPECT_DOUBLE_EQ(births.percent_first_at_largest_range(), 100.0);
  EXPECT_DOUBLE_EQ(births.percent_last_at_largest_range(), 0.0);
  EXPECT_DOUBLE_EQ(births.percent_last_at_edge(), 100.0);
  EXPECT_DOUBLE_EQ(births.percent_elsewhere(), 0.0);
}

TEST(Births, FirstAndLastDetectionWithinTheViewAreElsewhere) {
  Births births;
  add_drive(births, 20, 100, 40.0, 60.0);
  EXPECT_DOUBLE_EQ(births.percent_first_at_largest_range(), 0.0);
  EXPECT_DOUBLE_EQ(births.percent_elsewhere(), 100.0);
}

TEST(Births, EndsOfTheDriveAreNoBirthAndNoDeath) {
  Births births;
  add_drive(births, 1, kScans, 40.0, 60.0);
  EXPECT_EQ(births.first_range_m(RoadUser::kCar).size(), 0u);
  EXPECT_TRUE(std::isnan(births.percent_elsewhere()));
}

TEST(Births, ObjectOfFewerThanThirtyDetectionsDoesNotCount) {
  Births births;
  add_drive(births, 20, 48, 40.0, 60.0);  // 29
  EXPECT_EQ(births.first_range_m(RoadUser::kCar).size(), 0u);
  add_drive(births, 20, 49, 40.0, 60.0);  // 30
  EXPECT_EQ(births.first_range_m(RoadUser::kCar).size(), 1u);
}

TEST(Births, DrivesAddUp) {
  Births births, other;
  add_drive(births, 20, 100, 40.0, 60.0);
  add_drive(other, 20, 100, 97.0, 60.0);
  births.merge(other);
  EXPECT_DOUBLE_EQ(births.percent_first_at_largest_range(), 50.0);
  EXPECT_EQ(births.first_range_m(RoadUser::kCar).size(), 2u);
}

}  // namespace
}  // namespace boresight::bench::realism
