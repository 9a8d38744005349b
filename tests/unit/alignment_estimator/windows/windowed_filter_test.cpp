// The whole filter on simulated drives with known truth.
#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/alignment_estimator/windows/windows_bench.hpp"

namespace boresight::alignment::windows {
namespace {

TEST(WindowedFilter, FindsFourCornerRadarsWithinItsSigma) {
  WindowsBench bench(corner_drive(11, 60.0));
  bench.run(60.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const RadarEstimate e = bench.filter->estimate(r);
    const Eigen::Vector3d error = bench.error_rad(r);
    EXPECT_EQ(e.state, AlignmentState::kConverged) << r;
    EXPECT_LT(std::abs(e.speed_scale - 1.01), 3.0 * std_of(e, 0)) << r;
    EXPECT_LT(std::abs(error.z()), std::min(3.0 * std_of(e, 3), 0.1 * kRadiansPerDegree)) << r;
    EXPECT_LT(std::abs(error.y()), std::min(3.0 * std_of(e, 2), 0.3 * kRadiansPerDegree)) << r;
    EXPECT_LT(std_of(e, 3), 0.08 * kRadiansPerDegree) << r;
    EXPECT_EQ(e.step_change.count, 0u) << r;
    EXPECT_NEAR(e.angle_noise_scale, 1.0, 0.1) << r;
    EXPECT_NEAR(e.nuisance.range_rate_noise_scale, 1.0, 0.15) << r;
    EXPECT_NEAR(e.inlier_ratio, 0.76, 0.06) << r;
    EXPECT_NE(e.observable & alignment_axis::kVehicleYaw, 0u) << r;
  }
}

TEST(WindowedFilter, ErrorsOfTwentyDrivesAgreeWithSigma) {
  // Clean drives and real cars in turn. The radars of a drive share errors, so a drive counts as one radar: the
  // interval is that of χ² with 24 degrees of freedom at 1e-3, over 24.
  constexpr int kDrives = 24;
  Eigen::Vector3d clean = Eigen::Vector3d::Zero(), real = clean;  // k_v, pitch, yaw
  for (int drive = 0; drive < kDrives; ++drive) {
    const auto seed = static_cast<std::uint64_t>(100 + drive);
    simulator::AlignmentSpec spec = drive % 2 == 0 ? corner_drive(seed, 30.0) : aligned_real_car(seed, 30.0);
    spec.road = drive % 3 == 0 ? simulator::RoadKind::kCity : simulator::RoadKind::kMixed;
    spec.real_car.range_rate_scale = 0.0;  // the truth of k_v is then the signal's alone
    WindowsBench bench(spec);
    bench.run(30.0);
    Eigen::Vector3d& sum = drive % 2 == 0 ? clean : real;
    for (std::size_t r = 0; r < 4; ++r) {
      const RadarEstimate e = bench.filter->estimate(r);
      const Eigen::Vector3d error = bench.error_rad(r);
      sum(0) += std::pow(e.speed_scale - spec.speed_scale, 2) / e.covariance(0, 0) / (2.0 * kDrives);
      sum(1) += std::pow(error.y(), 2) / e.covariance(2, 2) / (2.0 * kDrives);
      sum(2) += std::pow(error.z(), 2) / e.covariance(3, 3) / (2.0 * kDrives);
    }
  }
  // Upper limit: never larger than χ² allows. On clean drives σ is that of priors for real cars, and so too large.
  constexpr double kHigh = 51.2 / kDrives;
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(clean(i), kHigh) << i;
    EXPECT_LT(real(i), kHigh) << i;
  }
  constexpr double kLow = 9.2 / kDrives;
  EXPECT_GT(real(1) + real(2), kLow) << "σ is not simply huge";
}

/// Two filters on the same data; the data of the second are modified.
void compare(const std::function<VehicleConfig(VehicleConfig)>& other_vehicle,
             const std::function<std::size_t(std::size_t)>& other_radar,
             const std::function<void(ScanDetections&, EgoSample&)>& change, const Eigen::Vector3d& signs) {
  WindowsBench bench(corner_drive(41, 20.0));
  const VehicleConfig vehicle = other_vehicle(bench.vehicle);
  const auto other = std::make_unique<WindowedFilter>(vehicle, FilterConfig{});
  auto scan = std::make_unique<ScanDetections>();
  bench.run(20.0, [&](const simulator::AlignmentEvent& event) {
    bench.filter->process(event.radar, *bench.scan, bench.ego);
    *scan = *bench.scan;
    EgoSample ego = bench.ego;
    change(*scan, ego);
    other->process(other_radar(event.radar), *scan, ego);
  });
  for (std::size_t r = 0; r < 4; ++r) {
    const auto turn = [](const RadarEstimate& e, const MountingPose& pose) {
      return geometry::so3_log(e.sensor_to_vehicle * geometry::sensor_to_vehicle(pose, 0.0, 0.0, 0.0).transpose());
    };
    const std::size_t q = other_radar(r);
    const RadarEstimate a = bench.filter->estimate(r), b = other->estimate(q);
    const Eigen::Vector3d d = turn(a, bench.vehicle.radars[r].mounting_pose);
    const Eigen::Vector3d e = turn(b, vehicle.radars[q].mounting_pose);
    EXPECT_NEAR(a.speed_scale, b.speed_scale, 0.05 * std_of(a, 0)) << r;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(d(axis), signs(axis) * e(axis), 0.05 * std_of(a, axis + 1)) << r << ' ' << axis;
      EXPECT_NEAR(std_of(a, axis + 1), std_of(b, axis + 1), 0.02 * std_of(a, axis + 1)) << r << ' ' << axis;
    }
  }
}

