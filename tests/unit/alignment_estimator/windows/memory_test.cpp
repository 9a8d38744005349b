// Memory over restarts: nothing is known better because the service was restarted.
#include <limits>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tests/unit/alignment_estimator/windows/windows_bench.hpp"

namespace boresight::alignment::windows {
namespace {

constexpr auto kOwn = static_cast<Eigen::Index>(Memory::kOwn);
using Matrix = Eigen::Matrix<double, kOwn, kOwn, Eigen::RowMajor>;

std::unique_ptr<Memory> memory_of(const WindowedFilter& filter) {
  auto memory = std::make_unique<Memory>();
  filter.save(*memory);
  return memory;
}

Matrix covariance_of(const Memory::Radar& radar) {
  return Eigen::Map<const Matrix>(radar.covariance.data());
}

constexpr double kNextDrive = std::numeric_limits<double>::infinity();
constexpr double kRestart_s = 0.5;

/// A filter that begins with this memory.
std::unique_ptr<WindowedFilter> continued(const WindowsBench& bench, const Memory& memory, double away_s = kNextDrive) {
  auto filter = std::make_unique<WindowedFilter>(bench.vehicle, FilterConfig{}, bench.config);
  filter->restore(memory, away_s);
  return filter;
}

TEST(WindowsMemory, RestoresEveryValue) {
  WindowsBench bench(aligned_real_car(3, 60.0));
  bench.run(60.0);
  const auto memory = memory_of(*bench.filter);
  const auto other = continued(bench, *memory);
  const auto again = memory_of(*other);
  ASSERT_EQ(again->number_of_radars, 4u);
  EXPECT_EQ(again->speed_scale, memory->speed_scale);
  EXPECT_EQ(again->yaw_rate_bias_radps, memory->yaw_rate_bias_radps);
  EXPECT_EQ(again->yaw_rate_gain, memory->yaw_rate_gain);
  EXPECT_EQ(again->slip_coefficient_radps2pm, memory->slip_coefficient_radps2pm);
  EXPECT_EQ(again->pitch_per_acceleration_radps2pm, memory->pitch_per_acceleration_radps2pm);
  EXPECT_EQ(again->time_offset_s, memory->time_offset_s);
  EXPECT_EQ(again->load_pitch_rad, memory->load_pitch_rad);
  for (std::size_t k = 0; k < windows::kFluctuations; ++k) {
    EXPECT_GE(again->fluctuation_variance[k], (1.0 - 1e-12) * memory->fluctuation_variance[k]);
  }
  EXPECT_EQ(again->correlation_s, memory->correlation_s);
  EXPECT_NE(memory->time_offset_s, 0.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const Memory::Radar &a = memory->radars[r], &b = again->radars[r];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.has_elevation, b.has_elevation);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a.rotation_vehicle_rad[i], b.rotation_vehicle_rad[i], 1e-12);
    EXPECT_EQ(a.range_rate_scale, b.range_rate_scale);
    EXPECT_EQ(a.time_offset_s, b.time_offset_s);
    EXPECT_EQ(a.position_error_m, b.position_error_m);
    EXPECT_EQ(a.azimuth_curve_rad, b.azimuth_curve_rad);
    EXPECT_EQ(a.height_excess, b.height_excess);
    EXPECT_EQ(a.mirror_share, b.mirror_share);
    for (std::size_t k = 0; k < windows::kFluctuations; ++k) {
      EXPECT_GE(b.fluctuation_variance[k], (1.0 - 1e-12) * a.fluctuation_variance[k]) << "a memory only enlarges it";
    }
    EXPECT_EQ(a.seconds_of_drive, b.seconds_of_drive);
    EXPECT_NEAR(a.angle_noise_scale, b.angle_noise_scale, 1e-12);
    EXPECT_NEAR(a.range_rate_noise_scale, b.range_rate_noise_scale, 1e-12);
    EXPECT_NE(a.azimuth_curve_rad[3], 0.0);
    EXPECT_GT(a.seconds_of_drive, 50.0);
    const RadarEstimate before = bench.filter->estimate(r), after = other->estimate(r);
    EXPECT_NEAR(before.speed_scale, after.speed_scale, 1e-4) << "but for the excess of heights";
    EXPECT_NE(after.observable & alignment_axis::kVehicleYaw, 0u) << "a remembered yaw is usable at once";
    EXPECT_EQ(after.state, AlignmentState::kNoData);
  }
}

