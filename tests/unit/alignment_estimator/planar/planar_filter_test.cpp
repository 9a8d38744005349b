// The planar filter on drives that follow the planar model.
#include <limits>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/alignment_estimator/planar/planar_bench.hpp"

namespace boresight::alignment::planar {
namespace {

constexpr std::uint32_t kVehiclePitchAndRoll = alignment_axis::kVehiclePitch | alignment_axis::kVehicleRoll;

simulator::AlignmentSpec without_noise(simulator::AlignmentSpec spec) {
  for (simulator::AlignmentRadar& radar : spec.radars) {
    radar.config.noise.azimuth_std_rad = radar.config.noise.elevation_std_rad = 1e-5;
    radar.config.noise.range_rate_std_mps = 1e-3;
  }
  return spec;
}

TEST(PlanarFilter, FindsTheTruthWithoutNoise) {
  PlanarBench bench(without_noise(published_drive(20.0, 3)));
  bench.run();
  for (std::size_t r = 0; r < 4; ++r) {
    const Eigen::Vector4d error = bench.error(r);
    EXPECT_LT(std::abs(error(0)), 5e-6) << r;
    EXPECT_LT(std::abs(error(1)), 5e-4 * kRadiansPerDegree) << r;
    EXPECT_LT(error.tail<2>().norm(), 0.005 * kRadiansPerDegree) << r;
    EXPECT_EQ(bench.filter->estimate(r).state, AlignmentState::kConverged);
  }
}

TEST(PlanarFilter, FindsTiltedRolledAndUpsideDownRadars) {
  simulator::AlignmentSpec spec = without_noise(published_drive(20.0, 4));
  spec.radars[0].config.mounting_pose.pitch_rad = 0.06;
  spec.radars[1].config.mounting_pose.roll_rad = 0.2;
  spec.radars[2].config.mounting_pose.roll_rad = M_PI;
  PlanarBench bench(spec);
  bench.run();
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_LT(bench.error(r).tail<3>().norm(), 0.005 * kRadiansPerDegree) << r;
    // The published angles are added to the nominal ones.
    const Eigen::Vector3d angles = geometry::euler_angles(bench.filter->estimate(r).sensor_to_vehicle);
    EXPECT_NEAR(angles(1), spec.radars[r].config.mounting_pose.pitch_rad + bench.truth(r)(2), 1e-4);
  }
}

TEST(PlanarFilter, BiasOnAShortPublishedDriveReachesTheBoundAndItsStdIsConsistent) {
  PlanarBench bench(published_drive(120.0, 7));
  bench.run();
  Eigen::Vector4d nees = Eigen::Vector4d::Zero();
  for (std::size_t r = 0; r < 4; ++r) {
    const Eigen::Vector4d error = bench.error(r);
    EXPECT_LT(std::abs(error(0)), 2.99e-5) << r;
    EXPECT_LT(std::abs(error(1)), 0.0106 / 2.0 * kRadiansPerDegree) << r;
    EXPECT_LT(std::abs(error(2)), 0.0552 * kRadiansPerDegree) << r;  // 3 σ of the bound
    EXPECT_LT(std::abs(error(3)), 0.0552 * kRadiansPerDegree) << r;
    nees += error.cwiseAbs2().cwiseQuotient(bench.filter->covariance(r).diagonal()) / 4.0;
  }
  EXPECT_LT(nees.tail<3>().mean(), 2.2);
  EXPECT_GT(nees.tail<3>().mean(), 0.3);
}

TEST(PlanarFilter, AgreesWithADenseBatchOfTheSameDetections) {
  // Gauss–Newton over all detections at once, k_v and twelve angles, without correction for the noise of angles, which
  // is almost zero here.
  simulator::AlignmentSpec spec = published_drive(12.0, 8);
  for (simulator::AlignmentRadar& radar : spec.radars) {
    radar.config.noise.azimuth_std_rad = radar.config.noise.elevation_std_rad = 1e-5;
    radar.config.noise.range_rate_std_mps = 0.05;
  }
  struct Detection {
    std::size_t radar;
    double speed, yaw_rate, azimuth, elevation, range_rate;
  };
  std::vector<Detection> all;
  PlanarBench bench(spec);
  bench.run([&](const simulator::AlignmentEvent& event) {
    for (std::size_t i = 0; i < bench.scan->count; ++i) {
      all.push_back({event.radar, bench.ego.speed_mps, bench.ego.yaw_rate_radps, bench.scan->azimuth_rad[i],
                     bench.scan->elevation_rad[i], bench.scan->range_rate_mps[i]});
    }
  });
  Eigen::VectorXd x = Eigen::VectorXd::Zero(13);
  x(0) = 1.0;
  Eigen::MatrixXd information;
  for (int pass = 0; pass < 8; ++pass) {
    information = Eigen::MatrixXd::Zero(13, 13);
    Eigen::VectorXd score = Eigen::VectorXd::Zero(13);
    for (const Detection& d : all) {
      Parameters at;
      at << x(0), 0.0, x.segment<3>(1 + 3 * static_cast<Eigen::Index>(d.radar));
      const Row row =
          row_of({spec.radars[d.radar].config.mounting_pose, d.speed, d.yaw_rate}, at, d.azimuth, d.elevation);
      Eigen::VectorXd g = Eigen::VectorXd::Zero(13);
      g(0) = row.gradient(0);
      g.segment<3>(1 + 3 * static_cast<Eigen::Index>(d.radar)) = row.gradient.tail<3>();
      information += g * g.transpose() / 0.0025;
      score += g * (d.range_rate - row.value_mps) / 0.0025;
    }
    x += information.ldlt().solve(score);
  }
  const Eigen::MatrixXd covariance = information.inverse();
  for (std::size_t r = 0; r < 4; ++r) {
    for (Eigen::Index i = 0; i < 4; ++i) {
      const Eigen::Index at = i == 0 ? 0 : 3 * static_cast<Eigen::Index>(r) + i;
      const double std = std::sqrt(covariance(at, at));
      // The start loses the information of most of a second and a half of twelve; Tukey's weights lose some more.
      EXPECT_NEAR(bench.filter->parameters(r)(i), x(at), 1.0 * std) << r << ' ' << i;
      EXPECT_NEAR(std::sqrt(bench.filter->covariance(r)(i, i)), std, 0.15 * std) << r << ' ' << i;
    }
  }
}

TEST(PlanarFilter, ConvergesWithHalfOfTheDetectionsMoving) {
  simulator::AlignmentSpec spec = published_drive(40.0, 9);
  spec.outlier_share = 0.5;
  PlanarBench bench(spec);
  bench.run();
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_LT(std::abs(bench.error(r)(1)), 0.02 * kRadiansPerDegree) << r;
    EXPECT_LT(bench.error(r).tail<2>().cwiseAbs().maxCoeff(), 0.25 * kRadiansPerDegree) << r;
  }
}

