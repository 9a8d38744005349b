// The batch estimator over simulated drives, read as often as it wants.
#include "services/alignment_estimator/core/batch/batch.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include <gmock/gmock.h>

#include "services/alignment_estimator/core/batch/estimate_values.hpp"
#include "services/alignment_estimator/core/windows/windowed_filter.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/simulator/alignment/drive.hpp"

namespace boresight::alignment::batch {
namespace {

using ::testing::HasSubstr;

constexpr double kStart_s = 1.0;  // of the simulator's stamps

simulator::AlignmentSpec drive_of(double duration_s, std::uint64_t seed) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.duration_s = duration_s;
  spec.seed = seed;
  return spec;
}

using Change = std::function<void(ScanDetections&, EgoSample&)>;

Result batch_over(const simulator::AlignmentSpec& spec, const Change& change = {}) {
  const VehicleConfig vehicle = simulator::AlignmentDrive(spec).vehicle();
  const FilterConfig config;
  WindowedFilter filter(vehicle, config);
  Batch batch(vehicle, config);
  const auto scan = std::make_unique<ScanDetections>();
  bool is_first = true;
  do {
    simulator::AlignmentDrive drive(spec);
    EgoHistory history;
    for (simulator::AlignmentEvent event; drive.next(event);) {
      if (event.ego != nullptr) {
        history.add(*event.ego);
        continue;
      }
      take_detections(*event.scan, vehicle.radars[event.radar], *scan);
      EgoSample ego = history.at(scan->time_ns);
      if (change) change(*scan, ego);
      if (is_first) {
        filter.process(event.radar, *scan, ego);
        batch.observe(event.radar, *scan, ego, filter.estimate(event.radar));
      } else {
        batch.process(event.radar, *scan, ego);
      }
    }
    is_first = false;
  } while (batch.end_pass());
  return batch.result();
}

/// Rotation of the error about the vehicle's axes.
Eigen::Vector3d error_rad(const simulator::AlignmentSpec& spec, std::size_t radar, const RadarEstimate& estimate,
                          double time_s) {
  const simulator::AlignmentDrive drive(spec);
  return geometry::so3_log(estimate.sensor_to_vehicle * drive.sensor_to_vehicle(radar, kStart_s + time_s).transpose());
}

double std_of(const RadarEstimate& estimate, int axis) {
  return std::sqrt(estimate.covariance(axis, axis));
}

TEST(Batch, RecoversTheMountingOfEveryRadarWithinItsStd) {
  const simulator::AlignmentSpec spec = drive_of(40.0, 4101);
  const Result result = batch_over(spec);
  ASSERT_EQ(result.problem, "");
  ASSERT_EQ(result.radars.size(), 4u);
  EXPECT_NEAR(result.driven_s, 40.0, 3.0);
  EXPECT_GE(result.windows, 7);
  EXPECT_GE(result.passes, 3);
  for (std::size_t r = 0; r < 4; ++r) {
    SCOPED_TRACE(r);
    const RadarEstimate& e = result.radars[r];
    const Eigen::Vector3d error = error_rad(spec, r, e, 40.0);
    EXPECT_LT(std::abs(error.z()), 0.05 * kRadiansPerDegree);
    EXPECT_LT(std::abs(error.y()), 0.2 * kRadiansPerDegree);
    EXPECT_LT(std::abs(error.z()), 3.5 * std_of(e, 3));
    EXPECT_LT(std::abs(error.y()), 3.5 * std_of(e, 2));
    EXPECT_LT(std::abs(e.speed_scale - spec.speed_scale), 5e-4);
    EXPECT_EQ(e.state, AlignmentState::kConverged);
    EXPECT_EQ(e.step_change.count, 0u);
    EXPECT_FALSE(result.before[r].has_value());
    EXPECT_GT(e.scans_used, 300u);
    EXPECT_GT(e.inlier_ratio, 0.5);
  }
}

TEST(Batch, StdCoversTheErrorOverDrives) {
  int covered = 0, all = 0;
  for (std::uint64_t seed = 4200; seed < 4204; ++seed) {
    simulator::AlignmentSpec spec = drive_of(30.0, seed);
    spec.real_car.range_rate_scale = 0.0025;
    const Result result = batch_over(spec);
    for (std::size_t r = 0; r < result.radars.size(); ++r) {
      const Eigen::Vector3d error = error_rad(spec, r, result.radars[r], 30.0);
      for (const int axis : {1, 2}) {
        covered += std::abs(error(axis)) < 1.96 * std_of(result.radars[r], axis + 1) ? 1 : 0;
        ++all;
      }
    }
  }
  EXPECT_EQ(all, 32);
  EXPECT_GE(covered, 28);
}

TEST(Batch, SuddenMisalignmentIsReportedWithTheMountingsOnBothSides) {
  simulator::AlignmentSpec spec = drive_of(120.0, 4300);
  spec.step_changes.push_back({kStart_s + 75.0, 1, {0.0, 0.0, 1.5 * kRadiansPerDegree}});
  const Result result = batch_over(spec);
  ASSERT_EQ(result.problem, "");
  EXPECT_EQ(result.radars[1].step_change.count, 1u);
  EXPECT_LT(std::abs(error_rad(spec, 1, result.radars[1], 120.0).z()), 0.05 * kRadiansPerDegree);
  ASSERT_TRUE(result.before[1].has_value());
  EXPECT_LT(std::abs(error_rad(spec, 1, *result.before[1], 10.0).z()), 0.05 * kRadiansPerDegree);
  for (const std::size_t other : {0u, 2u, 3u}) EXPECT_FALSE(result.before[other].has_value());
}

TEST(Batch, ShortDriveGivesASentence) {
  const Result result = batch_over(drive_of(8.0, 4400));
  EXPECT_THAT(result.problem,
              HasSubstr("s of driving at 5 m/s or more are too few for the batch method: it needs 15 s"));
  EXPECT_EQ(result.radars.size(), 4u);
  EXPECT_EQ(result.passes, 0);
}

TEST(Batch, StandingVehicleGivesASentence) {
  const Result result = batch_over(drive_of(20.0, 4401), [](ScanDetections&, EgoSample& ego) { ego.speed_mps = 0.0; });
  EXPECT_THAT(result.problem, HasSubstr("the vehicle never drives at 5 m/s or more"));
}

TEST(Batch, DriveWithoutEgoMotionGivesASentence) {
  const Result result = batch_over(drive_of(5.0, 4402), [](ScanDetections&, EgoSample& ego) { ego.valid = false; });
  EXPECT_EQ(result.problem, "no scan has a speed and a yaw rate near its time");
}

TEST(Batch, EmptyDriveGivesASentence) {
  const VehicleConfig vehicle = simulator::AlignmentDrive(drive_of(5.0, 1)).vehicle();
  Batch batch(vehicle, FilterConfig{});
  EXPECT_FALSE(batch.end_pass());
  const Result result = batch.result();
  EXPECT_EQ(result.problem, "there is no detection in the drive");
  EXPECT_EQ(result.radars.size(), vehicle.radars.size());
  Batch without_radars(VehicleConfig{}, FilterConfig{});
  EXPECT_FALSE(without_radars.end_pass());
  EXPECT_NE(without_radars.result().problem, "");
}

TEST(Batch, SingleRadarIsEnough) {
  simulator::AlignmentSpec spec = drive_of(40.0, 4500);
  spec.radars.resize(1);
  const Result result = batch_over(spec);
  ASSERT_EQ(result.problem, "");
  const Eigen::Vector3d error = error_rad(spec, 0, result.radars[0], 40.0);
  EXPECT_LT(std::abs(error.z()), 0.1 * kRadiansPerDegree);
  EXPECT_LT(std::abs(error.z()), 3.5 * std_of(result.radars[0], 3));
}

TEST(Batch, RadarWithoutElevationHasAYawAndNoPitch) {
  simulator::AlignmentSpec spec = drive_of(40.0, 4600);
  for (simulator::AlignmentRadar& radar : spec.radars) radar.measures_elevation = false;
  const Result result = batch_over(spec);
  ASSERT_EQ(result.problem, "");
  for (std::size_t r = 0; r < result.radars.size(); ++r) {
    const RadarEstimate& e = result.radars[r];
    EXPECT_EQ(e.observable & (alignment_axis::kVehiclePitch | alignment_axis::kVehicleRoll), 0u);
    EXPECT_NE(e.observable & alignment_axis::kVehicleYaw, 0u);
    EXPECT_LT(std::abs(error_rad(spec, r, e, 40.0).z()), 0.1 * kRadiansPerDegree);
    // The mean cosine of unknown elevations is not known better than this.
    EXPECT_GT(std_of(e, 0), 3e-4);
    EXPECT_LT(std::abs(e.speed_scale - spec.speed_scale), 3.0 * std_of(e, 0));
  }
}

TEST(Batch, RadarThatIsSilentIsNotObservable) {
  const simulator::AlignmentSpec spec = drive_of(25.0, 4700);
  const VehicleConfig vehicle = simulator::AlignmentDrive(spec).vehicle();
  std::size_t scans = 0;
  const Result result = batch_over(spec, [&](ScanDetections& scan, EgoSample&) {
    if (scans++ % vehicle.radars.size() == 0) scan.count = 0;
  });
  ASSERT_EQ(result.problem, "");
  EXPECT_EQ(result.radars[0].observable, 0u);
  EXPECT_EQ(result.radars[0].scans_used, 0u);
  EXPECT_NE(result.radars[1].observable, 0u);
}

TEST(EstimateValues, StdsAreWidenedAtUnchangedCorrelationAndNeverNarrowed) {
  RadarEstimate e;
  e.covariance = Eigen::Vector4d(1.0, 4.0, 9.0, 16.0).asDiagonal();
  e.covariance(2, 3) = e.covariance(3, 2) = 6.0;
  e.nuisance.time_offset_s = {0.0F, 0.5F};
  Values stds = Values::Zero();
  stds(3) = 8.0;
  stds(0) = 0.1;
  stds(kMainValues + 1) = 1.0;
  widen(e, stds);
  EXPECT_DOUBLE_EQ(e.covariance(0, 0), 1.0);
  EXPECT_DOUBLE_EQ(e.covariance(3, 3), 64.0);
  EXPECT_DOUBLE_EQ(e.covariance(2, 3), 12.0);
  EXPECT_FLOAT_EQ(e.nuisance.time_offset_s.std, 1.0F);
  EXPECT_FLOAT_EQ(e.nuisance.range_rate_scale.std, 0.0F) << "not estimated";
}

TEST(DrivingClock, CountsBlocksOfDrivingAndNoPauses) {
  DrivingClock clock(1.0);
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  EXPECT_EQ(clock.block_at(5 * kSecond_ns), 0u);
  EXPECT_EQ(clock.block_at(5 * kSecond_ns + kSecond_ns / 2), 0u);
  EXPECT_EQ(clock.block_at(5 * kSecond_ns - kSecond_ns / 4), 0u) << "out of order";
  EXPECT_EQ(clock.block_at(6 * kSecond_ns), 1u);
  EXPECT_EQ(clock.block_at(100 * kSecond_ns), 2u);
  EXPECT_EQ(clock.block_at(2 * kSecond_ns), 3u) << "the recording begins again";
  EXPECT_DOUBLE_EQ(clock.driven_s(), 4.0);
}

}  // namespace
}  // namespace boresight::alignment::batch