TEST(WindowedFilter, AMirroredVehicleHasAMirroredEstimate) {
  compare(
      [](VehicleConfig v) {
        for (RadarConfig& radar : v.radars) {
          radar.mounting_pose.position_m[1] *= -1.0;
          radar.mounting_pose.yaw_rad *= -1.0;
        }
        return v;
      },
      [](std::size_t r) { return r; },
      [](ScanDetections& scan, EgoSample& ego) {
        for (std::size_t i = 0; i < scan.count; ++i) scan.azimuth_rad[i] *= -1.0;
        ego.yaw_rate_radps *= -1.0;
      },
      {-1.0, 1.0, -1.0});
}

TEST(WindowedFilter, AnUpsideDownRadarIsAsAccurate) {
  compare(
      [](VehicleConfig v) {
        for (RadarConfig& radar : v.radars) radar.mounting_pose.roll_rad += M_PI;
        return v;
      },
      [](std::size_t r) { return r; },
      [](ScanDetections& scan, EgoSample&) {
        for (std::size_t i = 0; i < scan.count; ++i) {
          scan.azimuth_rad[i] *= -1.0;
          scan.elevation_rad[i] *= -1.0;
        }
      },
      {1.0, 1.0, 1.0});
}

TEST(WindowedFilter, TheOrderInTheVehicleFileDoesNotMatter) {
  compare(
      [](VehicleConfig v) {
        std::reverse(v.radars.begin(), v.radars.end());
        return v;
      },
      [](std::size_t r) { return 3 - r; }, [](ScanDetections&, EgoSample&) {}, {1.0, 1.0, 1.0});
}

TEST(WindowedFilter, WithoutElevationPitchAndRollAreNotObservable) {
  simulator::AlignmentSpec spec = corner_drive(12, 40.0);
  for (simulator::AlignmentRadar& radar : spec.radars) radar.measures_elevation = false;
  WindowsBench bench(spec);
  bench.run(40.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const RadarEstimate e = bench.filter->estimate(r);
    EXPECT_EQ(e.observable & (alignment_axis::kVehiclePitch | alignment_axis::kVehicleRoll), 0u) << r;
    EXPECT_NE(e.observable & alignment_axis::kVehicleYaw, 0u) << r;
    EXPECT_LT(std::abs(bench.error_rad(r).z()), 0.2 * kRadiansPerDegree) << r;
  }
}