TEST(WindowsMemory, KeepsHowMuchQuieterARadarIsThanItStates) {
  constexpr double kTooWide = 2.5;
  WindowsBench bench(corner_drive(11, 60.0));
  bench.run(60.0, [&](const simulator::AlignmentEvent& event) {
    for (std::size_t i = 0; i < bench.scan->count; ++i) bench.scan->range_rate_std_mps[i] *= kTooWide;
    bench.filter->process(event.radar, *bench.scan, bench.ego);
  });
  const auto again = continued(bench, *memory_of(*bench.filter));
  for (std::size_t r = 0; r < 4; ++r) {
    const float learnt = bench.filter->estimate(r).nuisance.range_rate_noise_scale;
    EXPECT_NEAR(learnt, 1.0 / kTooWide, 0.05) << r;
    EXPECT_FLOAT_EQ(again->estimate(r).nuisance.range_rate_noise_scale, learnt) << "before any scan";
  }
}

TEST(WindowsMemory, WrittenAgainWithoutDataItClaimsNoMore) {
  WindowsBench bench(aligned_real_car(4, 60.0));
  for (const double until_s : {5.0, 20.0, 60.0}) {
    bench.run(until_s);
    auto memory = memory_of(*bench.filter);
    for (int restart = 0; restart < 40; ++restart) {
      auto again = memory_of(*continued(bench, *memory));
      for (std::size_t k = 0; k < Memory::kShared; ++k) {
        EXPECT_GE(again->variance(k, k), memory->variance(k, k) * (1.0 - 1e-9)) << k;
      }
      for (std::size_t r = 0; r < 4; ++r) {
        const Matrix more = covariance_of(again->radars[r]) - covariance_of(memory->radars[r]);
        const Matrix before = covariance_of(memory->radars[r]);
        const Eigen::Matrix<double, kOwn, 1> scale = before.diagonal().cwiseSqrt().cwiseInverse();
        const Eigen::Matrix<double, kOwn, kOwn> relative = scale.asDiagonal() * more * scale.asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kOwn, kOwn>> eigen(relative);
        EXPECT_GT(eigen.eigenvalues()(0), -1e-9) << "after " << until_s << " s, restart " << restart;
      }
      memory = std::move(again);
    }
    // Not more doubt than before any data.
    const Priors priors;
    for (std::size_t r = 0; r < 4; ++r) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_LE(std::sqrt(memory->radars[r].rotation_variance(axis, axis)), priors.rotation_std_rad * (1.0 + 1e-9));
      }
      EXPECT_LE(std::sqrt(memory->radars[r].variance(own::kRateScale, own::kRateScale)),
                priors.rate_scale_std * (1.0 + 1e-9));
    }
  }
}

/// A memory without correlations claims nothing that the joint covariance does not: its block-diagonal covariance less
/// the joint one is positive semidefinite.
TEST(WindowsMemory, LostCorrelationsAddNoInformation) {
  WindowsBench bench(aligned_real_car(5, 60.0));
  bench.run(60.0);
  const auto memory = memory_of(*bench.filter);
  const Solver& solver = bench.filter->solver();
  constexpr Eigen::Index kShared = shared::kConstants, kAll = kShared + 4 * kOwn;
  Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(kAll, kAll), kept = joint;
  const SharedMatrix& constants = solver.shared_covariance();
  joint.topLeftCorner(kShared, kShared) = constants;
  kept.topLeftCorner(kShared, kShared) =
      Eigen::Map<const Eigen::Matrix<double, kShared, kShared, Eigen::RowMajor>>(memory->covariance.data());
  // Radars are correlated by way of the constants.
  const SharedMatrix inverse = constants.inverse();
  for (std::size_t r = 0; r < 4; ++r) {
    const Eigen::Index first = kShared + static_cast<Eigen::Index>(r) * kOwn;
    const Eigen::MatrixXd with = solver.radar(r).with_shared.topRows(kOwn);
    joint.block(first, 0, kOwn, kShared) = with;
    joint.block(0, first, kShared, kOwn) = with.transpose();
    kept.block(first, first, kOwn, kOwn) = covariance_of(memory->radars[r]);
    for (std::size_t q = 0; q < 4; ++q) {
      const Eigen::Index other = kShared + static_cast<Eigen::Index>(q) * kOwn;
      joint.block(first, other, kOwn, kOwn) =
          r == q ? Eigen::MatrixXd(solver.radar(r).covariance.topLeftCorner(kOwn, kOwn))
                 : Eigen::MatrixXd(with * inverse * solver.radar(q).with_shared.topRows(kOwn).transpose());
    }
  }
  // Rotations, scales and constants: what a verdict depends on; no prior limits these here.
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 1; i < kShared; ++i) rows.push_back(i);
  for (Eigen::Index r = 0; r < 4; ++r) {
    for (const Eigen::Index axis : {1, 2}) rows.push_back(kShared + r * kOwn + own::kRotation + axis);
  }
  const Eigen::MatrixXd less = joint(rows, rows), more = kept(rows, rows);
  const Eigen::VectorXd scale = less.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd relative = scale.asDiagonal() * (more - less) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(relative);
  EXPECT_GT(eigen.eigenvalues()(0), -1e-6);
}

