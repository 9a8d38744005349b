// Detections per object and misses, on scans whose figures are known.
#include "tests/benchmarks/realism/statistics/object_counts.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/benchmarks/realism/test/scans.hpp"

namespace boresight::bench::realism {
namespace {

/// One car at 15 m with this number of detections in each scan.
void add_series(ObjectCounts& counts, const std::vector<unsigned>& per_scan, bool in_sight = true) {
  for (std::size_t i = 0; i < per_scan.size(); ++i) {
    ObservedScan scan = scan_of(i + 1);
    scan.objects.push_back(car_at(1, 15.0));
    scan.objects.back().in_sight = in_sight;
    for (unsigned d = 0; d < per_scan[i]; ++d) scan.detections.push_back(of_car(1, 15.0, 0.0));
    counts.add(scan);
  }
  counts.end_drive();
}

TEST(ObjectCounts, MeanAndShareOfNoneAreOfObjectsInSight) {
  ObjectCounts counts;
  add_series(counts, {3, 0, 0, 1});
  const CountSelection near{RoadUser::kCar, 10.0, 20.0};
  EXPECT_DOUBLE_EQ(counts.mean(Counting::kInSight, near), 1.0);
  EXPECT_DOUBLE_EQ(counts.percent_none(Counting::kInSight, near), 50.0);
  EXPECT_DOUBLE_EQ(counts.most(near), 3.0);
  EXPECT_TRUE(std::isnan(counts.mean(Counting::kInSight, {RoadUser::kCar, 20.0, 30.0})));
  EXPECT_TRUE(std::isnan(counts.mean(Counting::kInSight, {RoadUser::kTruck})));
}

TEST(ObjectCounts, ScansBeforeFirstAndAfterLastDetectionDoNotCountInRadarScenesWay) {
  ObjectCounts counts;
  // First detection in scan 3, last in scan 17; 0.3 s are 3.75 scans: the scans 7 … 13 count.
  std::vector<unsigned> series(20, 0);
  series[2] = 9;
  series[16] = 9;
  series[8] = 2;
  add_series(counts, series);
  EXPECT_NEAR(counts.mean(Counting::kFirstToLast, {}), 2.0 / 7.0, 1e-9);
  EXPECT_NEAR(counts.mean(Counting::kInSight, {}), 20.0 / 20.0, 1e-9);
}

TEST(ObjectCounts, HiddenObjectIsMissedInRadarScenesWayAndDoesNotCountInSight) {
  ObjectCounts counts;
  std::vector<unsigned> series(20, 0);
  series.front() = series.back() = 1;
  add_series(counts, series, false);
  EXPECT_DOUBLE_EQ(counts.percent_none(Counting::kFirstToLast, {}), 100.0);
  EXPECT_TRUE(std::isnan(counts.percent_none(Counting::kInSight, {})));
}

TEST(ObjectCounts, MissesAfterMissesAndGapsAreCounted) {
  ObjectCounts counts;
  add_series(counts, {0, 1, 0, 0, 0, 1, 0, 1, 0});
  // After a scan with none: one, none, none, one, one.
  EXPECT_DOUBLE_EQ(counts.none_after_none(Counting::kInSight, RoadUser::kCar), 2.0 / 5.0);
  // Gaps between two detections only.
  EXPECT_EQ(counts.gaps(Counting::kInSight, RoadUser::kCar).values(), (std::vector<float>{3.0F, 1.0F}));
}

TEST(ObjectCounts, AlternatingCountsCorrelateNegativelyAtOneScanAndPositivelyAtTwo) {
  ObjectCounts counts;
  std::vector<unsigned> series;
  for (int i = 0; i < 200; ++i) series.push_back(i % 2 == 0 ? 1 : 3);
  add_series(counts, series);
  EXPECT_NEAR(counts.correlation(Counting::kInSight, RoadUser::kCar, 1), -1.0, 1e-6);
  EXPECT_NEAR(counts.correlation(Counting::kInSight, RoadUser::kCar, 2), 1.0, 1e-6);
  EXPECT_NEAR(counts.variance_over_mean_in_track(Counting::kInSight, RoadUser::kCar), 0.5, 0.01);
}

TEST(ObjectCounts, DrivesAddUp) {
  ObjectCounts counts, other;
  add_series(counts, {1, 1});
  add_series(other, {4, 2});
  counts.merge(other);
  EXPECT_DOUBLE_EQ(counts.mean(Counting::kInSight, {}), 2.0);
}

}  // namespace
}  // namespace boresight::bench::realism