TEST(WindowedFilter, AStandingCarKeepsThePriorAndWaits) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const int kind : {0, 1, 2, 3}) {
    WindowsBench bench(corner_drive(13, 4.0));
    bench.run(4.0, [&](const simulator::AlignmentEvent& event) {
      if (kind == 0) bench.ego.speed_mps = 0.0;
      if (kind == 1) bench.ego.speed_mps = kNan;
      if (kind == 2) bench.ego.stale = true;
      if (kind == 3) bench.scan->range_rate_mps.fill(kNan);
      bench.filter->process(event.radar, *bench.scan, bench.ego);
    });
    const WindowedFilter fresh(bench.vehicle, FilterConfig{});
    for (std::size_t r = 0; r < 4; ++r) {
      const RadarEstimate e = bench.filter->estimate(r), f = fresh.estimate(r);
      EXPECT_EQ(e.state, AlignmentState::kWaiting) << kind;
      EXPECT_EQ(e.observable, 0u) << kind;
      EXPECT_EQ(e.nuisance.observable, 0u) << kind;
      EXPECT_EQ(e.sensor_to_vehicle, f.sensor_to_vehicle) << kind;
      EXPECT_EQ(e.covariance, f.covariance) << kind;
      EXPECT_NEAR(std_of(e, 3), bench.config.priors.rotation_std_rad, 1e-12);
      EXPECT_EQ(e.scans_used, 0u);
    }
    EXPECT_EQ(bench.filter->estimate(4).state, AlignmentState::kNoData);
  }
}