class WindowsMemoryRestarts : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Away, WindowsMemoryRestarts, testing::Values(kRestart_s, kNextDrive));

TEST_P(WindowsMemoryRestarts, ThirtyInADriveLeaveTheEstimateHonest) {
  double squares = 0.0, count = 0.0;
  for (const std::uint64_t seed : {11u, 12u, 13u, 14u}) {
    WindowsBench bench(aligned_real_car(seed, 190.0));
    auto restarted = std::make_unique<WindowedFilter>(bench.vehicle, FilterConfig{});
    for (int restart = 0; restart < 30; ++restart) {
      bench.run(6.0 * (restart + 1), [&](const simulator::AlignmentEvent& event) {
        bench.filter->process(event.radar, *bench.scan, bench.ego);
        restarted->process(event.radar, *bench.scan, bench.ego);
      });
      for (std::size_t r = 0; r < 4; ++r) {
        const RadarEstimate whole = bench.filter->estimate(r), parts = restarted->estimate(r);
        const Eigen::Vector3d error = bench.error_rad(*restarted, r);
        EXPECT_EQ(parts.step_change.count, 0u) << r;
        for (int axis = 1; axis < 3; ++axis) {
          // Lives of six seconds learn less of slow fluctuations than one of minutes: their σ may stay below.
          EXPECT_GT(std_of(parts, axis + 1), 0.35 * std_of(whole, axis + 1)) << r << ' ' << axis << ' ' << restart;
          squares += std::pow(error(axis), 2) / parts.covariance(axis + 1, axis + 1);
          count += 1.0;
        }
        EXPECT_GT(std_of(parts, 0), 0.98 * std_of(whole, 0)) << r << ' ' << restart;
      }
      restarted = continued(bench, *memory_of(*restarted), GetParam());
    }
  }
  EXPECT_LE(squares / count, 3.0);
}

TEST(WindowsMemory, RestartsOfTheServiceCostNoKnowledge) {
  WindowsBench bench(aligned_real_car(21, 200.0));
  bench.run(80.0);
  const auto before = memory_of(*bench.filter);
  // Lives from less than it takes to begin to a quarter of a minute.
  for (const double life_s : {0.3, 2.0, 5.0, 0.1, 15.0, 1.0, 9.0, 4.0, 14.0, 3.0}) {
    bench.filter = continued(bench, *memory_of(*bench.filter), kRestart_s);
    bench.run(bench.time_s + life_s);
    const auto now = memory_of(*bench.filter);
    for (std::size_t r = 0; r < 4; ++r) {
      EXPECT_EQ(bench.filter->estimate(r).step_change.count, 0u) << r << ' ' << life_s;
      for (const std::size_t axis : {1u, 2u}) {
        const double std_rad = std::sqrt(before->radars[r].rotation_variance(axis, axis));
        EXPECT_LT(std::sqrt(now->radars[r].rotation_variance(axis, axis)), 1.1 * std_rad) << r << ' ' << axis;
        EXPECT_LT(std::abs(bench.error_rad(r)(static_cast<Eigen::Index>(axis))), 4.0 * std_rad) << r << ' ' << axis;
      }
      EXPECT_GE(now->radars[r].seconds_of_drive, before->radars[r].seconds_of_drive) << r;
    }
  }
}

TEST(WindowsMemory, TheDoubtGrowsWithTheTimeAway) {
  WindowsBench bench(aligned_real_car(22, 60.0));
  bench.run(60.0);
  const auto memory = memory_of(*bench.filter);
  const RestoreConfig doubts;
  const double variance = memory->radars[1].rotation_variance(2, 2);
  EXPECT_NEAR(memory_of(*continued(bench, *memory, 0.0))->radars[1].rotation_variance(2, 2), variance, 1e-9 * variance);
  double last = std_of(continued(bench, *memory, 0.0)->estimate(1), 3);
  for (const double away_s : {0.1 * doubts.doubt_s, doubts.doubt_s, 3.0 * doubts.doubt_s, kNextDrive}) {
    const double now = std_of(continued(bench, *memory, away_s)->estimate(1), 3);
    EXPECT_GT(now, last) << away_s;
    last = now;
  }
  EXPECT_GT(last, doubts.rotation_std_rad);
}

