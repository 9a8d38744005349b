// The whole filter on simulated drives with known truth.
#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/alignment_estimator/filter/bench.hpp"

namespace boresight::alignment {
namespace {

simulator::AlignmentSpec drive(std::uint64_t seed, double duration_s) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.seed = seed;
  spec.duration_s = duration_s;
  return spec;
}

TEST(RobustFilter, FindsFourCornerRadars) {
  Bench bench(drive(11, 60.0));
  bench.run(60.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const RadarEstimate estimate = bench.filter->estimate(r);
    const Eigen::Vector3d error = bench.error_rad(r) / kRadiansPerDegree;
    EXPECT_EQ(estimate.state, AlignmentState::kConverged) << r;
    EXPECT_NEAR(estimate.speed_scale, 1.01, 1e-4) << r;
    EXPECT_LT(std::abs(error.z()), 0.015) << r;
    EXPECT_LT(std::abs(error.y()), 0.06) << r;
    EXPECT_EQ(estimate.step_change.count, 0u) << r;
    EXPECT_NEAR(estimate.angle_noise_scale, 1.0, 0.1) << r;
    EXPECT_NEAR(estimate.inlier_ratio, 0.76, 0.05) << r;
  }
}

TEST(RobustFilter, StatedCovarianceMatchesTheErrors) {
  // χ² of all drives and radars, per axis; the pitch errors of the radars share that of the body.
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  int count = 0;
  for (std::uint64_t seed = 21; seed < 33; ++seed) {
    simulator::AlignmentSpec spec = drive(seed, 40.0);
    if (seed % 2 == 0) {
      spec.yaw_rate_bias_radps = 0.1 * kRadiansPerDegree;
      spec.slip_coefficient_radps2pm = 0.003;
      spec.body_pitch_std_rad = 0.3 * kRadiansPerDegree;
      spec.body_pitch_per_acceleration_radps2pm = 0.003;
    }
    Bench bench(spec);
    bench.run(40.0);
    for (std::size_t r = 0; r < 4; ++r, ++count) {
      const RadarEstimate estimate = bench.filter->estimate(r);
      const Eigen::Vector3d error = bench.error_rad(r);
      sum(0) += std::pow(estimate.speed_scale - 1.01, 2) / estimate.covariance(0, 0);
      for (Eigen::Index a = 0; a < 3; ++a) sum(a + 1) += error(a) * error(a) / estimate.covariance(a + 1, a + 1);
    }
  }
  sum /= count;
  for (Eigen::Index i = 0; i < 4; ++i) {
    EXPECT_GT(sum(i), 0.25) << i;
    EXPECT_LT(sum(i), 2.3) << i;
  }
}

/// Two filters on the same data; the data of the second are modified.
void compare(const std::function<VehicleConfig(VehicleConfig)>& other_vehicle,
             const std::function<std::size_t(std::size_t)>& other_radar,
             const std::function<void(ScanDetections&, EgoSample&)>& change, const Eigen::Vector3d& signs) {
  Bench bench(drive(41, 15.0));
  const VehicleConfig vehicle = other_vehicle(bench.vehicle);
  RobustFilter other(vehicle, FilterConfig{});
  auto scan = std::make_unique<ScanDetections>();
  bench.run(15.0, [&](const simulator::AlignmentEvent& event) {
    *scan = *bench.scan;
    EgoSample ego = bench.ego;
    change(*scan, ego);
    other.process(other_radar(event.radar), *scan, ego);
  });
  for (std::size_t r = 0; r < 4; ++r) {
    const auto turn = [](const RadarEstimate& e, const MountingPose& pose) {
      return geometry::so3_log(e.sensor_to_vehicle * geometry::sensor_to_vehicle(pose, 0.0, 0.0, 0.0).transpose());
    };
    const std::size_t q = other_radar(r);
    const RadarEstimate a = bench.filter->estimate(r), b = other.estimate(q);
    const Eigen::Vector3d d = turn(a, bench.vehicle.radars[r].mounting_pose);
    const Eigen::Vector3d e = turn(b, vehicle.radars[q].mounting_pose);
    EXPECT_NEAR(a.speed_scale, b.speed_scale, 2e-7) << r;
    EXPECT_LT((d - signs.asDiagonal() * e).tail<2>().norm(), 2e-5) << r;
    EXPECT_NEAR(d.x(), signs.x() * e.x(), 2e-3) << r;
  }
}

TEST(RobustFilter, AMirroredVehicleHasAMirroredEstimate) {
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

TEST(RobustFilter, AnUpsideDownRadarIsAsAccurate) {
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

TEST(RobustFilter, TheOrderInTheVehicleFileDoesNotMatter) {
  compare(
      [](VehicleConfig v) {
        std::reverse(v.radars.begin(), v.radars.end());
        return v;
      },
      [](std::size_t r) { return 3 - r; }, [](ScanDetections&, EgoSample&) {}, {1.0, 1.0, 1.0});
}

TEST(RobustFilter, DenseLeastSquaresFindsTheSame) {
  // With nearly exact angles, no outliers and exact ego signals the estimate must equal weighted least squares over all
  // detections at once, here with numerical derivatives.
  simulator::AlignmentSpec spec = drive(51, 12.0);
  spec.radars.resize(1);
  spec.outlier_share = 0.0;
  spec.speed_std_mps = spec.yaw_rate_std_radps = 0.0;
  spec.radars[0].config.noise.azimuth_std_rad = spec.radars[0].config.noise.elevation_std_rad = 1e-4;
  FilterConfig config;
  config.prior_yaw_rate_bias_std_radps = config.prior_slip_coefficient_std_radps2pm = 1e-9;
  config.prior_pitch_per_acceleration_std_radps2pm = 1e-9;
  config.start_inflation = 1.0;
  Bench bench(spec, config);
  struct Row {
    Eigen::Vector3d sight;
    double rate, speed, yaw_rate;
  };
  std::vector<Row> rows;
  bench.run(12.0, [&](const simulator::AlignmentEvent&) {
    for (std::size_t i = 0; i < bench.scan->count; ++i) {
      rows.push_back({geometry::direction(bench.scan->azimuth_rad[i], bench.scan->elevation_rad[i]),
                      bench.scan->range_rate_mps[i], bench.ego.speed_mps, bench.ego.yaw_rate_radps});
    }
  });
  const MountingPose& pose = bench.vehicle.radars[0].mounting_pose;
  Eigen::Vector4d x(1.0, 0.0, 0.0, 0.0);
  Eigen::Matrix4d information;
  const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(pose, 0.0, 0.0, 0.0);
  const auto residual = [&](const Row& row, const Eigen::Vector4d& at) {
    const Eigen::Matrix3d rotation = geometry::so3_exp(at.tail<3>()) * nominal;
    return row.rate -
           geometry::stationary_range_rate(rotation * row.sight,
                                           geometry::sensor_velocity(at(0), row.speed, row.yaw_rate, pose.position_m));
  };
  for (int iteration = 0; iteration < 5; ++iteration) {
    information = Eigen::Matrix4d::Zero();
    information(0, 0) = std::pow(config.prior_speed_scale_std, -2);
    for (Eigen::Index a = 1; a < 4; ++a) information(a, a) = std::pow(config.prior_rotation_std_rad, -2);
    Eigen::Vector4d right = information * (Eigen::Vector4d(1.0, 0.0, 0.0, 0.0) - x);
    for (const Row& row : rows) {
      const double e = residual(row, x);
      Eigen::Vector4d j;
      for (Eigen::Index a = 0; a < 4; ++a) {
        const Eigen::Vector4d h = 1e-6 * Eigen::Vector4d::Unit(a);
        j(a) = (residual(row, x - h) - residual(row, x + h)) / 2e-6;
      }
      information += j * j.transpose() / (0.03 * 0.03);
      right += j * e / (0.03 * 0.03);
    }
    x += information.inverse() * right;
  }
  const RadarEstimate estimate = bench.filter->estimate(0);
  const Eigen::Vector4d std = estimate.covariance.diagonal().cwiseSqrt();
  const Eigen::Vector3d d = geometry::so3_log(estimate.sensor_to_vehicle * nominal.transpose());
  EXPECT_LT(std::abs(estimate.speed_scale - x(0)), 0.6 * std(0));
  EXPECT_LT(std::abs(d.y() - x(2)), 0.6 * std(2));
  EXPECT_LT(std::abs(d.z() - x(3)), 0.6 * std(3));
}

TEST(RobustFilter, StraightRoadLeavesRollOpen) {
  simulator::AlignmentSpec spec = drive(61, 60.0);
  spec.road = simulator::RoadKind::kStraight;
  Bench bench(spec);
  bench.run(60.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const std::uint32_t observable = bench.filter->estimate(r).observable;
    EXPECT_EQ(observable & alignment_axis::kVehicleRoll, 0u) << r;
    EXPECT_NE(observable & alignment_axis::kVehiclePitch, 0u) << r;
    EXPECT_NE(observable & alignment_axis::kVehicleYaw, 0u) << r;
  }
}

TEST(RobustFilter, WithoutElevationYawAndSpeedOnly) {
  simulator::AlignmentSpec spec = drive(62, 30.0);
  for (simulator::AlignmentRadar& radar : spec.radars) radar.measures_elevation = false;
  Bench bench(spec);
  bench.run(30.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const RadarEstimate estimate = bench.filter->estimate(r);
    EXPECT_EQ(estimate.observable & (alignment_axis::kVehicleRoll | alignment_axis::kVehiclePitch), 0u) << r;
    EXPECT_NE(estimate.observable & alignment_axis::kVehicleYaw, 0u) << r;
    EXPECT_LT(std::abs(bench.error_rad(r).z()), 0.15 * kRadiansPerDegree) << r;
    const double speed_scale_std = std::sqrt(estimate.covariance(0, 0));
    EXPECT_GT(speed_scale_std, 3e-4) << "the mean elevation is not known";
    EXPECT_LT(std::abs(estimate.speed_scale - spec.speed_scale), 3.0 * speed_scale_std) << r;
  }
}

TEST(RobustFilter, ConvergesWithHalfOutliersAndFiveDegreesOfError) {
  for (std::uint64_t seed = 71; seed < 77; ++seed) {
    simulator::AlignmentSpec spec = drive(seed, 4.0);
    spec.outlier_share = 0.5;
    const double side = seed % 2 == 0 ? 5.0 * kRadiansPerDegree : -5.0 * kRadiansPerDegree;
    for (simulator::AlignmentRadar& radar : spec.radars) radar.truth = {side, -side, side};
    Bench bench(spec);
    bench.run(4.0);
    for (std::size_t r = 0; r < 4; ++r) EXPECT_LT(std::abs(bench.error_rad(r).z()), 0.3 * kRadiansPerDegree) << seed;
  }
}

TEST(RobustFilter, AmbiguousAndUnsynchronisedRadars) {
  simulator::AlignmentSpec spec = drive(63, 40.0);
  for (std::size_t r = 0; r < 4; ++r) {
    spec.radars[r].ambiguity_mps = 20.0 + static_cast<double>(r);
    spec.radars[r].first_scan_s = 0.0125 * static_cast<double>(r);
    spec.radars[r].config.cycle_time_s = 0.05 + 0.007 * static_cast<double>(r);
  }
  Bench bench(spec);
  bench.run(40.0);
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_LT(std::abs(bench.error_rad(r).z()), 0.02 * kRadiansPerDegree) << r;
    EXPECT_LT(std::abs(bench.error_rad(r).y()), 0.12 * kRadiansPerDegree) << r;
  }
}

TEST(RobustFilter, InvalidInputsAreRejected) {
  Bench bench(drive(64, 20.0));
  const double nan = std::numeric_limits<double>::quiet_NaN(), huge = std::numeric_limits<double>::max();
  int n = 0;
  bench.change = [&](const simulator::AlignmentEvent& event, ScanDetections& scan) {
    ++n;
    scan.azimuth_rad[0] = nan;
    scan.range_rate_mps[1] = huge;
    scan.elevation_rad[2] = -huge;
    scan.azimuth_std_rad[3] = 0.0;
    if (n % 7 == 0) scan.time_ns -= 5'000'000'000;
    if (n % 11 == 0) scan.time_ns = std::numeric_limits<std::int64_t>::max() / 2;
    if (n % 13 == 0) scan.count = 0;
    // Invalid ego motions between the good ones.
    for (const EgoSample& ego :
         {EgoSample{}, EgoSample{true, true, 20.0, 0.1, 0.0, 0.01}, EgoSample{true, false, nan, 0.1, 0.0, 0.01},
          EgoSample{true, false, 1e6, nan, 1e9, nan}, EgoSample{true, false, 4.0, 0.1, 0.0, 0.01}}) {
      bench.filter->process(event.radar, scan, ego);
    }
    bench.filter->process(99, scan, EgoSample{});
    if (n % 7 == 0 || n % 11 == 0) scan.time_ns = event.scan->header.measurement_time_ns;
  };
  bench.run(20.0);
  EXPECT_TRUE(bench.filter->state().finite());
  for (std::size_t r = 0; r < 4; ++r) EXPECT_LT(std::abs(bench.error_rad(r).z()), 0.05 * kRadiansPerDegree) << r;
  EXPECT_EQ(bench.filter->estimate(99).state, AlignmentState::kNoData);
}

TEST(RobustFilter, AMemoryHelpsAndIsDroppedIfWrong) {
  Memory memory;
  {
    Bench before(drive(81, 60.0));
    before.run(60.0);
    before.filter->save(memory);
  }
  ASSERT_EQ(memory.number_of_radars, 4u);
  // On a straight road only the memory of the last drive contains roll.
  simulator::AlignmentSpec spec = drive(82, 10.0);
  spec.road = simulator::RoadKind::kStraight;
  Bench same(spec);
  same.filter->restore(memory);
  EXPECT_LT(std::abs(same.error_rad(0).z()), 0.02 * kRadiansPerDegree) << "before the first scan";
  EXPECT_EQ(same.filter->estimate(0).state, AlignmentState::kNoData);
  same.run(10.0);
  EXPECT_NE(same.filter->estimate(0).observable & alignment_axis::kVehicleRoll, 0u);
  // One radar was remounted while the car was parked.
  simulator::AlignmentSpec changed = drive(83, 10.0);
  changed.radars[2].truth.yaw_rad += 3.0 * kRadiansPerDegree;
  Bench remounted(changed);
  remounted.filter->restore(memory);
  remounted.run(10.0);
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_LT(std::abs(remounted.error_rad(r).z()), 0.05 * kRadiansPerDegree) << r;
    EXPECT_LT(std::abs(remounted.error_rad(r).y()), 0.3 * kRadiansPerDegree) << r;
  }
  // A memory of another vehicle is ignored.
  simulator::AlignmentSpec fewer = drive(84, 1.0);
  fewer.radars.resize(2);
  Bench foreign(fewer);
  foreign.filter->restore(memory);
  EXPECT_EQ(foreign.filter->estimate(0).speed_scale, 1.0);
}

TEST(RobustFilter, AStepChangeIsReportedForItsRadarOnly) {
  struct Case {
    double pitch_deg, yaw_deg, within_s;
  };
  for (const Case& step_change : {Case{0.0, 1.0, 3.0}, Case{2.0, 0.0, 6.0}, Case{0.0, -5.0, 3.0}}) {
    simulator::AlignmentSpec spec = drive(91, 40.0);
    spec.step_changes.push_back(
        {26.2, 1, {0.0, step_change.pitch_deg * kRadiansPerDegree, step_change.yaw_deg * kRadiansPerDegree}});
    Bench bench(spec);
    bench.run(25.0);
    for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(bench.filter->estimate(r).step_change.count, 0u);
    bench.run(25.2 + step_change.within_s);
    EXPECT_EQ(bench.filter->estimate(1).step_change.count, 1u);
    bench.run(40.0);
    const AlignmentStepChange reported = bench.filter->estimate(1).step_change;
    EXPECT_NEAR(reported.rotation_vehicle_rad[1], step_change.pitch_deg * kRadiansPerDegree, 0.5 * kRadiansPerDegree);
    EXPECT_NEAR(reported.rotation_vehicle_rad[2], step_change.yaw_deg * kRadiansPerDegree, 0.1 * kRadiansPerDegree);
    for (std::size_t r = 0; r < 4; ++r) {
      EXPECT_EQ(bench.filter->estimate(r).step_change.count, r == 1 ? 1u : 0u);
      EXPECT_LT(std::abs(bench.error_rad(r).z()), 0.03 * kRadiansPerDegree) << r;
      EXPECT_LT(std::abs(bench.error_rad(r).y()), 0.3 * kRadiansPerDegree) << r;
    }
  }
}

TEST(RobustFilter, ASlowDriftIsNoStepChange) {
  // 0.6° in a minute, far faster than the random walk of the mounting.
  simulator::AlignmentSpec spec = drive(92, 90.0);
  for (int i = 0; i < 300; ++i) {
    spec.step_changes.push_back({16.0 + 0.2 * i, 0, {0.0, 0.0, 0.6 / 300.0 * kRadiansPerDegree}});
  }
  Bench bench(spec);
  bench.run(90.0);
  EXPECT_EQ(bench.filter->estimate(0).step_change.count, 0u);
}

TEST(RobustFilter, AllocatesNothingWhileDriving) {
  Bench bench(drive(12, 6.0));
  bench.run(6.0, [&](const simulator::AlignmentEvent& event) {
    const std::uint64_t before = runtime::counted_allocations();
    {
      const runtime::CountAllocations counting;
      bench.filter->process(event.radar, *bench.scan, bench.ego);
      static_cast<void>(bench.filter->estimate(event.radar));
    }
    ASSERT_EQ(runtime::counted_allocations(), before);
  });
}

TEST(RobustFilter, PredictsTheRangeRatesOfStationaryReflectors) {
  Bench bench(drive(13, 20.0));
  double square = 0.0;
  std::size_t count = 0;
  std::vector<double> predicted(kMaxDetections);
  bench.run(20.0, [&](const simulator::AlignmentEvent& event) {
    if (bench.time_s < 5.0) return;
    bench.filter->predict(event.radar, *bench.scan, bench.ego, predicted);
    for (std::size_t i = 0; i < bench.scan->count; ++i) {
      if (!(*event.truth)[i].stationary) continue;
      square += std::pow(bench.scan->range_rate_mps[i] - predicted[i], 2);
      ++count;
    }
  });
  EXPECT_LT(std::sqrt(square / static_cast<double>(count)), 0.25);
}

}  // namespace
}  // namespace boresight::alignment
