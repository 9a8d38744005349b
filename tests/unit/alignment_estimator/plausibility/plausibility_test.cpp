#include "services/alignment_estimator/core/plausibility/plausibility.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/alignment_estimator/plausibility/drives.hpp"

namespace boresight::alignment::plausibility {
namespace {

using simulator::RoadKind;

const char* name_of(Wrong wrong) {
  return kWrongNames[static_cast<std::size_t>(wrong)];
}

void expect_named(const Bench& bench, Wrong wrong) {
  for (std::size_t r = 0; r < bench.vehicle().radars.size(); ++r) {
    EXPECT_EQ(bench.wrong_s(r), 0.0) << name_of(wrong) << ", radar " << r << ", "
                                     << static_cast<int>(bench.worst().finding);
    if (r >= bench.affected()) continue;
    EXPECT_EQ(bench.finding(r).finding, expected(wrong)) << name_of(wrong) << ", radar " << r;
    EXPECT_LT(bench.found_s(r), 60.0) << name_of(wrong) << ", radar " << r;
  }
}

void expect_nothing(const Bench& bench, const std::string& what) {
  for (std::size_t r = 0; r < bench.vehicle().radars.size(); ++r) {
    EXPECT_EQ(bench.wrong_s(r), 0.0) << what << ", radar " << r << ", " << static_cast<int>(bench.worst().finding);
  }
}

// Turns tell swapped radars from mirrored azimuths. This drive has one in its first seconds.
TEST(Plausibility, EachWrongInputOfFourRadarsIsNamedAndNoOther) {
  for (const Wrong wrong : kAllWrong) {
    expect_named(*play(drive_of_real_car(RoadKind::kCity, 60.0, 9107), wrong), wrong);
  }
}

TEST(Plausibility, WrongInputsInAWorldOfMeasuredRadarsAreNamed) {
  for (const Wrong wrong : {Wrong::kSwapped, Wrong::kAzimuth, Wrong::kYawRate, Wrong::kYaw20, Wrong::kMph}) {
    expect_named(*play_world("demo_drive", "series_77ghz", 4102, 45.0, wrong), wrong);
  }
}

TEST(Plausibility, ValueSaysByHowMuch) {
  const auto spec = drive_of_real_car(RoadKind::kMixed, 40.0, 4103);
  // Actual − nominal: the vehicle file says too much.
  EXPECT_NEAR(play(spec, Wrong::kYaw20)->finding(0).value, -20.0 * kRadiansPerDegree, 4.0 * kRadiansPerDegree);
  EXPECT_NEAR(play(spec, Wrong::kYaw90)->finding(0).value, -90.0 * kRadiansPerDegree, 4.0 * kRadiansPerDegree);
  EXPECT_NEAR(play(spec, Wrong::kKmh)->finding(2).value, 3.6, 0.001);
  EXPECT_NEAR(play(spec, Wrong::kMph)->finding(2).value, 2.237, 0.001);
  EXPECT_NEAR(play(spec, Wrong::kDegrees)->finding(2).value, 57.3, 0.01);
}

TEST(Plausibility, OtherRadarIsNamed) {
  const auto spec = drive_of_real_car(RoadKind::kCity, 60.0, 9107);
  const auto swapped = play(spec, Wrong::kSwapped);
  EXPECT_EQ(swapped->finding(0).radar, spec.radars[1].config.id);
  EXPECT_EQ(swapped->finding(1).radar, spec.radars[0].config.id);
  EXPECT_EQ(play(spec, Wrong::kOtherRadar)->finding(0).radar, spec.radars[1].config.id);
}

TEST(Plausibility, SingleCornerRadarNamesAllThatNeedsNoOther) {
  auto spec = drive_of_real_car(RoadKind::kCity, 60.0, 9107);
  spec.radars.resize(1);
  for (const Wrong wrong : kAllWrong) {
    if (wrong != Wrong::kSwapped && wrong != Wrong::kOtherRadar) expect_named(*play(spec, wrong), wrong);
  }
}

TEST(Plausibility, FrontRadarCannotTellMirroredAzimuthFromMirroredYawRate) {
  const auto spec = front_radar_only(drive_of_real_car(RoadKind::kCity, 60.0, 9107));
  for (const Wrong wrong : {Wrong::kAzimuth, Wrong::kYawRate}) {
    EXPECT_EQ(play(spec, wrong)->finding(0).finding, AlignmentFinding::kAzimuthOrYawRate) << name_of(wrong);
  }
  for (const Wrong wrong : {Wrong::kYaw20, Wrong::kRangeRate, Wrong::kKmh, Wrong::kDegrees, Wrong::kFrozen,
                            Wrong::kZero, Wrong::kMissing, Wrong::kCopies}) {
    expect_named(*play(spec, wrong), wrong);
  }
}

TEST(Plausibility, FoldedRangeRatesWithoutElevationSuffice) {
  auto spec = drive_of_real_car(RoadKind::kMixed, 60.0, 4106);
  for (auto& radar : spec.radars) {
    radar.ambiguity_mps = 30.0;
    radar.measures_elevation = false;
  }
  for (const Wrong wrong : {Wrong::kNothing, Wrong::kYaw20, Wrong::kAllRangeRates, Wrong::kKmh, Wrong::kZero}) {
    expect_named(*play(spec, wrong), wrong);
  }
}

TEST(Plausibility, CorrectDrivesHaveNoFinding) {
  for (const RoadKind road : {RoadKind::kCity, RoadKind::kMotorway, RoadKind::kStraight, RoadKind::kSlow}) {
    expect_nothing(*play(drive_of_real_car(road, 60.0, 4107), Wrong::kNothing), simulator::name_of(road));
  }
  for (const char* scenario : {"parking_garage", "junction", "tunnel"}) {
    expect_nothing(*play_world(scenario, "series_77ghz", 4108, 15.0, Wrong::kNothing), scenario);
  }
}

TEST(Plausibility, MountingErrorOfFiveDegreesIsNoWrongInput) {
  auto spec = drive_of_real_car(RoadKind::kMixed, 60.0, 4109);
  for (std::size_t r = 0; r < spec.radars.size(); ++r) {
    spec.radars[r].truth.yaw_rad = (r % 2 == 0 ? 5.0 : -5.0) * kRadiansPerDegree;
  }
  expect_nothing(*play(spec, Wrong::kNothing), "5 deg");
}

TEST(Plausibility, ReverseWithoutSignOfTheSpeedIsNoWrongInput) {
  // All range rates with the other sign, as of a vehicle that reverses.
  auto spec = drive_of_real_car(RoadKind::kSlow, 60.0, 4110);
  simulator::AlignmentDrive drive(spec);
  Bench bench(drive.vehicle(), Wrong::kNothing);
  simulator::AlignmentEvent event;
  RadarScan scan;
  while (drive.next(event)) {
    if (event.speed_mps > 8.0) continue;
    if (event.ego != nullptr) bench.add(*event.ego, event.time_s);
    if (event.scan == nullptr) continue;
    scan = *event.scan;
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) scan.range_rate_mps[i] *= -1.0F;
    bench.add(event.radar, scan, event.time_s);
  }
  expect_nothing(bench, "reverse");
}

/// The vehicle stands; `passing` of the field of view is a vehicle that comes from ahead.
void stand(Bench& bench, double passing, bool has_motion) {
  std::mt19937 random(4111);
  std::uniform_real_distribution<float> share(0.0F, 1.0F), azimuth(-1.1F, 1.1F), noise(-0.05F, 0.05F);
  RadarScan scan{};
  for (int cycle = 0; cycle < 600; ++cycle) {
    const double time_s = 1.0 + 0.05 * cycle;
    EgoMotion motion{};
    motion.header.measurement_time_ns = scan.header.measurement_time_ns = static_cast<std::int64_t>(time_s * 1e9);
    motion.fields = ego_field::kSpeed | ego_field::kYawRate;
    if (has_motion) bench.add(motion, time_s);
    for (std::size_t r = 0; r < bench.vehicle().radars.size(); ++r) {
      const double yaw_rad = bench.vehicle().radars[r].mounting_pose.yaw_rad;
      scan.number_of_valid_detections = 40;
      for (std::size_t i = 0; i < 40; ++i) {
        scan.range_m[i] = 5.0F + 50.0F * share(random);
        scan.azimuth_rad[i] = azimuth(random);
        const bool is_passing = static_cast<double>(share(random)) < passing;
        const double along = std::cos(yaw_rad + static_cast<double>(scan.azimuth_rad[i]));
        scan.range_rate_mps[i] = noise(random) - (is_passing ? static_cast<float>(8.0 * along) : 0.0F);
      }
      bench.add(r, scan, time_s);
    }
  }
}

TEST(Plausibility, StandingInTrafficIsNoSpeedOfZero) {
  const VehicleConfig vehicle = simulator::AlignmentDrive(simulator::four_corner_radars()).vehicle();
  for (const double passing : {0.0, 0.4, 0.65}) {
    for (const bool has_motion : {true, false}) {
      Bench four(vehicle, Wrong::kNothing), one(vehicle, Wrong::kNothing);
      stand(four, passing, has_motion);
      expect_nothing(four, std::to_string(passing));
    }
  }
  // The same traffic without anything that stands still is motion of the vehicle.
  Bench moving(vehicle, Wrong::kNothing);
  stand(moving, 1.0, true);
  EXPECT_EQ(moving.finding(0).finding, AlignmentFinding::kSpeedZero);
}

TEST(Plausibility, FindingIsWithdrawnWhenTheInputIsRightAgain) {
  for (const Wrong wrong : {Wrong::kKmh, Wrong::kRangeRate, Wrong::kZero, Wrong::kMissing, Wrong::kCopies}) {
    simulator::AlignmentDrive drive(drive_of_real_car(RoadKind::kMixed, 80.0, 4112));
    Bench bench(drive.vehicle(), wrong);
    play(drive, bench, 25.0);
    EXPECT_EQ(bench.finding(0).finding, expected(wrong)) << name_of(wrong);
    bench.repair();
    play(drive, bench);
    EXPECT_EQ(bench.finding(0).finding, AlignmentFinding::kNone) << name_of(wrong);
  }
}

TEST(Plausibility, DisabledSearchFindsNothing) {
  simulator::AlignmentDrive drive(drive_of_real_car(RoadKind::kMixed, 30.0, 4113));
  PlausibilityConfig config;
  config.enabled = false;
  Bench bench(drive.vehicle(), Wrong::kKmh, config);
  play(drive, bench);
  EXPECT_EQ(bench.finding(0).finding, AlignmentFinding::kNone);
}

TEST(Plausibility, AllocatesNothing) {
  simulator::AlignmentDrive drive(drive_of_real_car(RoadKind::kMixed, 20.0, 4114));
  Bench bench(drive.vehicle(), Wrong::kOtherRadar);
  Plausibility plausibility(drive.vehicle(), {});
  std::uint64_t allocations = 0;
  bench.before = [&](std::size_t radar, const ScanDetections& scan, const EgoSample& ego) {
    const std::uint64_t before = runtime::counted_allocations();
    {
      const runtime::CountAllocations counting;
      plausibility.add(radar, scan, ego);
      static_cast<void>(plausibility.finding(radar));
    }
    allocations += runtime::counted_allocations() - before;
  };
  play(drive, bench);
  EXPECT_EQ(allocations, 0u);
  EXPECT_EQ(plausibility.finding(0).finding, AlignmentFinding::kOtherRadar);
}

TEST(Plausibility, EstimateWithAWrongInputIsNotConverged) {
  for (const bool is_wrong : {false, true}) {
    simulator::AlignmentDrive drive(drive_of_real_car(RoadKind::kMixed, 30.0, 4115));
    Estimator estimator(drive.vehicle(), {});
    simulator::AlignmentEvent event;
    while (drive.next(event)) {
      if (event.ego != nullptr) {
        EgoMotion motion = *event.ego;
        if (is_wrong) motion.speed_mps *= 3.6F;
        estimator.add_ego_motion(motion);
      }
      if (event.scan != nullptr) static_cast<void>(estimator.add_scan(*event.scan));
    }
    AlignmentEstimate out{};
    ASSERT_TRUE(estimator.write(drive.vehicle().radars[0].id, out));
    if (is_wrong) {
      EXPECT_EQ(out.finding, AlignmentFinding::kSpeedUnit);
      EXPECT_NEAR(out.finding_value, 3.6F, 0.01F);
      EXPECT_EQ(out.reason, AlignmentReason::kWrongInput);
      EXPECT_LE(out.state, AlignmentState::kConverging);
    } else {
      EXPECT_EQ(out.finding, AlignmentFinding::kNone);
      EXPECT_NE(out.reason, AlignmentReason::kWrongInput);
      EXPECT_EQ(out.state, AlignmentState::kConverged);
    }
  }
}

TEST(Plausibility, RejectedScansOfCopiesAreNamed) {
  RadarScan scan{};
  const VehicleConfig vehicle = simulator::AlignmentDrive(simulator::four_corner_radars()).vehicle();
  Estimator estimator(vehicle, {});
  scan.header.source_id = vehicle.radars[1].id;
  scan.number_of_valid_detections = 20;
  for (std::size_t i = 0; i < 20; ++i) {
    scan.range_m[i] = 20.0F;
    scan.range_rate_mps[i] = -7.0F;
  }
  for (int i = 0; i < 60; ++i) {
    scan.header.measurement_time_ns = 1'000'000'000 + i * 50'000'000LL;
    estimator.add_rejected_scan(scan);
  }
  EXPECT_EQ(estimator.finding(1).finding, AlignmentFinding::kCopiedDetections);
  EXPECT_EQ(estimator.finding(0).finding, AlignmentFinding::kNone);
}

}  // namespace
}  // namespace boresight::alignment::plausibility