/// The first drive after a workshop turned a radar: what is learnt replaces the memory that was contradicted.
TEST(WindowsMemory, AContradictedMemoryIsReplacedOnceTheNewOneHasConverged) {
  WindowsBench bench(corner_drive(16, 60.0));
  bench.run(20.0);
  auto memory = memory_of(*bench.filter);
  memory->radars[1].rotation_vehicle_rad[2] += 3.0 * kRadiansPerDegree;
  bench.filter = continued(bench, *memory, kRestart_s);
  bench.run(20.3);
  EXPECT_NEAR(memory_of(*bench.filter)->radars[1].rotation_vehicle_rad[2], memory->radars[1].rotation_vehicle_rad[2],
              1e-12)
      << "less than it takes to begin";
  bench.run(60.0);
  EXPECT_NEAR(memory_of(*bench.filter)->radars[1].rotation_vehicle_rad[2],
              memory->radars[1].rotation_vehicle_rad[2] - 3.0 * kRadiansPerDegree, 0.2 * kRadiansPerDegree);
}

TEST(WindowsMemory, ARadarThatWasTurnedInTheWorkshopIsFoundAgain) {
  WindowsBench bench(corner_drive(6, 40.0));
  bench.run(20.0);
  auto memory = memory_of(*bench.filter);
  memory->radars[1].rotation_vehicle_rad[2] += 3.0 * kRadiansPerDegree;
  bench.filter = continued(bench, *memory);
  bench.run(40.0);
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_LT(std::abs(bench.error_rad(r).z()), 0.06 * kRadiansPerDegree) << r;
    EXPECT_EQ(bench.filter->estimate(r).step_change.count, 0u) << r;
  }
}

TEST(WindowsMemory, AChangeOfTheLoadWhileTheCarStoodIsNoMisalignment) {
  for (const double load_deg : {0.0, 0.8}) {
    simulator::AlignmentSpec spec = corner_drive(7, 120.0);
    spec.real_car.load_pitch_rad = load_deg * kRadiansPerDegree;
    spec.real_car.load_time_s = 60.0;
    WindowsBench bench(spec);
    bench.run(60.0);
    bench.filter = continued(bench, *memory_of(*bench.filter));
    bench.run(120.0);
    EXPECT_EQ(bench.filter->load_changes(), load_deg > 0.0 ? 1 : 0);
    for (std::size_t r = 0; r < 4; ++r) {
      EXPECT_LT(std::abs(bench.error_rad(r).y()), 0.1 * kRadiansPerDegree) << r << ' ' << load_deg;
      EXPECT_EQ(bench.filter->estimate(r).step_change.count, 0u) << r;
    }
  }
}

TEST(WindowsMemory, OtherRadarsAndBrokenValuesBeginFromTheNominalMounting) {
  WindowsBench bench(corner_drive(8, 20.0));
  bench.run(20.0);
  auto memory = memory_of(*bench.filter);
  memory->radars[0].id = 99;
  memory->radars[1].rotation_vehicle_rad[1] = std::numeric_limits<double>::quiet_NaN();
  memory->speed_scale = std::numeric_limits<double>::quiet_NaN();
  const auto other = continued(bench, *memory);
  const WindowedFilter fresh(bench.vehicle, FilterConfig{});
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(other->estimate(r).sensor_to_vehicle, fresh.estimate(r).sensor_to_vehicle);
    EXPECT_EQ(other->estimate(r).observable, 0u);
    EXPECT_NEAR(std_of(other->estimate(r), 3), bench.config.priors.rotation_std_rad, 1e-9);
  }
  EXPECT_NE(other->estimate(2).observable, 0u);
  EXPECT_NEAR(other->estimate(0).speed_scale, 1.0, 1e-12);
}