/// What a state that is switched off must not do: have a value, a std or an observable bit.
struct Off {
  const char* name;
  void (*off)(Priors&);
  double (*value)(const RadarEstimate&);
  double (*std)(const RadarEstimate&);
  std::uint32_t bit;
};
const std::vector<Off> kStates = {
    {"range_rate_scale", [](Priors& p) { p.rate_scale_std = 0.0; },
     [](const RadarEstimate& e) -> double { return e.nuisance.range_rate_scale.value; },
     [](const RadarEstimate& e) -> double { return e.nuisance.range_rate_scale.std; },
     alignment_nuisance::kRangeRateScale},
    {"time offset", [](Priors& p) { p.stamp_std_s = p.common_stamp_std_s = 0.0; },
     [](const RadarEstimate& e) -> double { return e.nuisance.time_offset_s.value; },
     [](const RadarEstimate& e) -> double { return e.nuisance.time_offset_s.std; }, alignment_nuisance::kTimeOffset},
    {"position", [](Priors& p) { p.position_std_m = 0.0; },
     [](const RadarEstimate& e) -> double {
       return std::hypot(e.nuisance.position_x_m.value, e.nuisance.position_y_m.value);
     },
     [](const RadarEstimate& e) -> double {
       return std::hypot(e.nuisance.position_x_m.std, e.nuisance.position_y_m.std);
     },
     alignment_nuisance::kPositionX | alignment_nuisance::kPositionY},
    {"azimuth curve", [](Priors& p) { p.curve_std_rad = 0.0; },
     [](const RadarEstimate& e) -> double { return std::abs(e.nuisance.azimuth_curve_rad[2]); },
     [](const RadarEstimate& e) -> double { return e.nuisance.azimuth_curve_std_rad[2]; },
     alignment_nuisance::kAzimuthCurve},
    {"yaw-rate gain", [](Priors& p) { p.yaw_rate_gain_std = 0.0; },
     [](const RadarEstimate& e) -> double { return e.nuisance.yaw_rate_gain.value; },
     [](const RadarEstimate& e) -> double { return e.nuisance.yaw_rate_gain.std; }, alignment_nuisance::kYawRateGain},
    {"load transfer", [](Priors& p) { p.pitch_per_acceleration_std_radps2pm = 0.0; },
     [](const RadarEstimate& e) -> double { return e.nuisance.pitch_per_acceleration_radps2pm.value; },
     [](const RadarEstimate& e) -> double { return e.nuisance.pitch_per_acceleration_radps2pm.std; },
     alignment_nuisance::kPitchPerAcceleration},
    {"load", [](Priors& p) { p.load_std_rad = 0.0; },
     [](const RadarEstimate& e) -> double { return e.nuisance.load_pitch_rad.value; },
     [](const RadarEstimate& e) -> double { return e.nuisance.load_pitch_rad.std; }, alignment_nuisance::kLoadPitch},
    {"yaw-rate bias", [](Priors& p) { p.yaw_rate_bias_std_radps = 0.0; },
     [](const RadarEstimate& e) { return e.yaw_rate_bias_radps; },
     [](const RadarEstimate& e) { return e.yaw_rate_bias_std_radps; }, alignment_nuisance::kYawRateBias},
    {"slip", [](Priors& p) { p.slip_std_radps2pm = 0.0; },
     [](const RadarEstimate& e) { return e.slip_coefficient_radps2pm; },
     [](const RadarEstimate& e) { return e.slip_coefficient_std_radps2pm; }, alignment_nuisance::kSlip},
    {"drift", [](Priors& p) { p.drift_std_radps = 0.0; },
     [](const RadarEstimate& e) -> double { return std::hypot(e.drift.pitch_radps, e.drift.yaw_radps); },
     [](const RadarEstimate& e) -> double { return std::hypot(e.drift.pitch_std_radps, e.drift.yaw_std_radps); }, 0},
    {"own fluctuation",
     [](Priors& p) {
       p.own_std = {0.0, 0.0, 0.0};
     },
     [](const RadarEstimate& e) -> double { return e.nuisance.yaw_scatter_rad; },
     [](const RadarEstimate& e) -> double { return e.nuisance.pitch_scatter_rad; }, 0},
};

TEST(WindowedFilter, EachStateCanBeSwitchedOff) {
  simulator::AlignmentSpec spec = corner_drive(14, 30.0);
  WindowsBench on(spec);
  on.run(30.0);
  for (const Off& state : kStates) {
    WindowsConfig config;
    state.off(config.priors);
    WindowsBench bench(spec, config);
    bench.run(30.0);
    for (const std::size_t r : {0u, 3u}) {
      const RadarEstimate e = bench.filter->estimate(r);
      EXPECT_NEAR(state.value(e), 0.0, 1e-9) << state.name;
      EXPECT_EQ(state.std(e), 0.0) << state.name;
      EXPECT_EQ(e.nuisance.observable & state.bit, 0u) << state.name;
      // It does no harm on a drive without the effect.
      EXPECT_LT(std::abs(bench.error_rad(r).z()), 0.12 * kRadiansPerDegree) << state.name;
      EXPECT_TRUE(e.covariance.allFinite()) << state.name;
    }
    if (std::string(state.name) != "load") {
      EXPECT_GT(state.std(on.filter->estimate(0)), 0.0) << state.name << " is on by default";
    }
  }
}

TEST(WindowedFilter, TheSpeedScaleAndAllElseCanBeSwitchedOff) {
  WindowsConfig config;
  Priors& p = config.priors;
  p.speed_scale_std = 0.0;
  for (const Off& state : kStates) state.off(p);
  p.height_excess_std = p.mirror_share_std = 0.0;
  p.common_std = {0.0, 0.0, 0.0};
  simulator::AlignmentSpec spec = corner_drive(15, 30.0);
  spec.speed_scale = 1.0;
  WindowsBench bench(spec, config);
  bench.run(30.0);
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_NEAR(bench.filter->estimate(r).speed_scale, 1.0, 1e-9);
    EXPECT_LT(std::abs(bench.error_rad(r).z()), 0.02 * kRadiansPerDegree) << r;
    EXPECT_LT(std_of(bench.filter->estimate(r), 3), 0.02 * kRadiansPerDegree) << r;
  }
}

