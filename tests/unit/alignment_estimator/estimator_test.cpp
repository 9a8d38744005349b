#include "services/alignment_estimator/core/estimator.hpp"

#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/alignment_estimator/synthetic.hpp"

namespace boresight::alignment {
namespace {

EgoMotion motion(std::int64_t time_ns, const EgoSample& ego) {
  EgoMotion m{};
  m.header.measurement_time_ns = time_ns;
  m.fields = ego_field::kSpeed | ego_field::kYawRate;
  m.speed_mps = static_cast<float>(ego.speed_mps);
  m.speed_std_mps = static_cast<float>(ego.speed_std_mps);
  m.yaw_rate_radps = static_cast<float>(ego.yaw_rate_radps);
  m.yaw_rate_std_radps = static_cast<float>(ego.yaw_rate_std_radps);
  return m;
}

AlignmentEstimate written(const Estimator& estimator, std::uint32_t radar) {
  AlignmentEstimate out{};
  EXPECT_TRUE(estimator.write(radar, out));
  return out;
}

VehicleConfig car(const SyntheticDrive& left, const SyntheticDrive& right) {
  VehicleConfig vehicle;
  vehicle.radars.push_back(left.radar());
  vehicle.radars.push_back(right.radar());
  vehicle.radars.back().id = 2;
  return vehicle;
}

TEST(Estimator, EachRadarHasItsOwnEstimate) {
  SyntheticDrive left, right;
  left.yaw_rad = 2.0 * kRadiansPerDegree;
  right.yaw_rad = -1.0 * kRadiansPerDegree;
  right.mount_yaw_rad = -135.0 * kRadiansPerDegree;
  Estimator estimator(car(left, right), Config{});
  Synthesizer a(left, 1), b(right, 2);
  for (int i = 0; i < 300; ++i) {
    a.next();
    b.next();
    estimator.add_ego_motion(motion(a.scan->header.measurement_time_ns, a.ego));
    b.scan->header.source_id = 2;
    static_cast<void>(estimator.add_scan(*a.scan));
    static_cast<void>(estimator.add_scan(*b.scan));
  }
  EXPECT_NEAR(written(estimator, 1).alignment_yaw_rad, left.yaw_rad, 0.03 * kRadiansPerDegree);
  EXPECT_NEAR(written(estimator, 2).alignment_yaw_rad, right.yaw_rad, 0.03 * kRadiansPerDegree);
  AlignmentEstimate out{};
  EXPECT_FALSE(estimator.write(3, out));
}

TEST(Estimator, LearnsNothingFromAScanThatIsProvenWrong) {
  for (const std::uint16_t fault : {scan_integrity::kRepeated, scan_integrity::kFrozen, scan_integrity::kContradictsEgo,
                                    scan_integrity::kImpossibleCopies}) {
    SyntheticDrive left, right;
    Estimator estimator(car(left, right), Config{});
    Synthesizer a(left, 1);
    AlignmentEstimate before{};
    for (int i = 0; i < 400; ++i) {
      a.next();
      estimator.add_ego_motion(motion(a.scan->header.measurement_time_ns, a.ego));
      if (i == 200) before = written(estimator, 1);
      if (i >= 200) {
        a.scan->integrity = fault;
        for (std::size_t k = 0; k < a.scan->number_of_valid_detections; ++k) a.scan->azimuth_rad[k] += 0.05F;
      }
      static_cast<void>(estimator.add_scan(*a.scan));
    }
    const AlignmentEstimate after = written(estimator, 1);
    EXPECT_EQ(after.kpis.scans_used, before.kpis.scans_used) << fault;
    EXPECT_EQ(after.alignment_yaw_rad, before.alignment_yaw_rad) << fault;
    EXPECT_EQ(after.covariance, before.covariance) << fault;
  }
}

TEST(Estimator, StatesTheNeesWhereTheTruthIsKnown) {
  SyntheticDrive left, right;
  left.yaw_rad = 2.0 * kRadiansPerDegree;
  right.mount_yaw_rad = -135.0 * kRadiansPerDegree;
  Config config, wrong;
  config.truth.emplace();
  config.truth->speed_scale = left.speed_scale;
  config.truth->radars[1] = {left.yaw_rad, 0.0, 0.0, {}};
  config.truth->radars[2].yaw_rad = right.yaw_rad;  // without pitch and roll
  wrong.truth = config.truth;
  wrong.truth->radars[1].yaw_rad = 1.0 * kRadiansPerDegree;
  Estimator estimator(car(left, right), config), deceived(car(left, right), wrong), unknowing(car(left, right), {});
  Synthesizer a(left, 1), b(right, 2);
  double sum = 0.0;
  for (int i = 0; i < 300; ++i) {
    a.next();
    b.next();
    b.scan->header.source_id = 2;
    for (Estimator* e : {&estimator, &deceived, &unknowing}) {
      e->add_ego_motion(motion(a.scan->header.measurement_time_ns, a.ego));
      static_cast<void>(e->add_scan(*a.scan));
      static_cast<void>(e->add_scan(*b.scan));
    }
    if (i == 0) {
      EXPECT_TRUE(std::isnan(written(estimator, 1).kpis.nees)) << "nothing is observable yet";
    }
    if (i >= 100) sum += written(estimator, 1).kpis.nees / 200.0;
  }
  EXPECT_GT(sum, 0.005);
  EXPECT_LT(sum, 4.0) << "one drive has only a few independent errors";
  EXPECT_GT(written(deceived, 1).kpis.nees, 10.0F);
  EXPECT_TRUE(std::isnan(written(estimator, 2).kpis.nees));
  EXPECT_TRUE(std::isnan(written(unknowing, 1).kpis.nees));
}

TEST(Estimator, PublishesByTheMeasurementClock) {
  const SyntheticDrive drive;
  Estimator estimator(car(drive, drive), Config{});
  Synthesizer synthesizer(drive, 3);
  std::vector<int> published;
  for (int i = 0; i < 41; ++i) {
    synthesizer.next();
    estimator.add_ego_motion(motion(synthesizer.scan->header.measurement_time_ns, synthesizer.ego));
    if (estimator.add_scan(*synthesizer.scan) == ScanResult::kPublish) published.push_back(i);
  }
  EXPECT_EQ(published, (std::vector<int>{0, 4, 8, 12, 16, 20, 24, 28, 32, 36, 40})) << "every 0.2 s of 0.05 s";
  // A recording that restarts.
  synthesizer.scan->header.measurement_time_ns = 1'000'000'000;
  EXPECT_EQ(estimator.add_scan(*synthesizer.scan), ScanResult::kPublish);
}

TEST(Estimator, ReportsScansThatItCannotUse) {
  const SyntheticDrive drive;
  Estimator estimator(car(drive, drive), Config{});
  Synthesizer synthesizer(drive, 4);
  synthesizer.next();
  RadarScan& scan = *synthesizer.scan;
  EXPECT_EQ(estimator.add_scan(scan), ScanResult::kPublish) << "the waiting state, even without ego motion";
  scan.header.measurement_time_ns += 50'000'000;
  EXPECT_EQ(estimator.add_scan(scan), ScanResult::kNoEgoMotion);
  EXPECT_EQ(written(estimator, 1).state, AlignmentState::kWaiting);
  EgoMotion bad = motion(scan.header.measurement_time_ns, synthesizer.ego);
  bad.speed_mps = std::numeric_limits<float>::quiet_NaN();
  estimator.add_ego_motion(bad);
  scan.header.measurement_time_ns += 50'000'000;
  EXPECT_EQ(estimator.add_scan(scan), ScanResult::kNoEgoMotion) << "a speed that is not a number";
  estimator.add_ego_motion(motion(scan.header.measurement_time_ns, synthesizer.ego));
  scan.header.measurement_time_ns += 30'000'000;
  EXPECT_EQ(estimator.add_scan(scan), ScanResult::kUsed);
  scan.header.source_id = 77;
  EXPECT_EQ(estimator.add_scan(scan), ScanResult::kUnknownRadar);
}

TEST(Estimator, WrongLengthsAndInvalidNumbersDoNoHarm) {
  const SyntheticDrive drive;
  Estimator estimator(car(drive, drive), Config{});
  Synthesizer synthesizer(drive, 5);
  const float huge = std::numeric_limits<float>::max();
  for (int i = 0; i < 300; ++i) {
    synthesizer.next();
    RadarScan& scan = *synthesizer.scan;
    EgoSample ego = synthesizer.ego;
    if (i % 10 == 3) ego.speed_mps = 1e6;
    if (i % 10 == 5) ego.speed_std_mps = std::numeric_limits<double>::quiet_NaN();
    if (i % 10 == 6) ego.yaw_rate_radps = 1e9;
    estimator.add_ego_motion(motion(scan.header.measurement_time_ns, ego));
    scan.range_rate_mps[0] = huge;
    scan.range_rate_mps[1] = -huge;
    scan.azimuth_rad[2] = huge;
    // Stale rows follow the valid ones; a count beyond the capacity must not be used.
    if (i % 10 == 7) scan.number_of_valid_detections = 0xFFFFFFFF;
    static_cast<void>(estimator.add_scan(scan));
    const RadarEstimate radar = estimator.estimate(0);
    ASSERT_TRUE(radar.sensor_to_vehicle.allFinite() && std::isfinite(radar.speed_scale)) << i;
    ASSERT_TRUE(radar.covariance.allFinite()) << i;
  }
  EXPECT_NEAR(written(estimator, 1).alignment_yaw_rad, drive.yaw_rad, 0.1 * kRadiansPerDegree);
  EXPECT_NEAR(written(estimator, 1).speed_scale, drive.speed_scale, 2e-3);
}

TEST(Estimator, EveryMethodByItsNameRunsWithKeyFiguresAndAllocatesNothing) {
  SyntheticDrive drive;
  drive.elevation_limit_rad = 0.15;
  for (const auto& [name, method] : kMethodNames) {
    Config config;
    config.method = method;
    config.truth = DriveTruth{.speed_scale = drive.speed_scale, .radars = {{1, {drive.yaw_rad, 0.0, 0.0, {}}}}};
    Estimator estimator(car(drive, drive), config);
    Synthesizer synthesizer(drive, 7);
    AlignmentEstimate out{};
    for (int i = 0; i < 1300; ++i) {
      synthesizer.next();
      const EgoMotion ego = motion(synthesizer.scan->header.measurement_time_ns, synthesizer.ego);
      const std::uint64_t before = runtime::counted_allocations();
      {
        const runtime::CountAllocations counting;
        estimator.add_ego_motion(ego);
        static_cast<void>(estimator.add_scan(*synthesizer.scan));
        ASSERT_TRUE(estimator.write(1, out));
      }
      ASSERT_EQ(runtime::counted_allocations(), before) << name;
    }
    EXPECT_GE(out.state, AlignmentState::kConverging) << name;
    EXPECT_GT(out.kpis.scans_used, 1000u) << name;
    EXPECT_GT(out.kpis.residual_rmse_mps, 0.0F) << name;
    EXPECT_LT(out.kpis.residual_rmse_mps, 1.01F * out.kpis.uncorrected_residual_rmse_mps) << name;
    EXPECT_GT(out.kpis.inlier_ratio, 0.3F) << name;  // even of the method that does not converge on this drive
    EXPECT_LT(out.kpis.inlier_ratio, 0.9F) << name;
    if (method == MethodName::kBoresight) {
      EXPECT_NEAR(out.kpis.inlier_ratio, 0.8F, 0.05F);
      EXPECT_LT(out.kpis.seconds_to_95_percent[1], 2.0F);
      EXPECT_GT(out.kpis.seconds_to_95_percent[1], 0.2F);
    }
    EXPECT_FALSE(std::isnan(out.kpis.drift_per_minute[1])) << name;
    EXPECT_NE(std::isnan(out.kpis.nees), (out.observable & 0x71) != 0) << name;
    std::printf("%-17.*s yaw %+.3f° ± %.3f°, k_v %.4f, 95 %% after %.1f s, RMSE %.3f of %.3f m/s, NEES %.2f\n",
                static_cast<int>(name.size()), name.data(), out.vehicle_yaw_rad / kRadiansPerDegree,
                std::sqrt(out.vehicle_covariance[5]) / kRadiansPerDegree, out.speed_scale,
                out.kpis.seconds_to_95_percent[1], out.kpis.residual_rmse_mps, out.kpis.uncorrected_residual_rmse_mps,
                out.kpis.nees);
    ASSERT_TRUE(estimator.write(2, out));
    EXPECT_TRUE(std::isnan(out.kpis.nees)) << "no NEES without truth";
  }
}

TEST(Estimator, AllocatesNothing) {
  const SyntheticDrive drive;
  Estimator estimator(car(drive, drive), Config{});
  Synthesizer synthesizer(drive, 6);
  AlignmentEstimate out{};
  for (int i = 0; i < 100; ++i) {
    synthesizer.next();
    const EgoMotion ego = motion(synthesizer.scan->header.measurement_time_ns, synthesizer.ego);
    const std::uint64_t before = runtime::counted_allocations();
    {
      const runtime::CountAllocations counting;
      estimator.add_ego_motion(ego);
      static_cast<void>(estimator.add_scan(*synthesizer.scan));
      static_cast<void>(estimator.write(1, out));
    }
    ASSERT_EQ(runtime::counted_allocations(), before);
  }
}

}  // namespace
}  // namespace boresight::alignment
