// The baseline tracker on hand-made scans.
#include "tests/benchmarks/tracking/common/baseline_tracker.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "services/boresight/score/run_folder.hpp"
#include "tests/benchmarks/tracking/common/baseline_run.hpp"

namespace boresight::bench {
namespace {

constexpr double kPeriod_s = 0.05;

VehicleConfig vehicle_with_radar() {
  VehicleConfig vehicle;
  vehicle.radars.emplace_back();
  vehicle.radars.back().id = 1;
  return vehicle;
}

class Baseline : public testing::Test {
 protected:
  /// A scan at the next time; detections move with `speed_mps` away from the sensor over ground.
  void step(std::vector<BaselineDetection> detections, double ego_speed_mps = 0.0, double yaw_rate_radps = 0.0) {
    BaselineScan scan;
    scan.t_s = time_s_ += kPeriod_s;
    scan.radar = 1;
    scan.sensor_velocity_mps = {ego_speed_mps, 0.0};
    scan.ego_speed_mps = ego_speed_mps;
    scan.ego_yaw_rate_radps = yaw_rate_radps;
    scan.detections = detections;
    tracker_.step(scan);
  }
  [[nodiscard]] std::size_t confirmed() const {
    std::size_t count = 0;
    for (const BaselineTrack& track : tracker_.tracks()) count += track.confirmed ? 1 : 0;
    return count;
  }
  BaselineTracker tracker_{vehicle_with_radar()};
  double time_s_ = 0.0;
};

TEST_F(Baseline, ConfirmsAMovingObjectAtItsThirdScan) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(confirmed(), 0u);
    const double x = 20.0 + 8.0 * kPeriod_s * i;
    step({{{x, 0.0}, 8.0}, {{x + 1.5, 0.5}, 8.0}});
  }
  ASSERT_EQ(tracker_.tracks().size(), 1u);
  const BaselineTrack track = tracker_.tracks().front();
  EXPECT_TRUE(track.confirmed);
  EXPECT_EQ(track.detections, 2u);
  EXPECT_NEAR(track.position_m.x(), 20.75 + 0.8, 0.3);
  EXPECT_NEAR(track.velocity_mps.x(), 8.0, 0.5);
}

TEST_F(Baseline, IgnoresWhatAgreesWithAStationaryObject) {
  for (int i = 0; i < 5; ++i) step({{{20.0, 0.0}, 0.1}});
  EXPECT_TRUE(tracker_.tracks().empty());
  for (int i = 0; i < 5; ++i) step({{{20.0, 0.0}, std::nan("")}});
  EXPECT_TRUE(tracker_.tracks().empty());
}

TEST_F(Baseline, ThresholdGrowsAcrossTheDirectionOfTravel) {
  BaselineScan scan;
  scan.radar = 1;
  scan.sensor_velocity_mps = {30.0, 0.0};
  EXPECT_TRUE(tracker_.is_moving({{20.0, 0.0}, 0.8}, scan));
  EXPECT_FALSE(tracker_.is_moving({{0.0, 20.0}, 0.8}, scan));
}

TEST_F(Baseline, DeletesATrackAfterFiveMisses) {
  for (int i = 0; i < 4; ++i) step({{{20.0, 0.0}, 2.0}});
  EXPECT_EQ(confirmed(), 1u);
  for (int i = 0; i < 4; ++i) step({});
  EXPECT_EQ(confirmed(), 1u);
  step({});
  EXPECT_TRUE(tracker_.tracks().empty());
}

TEST_F(Baseline, StatesItsHitsInTheLatestLooks) {
  for (int i = 0; i < 25; ++i) step({{{20.0, 0.0}, 2.0}});
  EXPECT_EQ(tracker_.tracks().at(0).hits, 20u);
  for (int i = 0; i < 3; ++i) step({});
  EXPECT_EQ(tracker_.tracks().at(0).hits, 17u);
}

TEST_F(Baseline, FalseDetectionsOfOneScanAreNotConfirmed) {
  for (int i = 0; i < 10; ++i) step({{{20.0 + 20.0 * (i % 3), 10.0 * (i % 4)}, 9.0}});
  EXPECT_EQ(confirmed(), 0u);
}

TEST_F(Baseline, VelocityIsOverGroundWhileTheVehicleTurns) {
  // The object stands in front of a vehicle that drives 10 m/s on a circle: it moves with the vehicle.
  for (int i = 0; i < 40; ++i) step({{{20.0, 0.0}, 10.0}}, 10.0, 0.05);
  ASSERT_EQ(confirmed(), 1u);
  const BaselineTrack track = tracker_.tracks().front();
  // Velocity of a point that is fixed to the vehicle: (v, ω·x).
  EXPECT_NEAR(track.velocity_mps.x(), 10.0, 0.5);
  EXPECT_NEAR(track.velocity_mps.y(), 1.0, 0.5);
}

TEST(BaselineRun, WritesARunThatTheJudgeReads) {
  namespace fs = std::filesystem;
  const fs::path run = fs::path(testing::TempDir()) / "baseline_run",
                 out = fs::path(testing::TempDir()) / "baseline_out";
  fs::create_directories(run);
  std::ofstream scans(run / "scans.csv"), detections(run / "detections.csv");
  scans << "t_s,time_ns,radar,scan,detections,flags,sensor_x_m,sensor_y_m,sensor_vx_mps,sensor_vy_mps,ego_speed_mps,"
           "ego_yaw_rate_radps,moving,tracks,confirmed\n";
  detections << "t_s,time_ns,radar,scan,index,x_vehicle_m,y_vehicle_m,range_rate_over_ground_mps,origin,rejected\n";
  for (int i = 1; i <= 4; ++i) {
    const std::string key =
        std::to_string(0.05 * i) + "," + std::to_string(50'000'000LL * i) + ",1," + std::to_string(i) + ",";
    scans << key << "2,0,0,0,0,0,0,0,1,0,0\n";
    detections << key << "0,20,0,5,ghost_type_2,\n" << key << "1,60,0,5,unknown,weak\n";
  }
  scans.close();
  detections.close();
  run_baseline(run, vehicle_with_radar(), out);
  score::RunScans list(out);
  score::RunTracks tracks(out);
  score::RunScan scan;
  std::vector<judge::ScoredTrack> at;
  int count = 0;
  while (list.next(scan)) {
    tracks.take(scan, at);
    ASSERT_EQ(at.size(), 1u) << "a rejected detection is not used, a label is not read";
    EXPECT_EQ(at[0].confirmed, ++count >= 3);
  }
  EXPECT_EQ(count, 4);
  EXPECT_GT(at[0].position_covariance_m2(0, 0), 0.0);
}

}  // namespace
}  // namespace boresight::bench