TEST(WindowsMemory, AStateThatIsSwitchedOffIsNotRestored) {
  WindowsBench bench(aligned_real_car(9, 40.0));
  bench.run(40.0);
  const auto memory = memory_of(*bench.filter);
  bench.config.priors.rate_scale_std = bench.config.priors.curve_std_rad = bench.config.priors.slip_std_radps2pm = 0.0;
  const auto other = continued(bench, *memory);
  const AlignmentNuisance& n = other->estimate(1).nuisance;
  EXPECT_EQ(n.range_rate_scale.value, 0.0F);
  EXPECT_EQ(n.azimuth_curve_rad[3], 0.0F);
  EXPECT_EQ(other->estimate(1).slip_coefficient_radps2pm, 0.0);
  // And one that was off is fresh when it is switched on again.
  const auto off = memory_of(*other);
  bench.config = {};
  const auto on = continued(bench, *off);
  EXPECT_NEAR(on->estimate(1).nuisance.range_rate_scale.std, bench.config.priors.rate_scale_std, 1e-6);
  EXPECT_NEAR(on->estimate(1).slip_coefficient_std_radps2pm, bench.config.priors.slip_std_radps2pm, 1e-6);
  bench.filter = continued(bench, *off);
  bench.run(60.0);
}

TEST(WindowsSeed, AStaticCalibrationReplacesTheRotation) {
  WindowsBench bench(corner_drive(10, 30.0));
  bench.run(10.0);
  const RadarEstimate before = bench.filter->estimate(2);
  const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(bench.vehicle.radars[1].mounting_pose, 0.0, 0.0, 0.0);
  const Eigen::Vector3d truth = geometry::so3_log(bench.drive.sensor_to_vehicle(1, 1.0) * nominal.transpose());
  const Eigen::Vector3d rotation = truth + Eigen::Vector3d(0.01, -0.02, 0.05);
  Eigen::Matrix3d covariance;
  covariance << 1e-4, 1e-6, 0.0, 1e-6, 4e-6, 5e-7, 0.0, 5e-7, 1e-6;
  ASSERT_TRUE(bench.filter->seed(1, rotation, covariance));
  const RadarEstimate seeded = bench.filter->estimate(1);
  EXPECT_LT((geometry::so3_log(seeded.sensor_to_vehicle * nominal.transpose()) - rotation).norm(), 1e-9);
  EXPECT_LT((seeded.covariance.bottomRightCorner<3, 3>() - covariance).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(seeded.seconds_of_drive, 0.0);
  EXPECT_NE(seeded.observable & alignment_axis::kVehicleYaw, 0u);
  EXPECT_EQ(bench.filter->estimate(2).sensor_to_vehicle, before.sensor_to_vehicle);
  // One that is wrong by far more than a drive shows is given up.
  bench.run(30.0);
  EXPECT_LT(std::abs(bench.error_rad(1).z()), 0.06 * kRadiansPerDegree);
  const auto memory = memory_of(*bench.filter);
  EXPECT_NEAR(memory->radars[1].rotation_vehicle_rad[2],
              geometry::so3_log(bench.filter->estimate(1).sensor_to_vehicle * nominal.transpose()).z(), 1e-3);
}

TEST(WindowsSeed, IsKeptByTheFirstSecondsOfDriving) {
  WindowsBench bench(corner_drive(13, 10.0));
  const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(bench.vehicle.radars[0].mounting_pose, 0.0, 0.0, 0.0);
  const Eigen::Vector3d truth = geometry::so3_log(bench.drive.sensor_to_vehicle(0, 1.0) * nominal.transpose());
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1e-6, 1e-7, 1e-7).asDiagonal();
  ASSERT_TRUE(bench.filter->seed(0, truth, covariance));
  bench.run(10.0);
  EXPECT_LT(bench.error_rad(0).norm(), 0.1 * kRadiansPerDegree) << "roll is known by the calibration only";
  EXPECT_LE(std_of(bench.filter->estimate(0), 1), 1.05e-3);
}

TEST(WindowsSeed, ImpossibleOnesAreRefused) {
  WindowsBench bench(corner_drive(14, 1.0));
  const RadarEstimate before = bench.filter->estimate(0);
  const Eigen::Matrix3d good = 1e-6 * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d bad = good;
  bad(0, 1) = bad(1, 0) = 1.0;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(bench.filter->seed(9, Eigen::Vector3d::Zero(), good));
  EXPECT_FALSE(bench.filter->seed(0, {nan, 0.0, 0.0}, good));
  EXPECT_FALSE(bench.filter->seed(0, {2.0, 0.0, 0.0}, good));
  EXPECT_FALSE(bench.filter->seed(0, Eigen::Vector3d::Zero(), bad));
  EXPECT_FALSE(bench.filter->seed(0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()));
  EXPECT_EQ(bench.filter->estimate(0).sensor_to_vehicle, before.sensor_to_vehicle);
}

}  // namespace
}  // namespace boresight::alignment::windows