TEST(WindowedFilter, ATrueChangeIsReportedForItsRadar) {
  simulator::AlignmentSpec spec = corner_drive(16, 100.0);
  spec.step_changes.push_back({71.0, 1, {0.0, 0.0, 1.5 * kRadiansPerDegree}});
  WindowsBench bench(spec);
  bench.run(69.0);
  for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(bench.filter->estimate(r).step_change.count, 0u);
  bench.run(100.0);
  for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(bench.filter->estimate(r).step_change.count, r == 1 ? 1u : 0u) << r;
  EXPECT_NEAR(bench.filter->estimate(1).step_change.rotation_vehicle_rad[2], 1.5 * kRadiansPerDegree,
              0.3 * kRadiansPerDegree);
  EXPECT_LT(std::abs(bench.error_rad(1).z()), 0.15 * kRadiansPerDegree);
}

TEST(WindowedFilter, ALoadSoonAfterTheStartIsNoPitchOfTheRadars) {
  simulator::AlignmentSpec spec = aligned_real_car(21, 90.0);
  spec.real_car.load_pitch_rad = 0.7 * kRadiansPerDegree;
  spec.real_car.load_time_s = 30.0;
  WindowsBench bench(spec);
  bench.run(90.0);
  EXPECT_EQ(bench.filter->load_changes(), 1);
  EXPECT_NEAR(std::abs(bench.filter->load_rad()), 0.7 * kRadiansPerDegree, 0.25 * kRadiansPerDegree);
  for (std::size_t r = 0; r < 4; ++r) {
    const Eigen::Matrix3d now = bench.drive.sensor_to_vehicle(r, simulator::AlignmentDrive::kStart_s);
    const double pitch = geometry::so3_log(bench.filter->estimate(r).sensor_to_vehicle * now.transpose()).y();
    EXPECT_LT(std::abs(pitch), 0.25 * kRadiansPerDegree) << r;
    EXPECT_EQ(bench.filter->estimate(r).step_change.count, 0u) << r;
  }
}

TEST(WindowedFilter, AllocatesNothing) {
  // Until the segments are full: the vehicle's system is largest then.
  constexpr double kDuration_s = 110.0;
  WindowsBench bench(aligned_real_car(17, kDuration_s));
  std::vector<double> predicted(kMaxDetections);
  auto memory = std::make_unique<Memory>();
  std::uint64_t allocations = 0;
  int scans = 0;
  bench.run(kDuration_s, [&](const simulator::AlignmentEvent& event) {
    ++scans;
    const std::uint64_t before = runtime::counted_allocations();
    {
      const runtime::CountAllocations count;
      bench.filter->process(event.radar, *bench.scan, bench.ego);
      bench.filter->predict(event.radar, *bench.scan, bench.ego, predicted);
      static_cast<void>(bench.filter->estimate(event.radar));
      if (scans % 500 == 0) bench.filter->save(*memory);
    }
    allocations += runtime::counted_allocations() - before;
  });
  EXPECT_GE(scans, 2'000);
  EXPECT_EQ(allocations, 0u);
  EXPECT_NE(bench.filter->estimate(0).observable & alignment_axis::kVehicleYaw, 0u);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations count;
    EXPECT_TRUE(bench.filter->seed(0, Eigen::Vector3d(0.0, 0.0, 0.01), 1e-6 * Eigen::Matrix3d::Identity()));
  }
  EXPECT_EQ(runtime::counted_allocations() - before, 0u);
}

}  // namespace
}  // namespace boresight::alignment::windows
