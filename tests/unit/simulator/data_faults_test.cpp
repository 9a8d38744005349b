#include "services/simulator/wire/data_faults.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

namespace boresight::simulator::wire {
namespace {

constexpr double kBegin_s = 2.0, kDuration_s = 1.0;

class DataFaultsTest : public testing::Test {
 protected:
  DataFaultsTest() {
    radar_.id = 3;
    radar_.field_of_view.azimuth_min_rad = -1.0;
    radar_.field_of_view.azimuth_max_rad = 1.0;
    radar_.field_of_view.range_max_m = 100.0;
    scan_->number_of_valid_detections = 20;
    scan_->range_rate_min_mps = -30.0F;
    scan_->range_rate_max_mps = 30.0F;
    for (std::uint32_t i = 0; i < 20; ++i) {
      scan_->range_m[i] = static_cast<float>((i * 7U) % 20U);
      scan_->azimuth_rad[i] = 0.01F * static_cast<float>(i + 1);
      scan_->rcs_dbsm[i] = static_cast<float>(i);
    }
  }
  static RadarDataFault fault(DataFaultKind kind) {
    RadarDataFault f;
    f.kind = kind;
    f.begin_s = kBegin_s;
    f.duration_s = kDuration_s;
    return f;
  }
  RadarConfig radar_;
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
};

TEST_F(DataFaultsTest, ActFromBeginToEndOnTheirRadarOnly) {
  RadarDataFault empty = fault(DataFaultKind::kFew);
  empty.radar = radar_.id;
  DataFaults faults({empty}, 1);
  const auto detections = [&](double t_s) {
    return faults.apply(*scan_, radar_, t_s).scan->number_of_valid_detections;
  };
  EXPECT_EQ(detections(kBegin_s - 0.01), 20u);
  EXPECT_EQ(detections(kBegin_s), 0u);
  EXPECT_EQ(detections(kBegin_s + kDuration_s - 0.01), 0u);
  EXPECT_EQ(detections(kBegin_s + kDuration_s), 20u);
  radar_.id = 4;
  EXPECT_EQ(detections(kBegin_s), 20u);
}

TEST_F(DataFaultsTest, NearKeepsWholeDetectionsWithinReach) {
  RadarDataFault near = fault(DataFaultKind::kNear);
  near.reach_m = 6.5;
  DataFaults faults({near}, 1);
  const RadarScan& list = *faults.apply(*scan_, radar_, kBegin_s).scan;
  ASSERT_EQ(list.number_of_valid_detections, 7u);
  for (std::uint32_t i = 0; i < 7; ++i) {
    EXPECT_LE(list.range_m[i], 6.5F);
    const auto was = static_cast<std::uint32_t>(list.rcs_dbsm[i]);
    EXPECT_EQ(list.range_m[i], scan_->range_m[was]);
    EXPECT_EQ(list.azimuth_rad[i], scan_->azimuth_rad[was]);
  }
}

TEST_F(DataFaultsTest, FrozenRepeatsTheFirstListWithNewCounters) {
  DataFaults faults({fault(DataFaultKind::kFrozen)}, 1);
  static_cast<void>(faults.apply(*scan_, radar_, kBegin_s));
  scan_->range_m[0] = 77.0F;
  scan_->cycle_counter = 9;
  scan_->number_of_valid_detections = 5;
  const RadarScan& list = *faults.apply(*scan_, radar_, kBegin_s + 0.1).scan;
  EXPECT_EQ(list.range_m[0], 0.0F);
  EXPECT_EQ(list.number_of_valid_detections, 20u);
  EXPECT_EQ(list.cycle_counter, 9u);
}

TEST_F(DataFaultsTest, LostListsHaveTheConfiguredShareAndRepeatedComeTwice) {
  DataFaults lost({fault(DataFaultKind::kLost)}, 1), repeated({fault(DataFaultKind::kRepeated)}, 1);
  int sent = 0;
  for (scan_->cycle_counter = 0; scan_->cycle_counter < 1000; ++scan_->cycle_counter) {
    sent += static_cast<int>(lost.apply(*scan_, radar_, kBegin_s).times);
  }
  EXPECT_NEAR(sent, 200, 50);  // four standard deviations
  EXPECT_EQ(repeated.apply(*scan_, radar_, kBegin_s).times, 2u);
}

TEST_F(DataFaultsTest, MirroredTurnsTheSignOfAzimuthsAndRandomStaysWithinLimits) {
  const std::unique_ptr<RadarScan> before = std::make_unique<RadarScan>(*scan_);
  DataFaults mirrored({fault(DataFaultKind::kMirroredAzimuth)}, 1), random({fault(DataFaultKind::kRandom)}, 1);
  EXPECT_EQ(mirrored.apply(*scan_, radar_, kBegin_s).scan->azimuth_rad[4], -before->azimuth_rad[4]);
  EXPECT_EQ(scan_->azimuth_rad[4], before->azimuth_rad[4]) << "the radar's own scan is not changed";
  const RadarScan& list = *random.apply(*scan_, radar_, kBegin_s).scan;
  int equal = 0;
  for (std::size_t i = 0; i < 20; ++i) {
    equal += list.azimuth_rad[i] == before->azimuth_rad[i] ? 1 : 0;
    EXPECT_LE(std::abs(list.azimuth_rad[i]), 1.0F);
    EXPECT_LE(list.range_m[i], 100.0F);
    EXPECT_LE(std::abs(list.range_rate_mps[i]), 30.0F);
  }
  EXPECT_EQ(equal, 0);
}

}  // namespace
}  // namespace boresight::simulator::wire