TEST(PlanarFilter, WithoutElevationPitchAndRollAreNotObservable) {
  for (const bool measured : {true, false}) {
    simulator::AlignmentSpec spec = published_drive(30.0, 10);
    // All reflectors at one elevation: the noise of a measured elevation must not count as spread.
    spec.elevation = simulator::ElevationKind::kZero;
    for (simulator::AlignmentRadar& radar : spec.radars) {
      radar.measures_elevation = measured;
      radar.truth.pitch_rad = radar.truth.roll_rad = 0.0;
    }
    PlanarBench bench(spec);
    bench.run();
    for (std::size_t r = 0; r < 4; ++r) {
      const RadarEstimate estimate = bench.filter->estimate(r);
      EXPECT_EQ(estimate.observable & kVehiclePitchAndRoll, 0u) << r << ' ' << measured;
      EXPECT_NE(estimate.observable & alignment_axis::kVehicleYaw, 0u) << r;
      EXPECT_LT(std::abs(bench.error(r)(1)), 0.05 * kRadiansPerDegree) << r << ' ' << measured;
    }
  }
}

TEST(PlanarFilter, IgnoresAStandstillAndInvalidScans) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const int kind : {0, 1, 2, 3}) {
    PlanarBench bench(published_drive(4.0, 11));
    bench.run([&](const simulator::AlignmentEvent&) {
      if (kind == 0) bench.ego.speed_mps = 0.0;
      if (kind == 1) bench.ego.speed_mps = kNan;
      if (kind == 2) bench.ego.stale = true;
      if (kind == 3) bench.scan->range_rate_mps.fill(kNan);
    });
    for (std::size_t r = 0; r < 4; ++r) {
      const RadarEstimate estimate = bench.filter->estimate(r);
      EXPECT_EQ(estimate.state, AlignmentState::kWaiting) << kind;
      EXPECT_EQ(estimate.observable, 0u) << kind;
      EXPECT_EQ(bench.filter->parameters(r), Eigen::Vector4d(1.0, 0.0, 0.0, 0.0)) << kind;
    }
    EXPECT_EQ(bench.filter->estimate(4).state, AlignmentState::kNoData);
  }
}

TEST(PlanarFilter, AllocatesNothing) {
  PlanarBench bench(published_drive(5.0, 12));
  std::vector<double> predicted(kMaxDetections);
  std::uint64_t allocations = 0;
  bench.run([&](const simulator::AlignmentEvent& e) {
    const std::uint64_t before = runtime::counted_allocations();
    {
      const runtime::CountAllocations count;
      bench.filter->process(e.radar, *bench.scan, bench.ego);
      bench.filter->predict(e.radar, *bench.scan, bench.ego, predicted);
      static_cast<void>(bench.filter->estimate(e.radar));
    }
    allocations += runtime::counted_allocations() - before;
    bench.scan->count = 0;  // the bench itself passes an empty scan
  });
  EXPECT_EQ(allocations, 0u);
  EXPECT_NE(bench.filter->estimate(0).observable & alignment_axis::kVehicleYaw, 0u);
}

}  // namespace
}  // namespace boresight::alignment::planar
