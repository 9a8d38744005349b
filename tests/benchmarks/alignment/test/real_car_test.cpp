// The arithmetic of the bars on a real car, and each of their groups on a few short drives.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "services/simulator/car/radar_of_car.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/axis_errors.hpp"
#include "tests/benchmarks/alignment/common/changes.hpp"
#include "tests/benchmarks/alignment/common/load.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/alignment/common/real_car_drives.hpp"
#include "tests/benchmarks/common/intervals.hpp"

namespace boresight::bench {
namespace {

using simulator::AlignmentSpec;

/// Reports k_v of the signal alone and the mounting on the body; and one sudden change of radar 1 after three scans.
class BodyOracle : public alignment::Method {
 public:
  explicit BodyOracle(const AlignmentSpec& spec) : spec_(spec), drive_(spec) {}
  void process(std::size_t radar, const alignment::ScanDetections&, const EgoSample&) override {
    if (radar == 1) ++scans_;
  }
  [[nodiscard]] alignment::RadarEstimate estimate(std::size_t radar) const override {
    alignment::RadarEstimate e;
    e.speed_scale = spec_.speed_scale;
    e.sensor_to_vehicle = drive_.sensor_to_vehicle(radar, 1.0);
    e.covariance.setIdentity();
    e.step_change.count = radar == 1 && scans_ >= 3 ? 1 : 0;
    return e;
  }
  void predict(std::size_t, const alignment::ScanDetections&, const EgoSample&, std::span<double>) const override {}

 private:
  AlignmentSpec spec_;
  simulator::AlignmentDrive drive_;
  int scans_ = 0;
};

Run run_oracle(const AlignmentSpec& spec, const RunOptions& options = {}) {
  return run_drive(
      spec, [&](const VehicleConfig&) { return std::make_unique<BodyOracle>(spec); }, options);
}

const RealCarKind& kind_named(const std::string& start) {
  const auto& kinds = real_car_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const RealCarKind& kind) { return kind.name.starts_with(start); });
  EXPECT_NE(found, kinds.end()) << start;
  return *found;
}

TEST(RunnerOnRealCar, TrueSpeedScaleIncludesTheScaleOfTheRadar) {
  const AlignmentSpec spec = drives_of(kind_named("range-rate scales"), 1, 2.0, 11).front();
  const auto run = run_oracle(spec);
  double largest = 0.0;
  for (std::size_t r = 0; r < spec.radars.size(); ++r) {
    const RadarConfig& radar = spec.radars[r].config;
    const double own =
        simulator::car::radar_of_car(spec.real_car, spec.seed, radar.id, radar.field_of_view).range_rate_scale - 1.0;
    EXPECT_NEAR(run.last().radars[r].error(kSpeedScale), -spec.speed_scale * own, 1e-12) << r;
    largest = std::max(largest, std::abs(own));
  }
  EXPECT_GT(largest, 1e-4);
}

TEST(RunnerOnRealCar, LoadIsNoPartOfTheTrueMounting) {
  AlignmentSpec spec = real_car_drive(simulator::RoadKind::kCity, 2.0, 12);
  spec.real_car.load_pitch_rad = 0.8 * kRadiansPerDegree;
  spec.real_car.load_time_s = 0.5;
  EXPECT_NEAR(run_oracle(spec).last().radars[0].error(kPitch), 0.0, 1e-9);
}

TEST(RunnerOnRealCar, FalseChangesAreCountedOnRequestOnly) {
  const AlignmentSpec spec = real_car_drive(simulator::RoadKind::kCity, 2.0, 13);
  EXPECT_TRUE(run_oracle(spec).step_changes.empty());
  RunOptions options;
  options.false_changes = true;
  const auto run = run_oracle(spec, options);
  ASSERT_EQ(run.step_changes.size(), 1u);
  EXPECT_EQ(run.step_changes[0].radar, 1u);
}

TEST(RealCarDrives, EachKindHasItsEffectAndSeedsOfItsOwn) {
  for (const RealCarKind& kind : real_car_kinds()) {
    const auto specs = drives_of(kind, 3, 10.0, 40);
    const bool has_body_pitch = specs[0].body_pitch_std_rad > 0.0;
    EXPECT_TRUE(has_body_pitch || !(specs[0].real_car == simulator::car::RealCar{})) << kind.name;
    EXPECT_NE(specs[0].road, specs[1].road) << kind.name;
    EXPECT_EQ(specs[2].seed, 42u) << kind.name;
  }
  // Load alone comes between 60 and 120 s; the whole car has none.
  const AlignmentSpec load = drives_of(kind_named("load"), 1, 10.0, 41).front();
  EXPECT_GE(std::abs(load.real_car.load_pitch_rad), 0.3 * kRadiansPerDegree);
  EXPECT_GE(load.real_car.load_time_s, 60.0);
  EXPECT_EQ(real_car_drive(simulator::RoadKind::kCity, 10.0, 41).real_car.load_pitch_rad, 0.0);
  EXPECT_GT(real_car_drive(simulator::RoadKind::kCity, 10.0, 41).body_pitch_per_acceleration_radps2pm, 0.0);
}

TEST(AxisErrors, FiguresAndIntervalsOfKnownErrors) {
  AxisErrors axis;
  for (int drive = 0; drive < 10; ++drive) {
    axis.begin_drive();
    axis.add(3.0, 1.0);
    axis.add(-1.0, 1.0);
  }
  EXPECT_DOUBLE_EQ(axis.rms(), std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(axis.nees(), 5.0);
  EXPECT_DOUBLE_EQ(axis.covered_percent(), 50.0);
  EXPECT_DOUBLE_EQ(axis.median_size(), 2.0);
  // All drives are alike: nothing is uncertain, though the errors in a drive differ.
  EXPECT_DOUBLE_EQ(axis.nees_interval().low, 5.0);
  EXPECT_DOUBLE_EQ(axis.nees_interval().high, 5.0);
  axis.begin_drive();
  axis.add(30.0, 1.0);
  axis.add(30.0, 1.0);
  EXPECT_DOUBLE_EQ(axis.nees_interval().low, 5.0);  // resamples without the last drive
  EXPECT_GT(axis.nees_interval().high, axis.nees());
}

TEST(AxisErrors, WorstAxisIsNamedAndRollCountsIfObservable) {
  Snapshot snapshot;
  snapshot.radars.resize(1);
  snapshot.radars[0].error << 0.1, 5.0, 2.0, 0.1;
  snapshot.radars[0].std.setOnes();
  DriveErrors without_roll, with_roll;
  without_roll.add_drive(snapshot);
  EXPECT_EQ(without_roll.least_consistent(), kPitch);
  EXPECT_EQ(without_roll.least_covered(), kPitch);
  EXPECT_EQ(without_roll.of(kRoll).count(), 0.0);
  snapshot.radars[0].observable = alignment_axis::kVehicleRoll;
  with_roll.add_drive(snapshot);
  EXPECT_EQ(with_roll.least_consistent(), kRoll);
  snapshot.radars[0].error(kSpeedScale) = std::nan("");
  DriveErrors broken;
  broken.add_drive(snapshot);
  EXPECT_EQ(broken.least_consistent(), kSpeedScale);
}

TEST(Intervals, PoissonMeansOfGarwood) {
  EXPECT_DOUBLE_EQ(poisson_interval(0).low, 0.0);
  EXPECT_NEAR(poisson_interval(0).high, 3.689, 0.001);
  EXPECT_NEAR(poisson_interval(3).low, 0.619, 0.001);
  EXPECT_NEAR(poisson_interval(3).high, 8.767, 0.001);
  EXPECT_NEAR(poisson_interval(100).high, 121.63, 0.01);
  // Nearly normal: ± 1.96 √count.
  EXPECT_NEAR(poisson_interval(2742).low, 2742.0 - 1.96 * std::sqrt(2742.0), 2.0);
  EXPECT_NEAR(poisson_interval(2742).high, 2742.0 + 1.96 * std::sqrt(2742.0), 2.0);
}

TEST(Intervals, ExponentOfAPower) {
  EXPECT_NEAR(exponent(10.0, 160.0, 16.0), 1.0, 1e-12);
  EXPECT_NEAR(exponent(10.0, 2560.0, 16.0), 2.0, 1e-12);
}

TEST(ChangeReports, DelayCountsFromTheChangeForTheRightRadar) {
  const std::vector<StepChangeSeen> seen = {{2, 50.0}, {1, 71.0}, {2, 74.5}, {2, 80.0}};
  const ChangeReports reports = reports_of_change(seen, 2, 70.0);
  EXPECT_DOUBLE_EQ(reports.delay_s, 4.5);
  EXPECT_EQ(reports.before, 1u);
  EXPECT_EQ(reports.other_radar, 1u);
  EXPECT_TRUE(std::isinf(reports_of_change(seen, 3, 70.0).delay_s));
}

TEST(LoadReports, FirstReportAfterTheLoadGivesItsDelay) {
  LoadReports reports;
  for (const auto& [changes, time_s] : {std::pair{0, 10.0}, {1, 20.0}, {1, 60.0}, {2, 81.0}, {3, 90.0}}) {
    reports.add(changes, time_s);
  }
  EXPECT_EQ(reports.before(70.0), 1u);
  EXPECT_DOUBLE_EQ(reports.delay_s(70.0), 11.0);
  EXPECT_TRUE(std::isinf(reports.delay_s(95.0)));
  EXPECT_EQ(reports.count(), 3u);
}

TEST(OwnMethod, IsChosenByName) {
  EXPECT_EQ(own_method_name("nls"), "nls");
  EXPECT_EQ(own_method("nls").name, "nls");
  EXPECT_FALSE(own_method_name("").empty());
  EXPECT_THROW(static_cast<void>(own_method("no_such_method")), std::invalid_argument);
  const AlignmentSpec spec = real_car_drive(simulator::RoadKind::kCity, 3.0, 14);
  const auto nls = run_drive(spec, own_method("nls").make);
  const auto tls = run_drive(spec, own_method("tls").make);
  EXPECT_NE(nls.last().radars[0].error(kYaw), tls.last().radars[0].error(kYaw));
}

TEST(Load, ScansMayHaveMoreDetectionsThanOneSimulatedRadarSends) {
  Load load(2, 1000.0, 1.0);
  ASSERT_EQ(load.vehicle().radars.size(), 2u);
  const auto method = own_method().make(load.vehicle());
  const std::size_t detections = load.give_cycle(*method);
  EXPECT_GT(detections, 1850u);
  EXPECT_LE(detections, 2 * kMaxDetections);
  const CycleCost cost = measure_cycles(load, *method, 5);
  EXPECT_GT(cost.mean_us, 0.0);
  const std::vector<double> calls_ms = call_times_ms(load, *method, 5);
  EXPECT_EQ(calls_ms.size(), 10u);
  EXPECT_GT(*std::min_element(calls_ms.begin(), calls_ms.end()), 0.0);
}

/// A group of bars with --quick: two short drives of each kind.
Report quick(void (*group)(const Options&, Report&), const char* method) {
  Options options;
  options.quick = true;
  options.jobs = 1;
  options.fresh_seed = 4711;
  options.method = method;
  Report report;
  group(options, report);
  return report;
}

const Bar& bar_named(const Report& report, const std::string& part) {
  static const Bar none{"", "", std::nan(""), 0.0, 0.0, "", ""};
  const auto found = std::find_if(report.bars().begin(), report.bars().end(),
                                  [&](const Bar& bar) { return bar.what.find(part) != std::string::npos; });
  EXPECT_NE(found, report.bars().end()) << part;
  return found == report.bars().end() ? none : *found;
}

TEST(RealCarGroups, EachKindIsJudgedWithSeedsAndInterval) {
  const Report report = quick(real_car, "");
  std::size_t consistencies = 0;
  for (const Bar& bar : report.bars()) {
    EXPECT_TRUE(std::isfinite(bar.figure)) << bar.what;
    EXPECT_NE(bar.how.find("seeds from "), std::string::npos) << bar.how;
    EXPECT_NE(bar.how.find("95 % interval"), std::string::npos) << bar.how;
    consistencies += bar.what.starts_with("largest NEES") ? 1 : 0;
  }
  EXPECT_EQ(consistencies, real_car_kinds().size());
  // Twelve seconds: most of the initial error of 1° and more is gone.
  EXPECT_LT(bar_named(report, "yaw rms").figure, 0.5);
}

TEST(RealCarGroups, PublishedMethodFailsTheBarsOfTheOwn) {
  const Report report = quick(real_car, "nls");
  EXPECT_FALSE(bar_named(report, "yaw rms").passes());
  EXPECT_FALSE(bar_named(report, ", range-rate scales").passes());
}

TEST(RealCarGroups, PublishedMethodsAreSlowerThanTheOwn) {
  const Report report = quick(real_car_published, "");
  EXPECT_EQ(report.bars().size(), 4u);  // yaw and pitch of the first kind and of the whole car
  EXPECT_LT(bar_named(report, "pitch rms / best published, range-rate scales").figure, 0.8);
  // A published method as the own one cannot be better than the best of them.
  const Report of_published = quick(real_car_published, "tls");
  for (const Bar& bar : of_published.bars()) EXPECT_GE(bar.figure, 1.0 - 1e-9) << bar.what;
}

TEST(RealCarGroups, DriftLeavesAnErrorThatIsMeasured) {
  // This published method needs minutes: it follows nothing in twelve seconds.
  EXPECT_FALSE(bar_named(quick(real_car_drift, "steepest_descent"), "yaw at the end, median").passes());
  EXPECT_LT(bar_named(quick(real_car_drift, ""), "yaw at the end, median").figure, 0.5);
}

TEST(RealCarGroups, FalseChangesAreScaledToTwentyHours) {
  const Bar bar = bar_named(quick(real_car_no_change, "steepest_descent"), "in 20 h");
  EXPECT_EQ(bar.figure, 0.0);  // it has no detector of changes
  EXPECT_NE(bar.how.find("0 in 0.0 h, 2 drives of 12 s"), std::string::npos) << bar.how;
}

TEST(RealCarGroups, MethodWithoutDetectorReportsNoTrueChange) {
  const Report report = quick(real_car_changes, "nls");
  for (const char* change : {"1° yaw", "2° pitch"}) {
    EXPECT_TRUE(std::isinf(bar_named(report, std::string(change) + ", real_car: delay").figure));
    EXPECT_EQ(bar_named(report, std::string(change) + ", real_car: reported within").figure, 0.0);
  }
}

TEST(RealCarGroups, MethodWithoutLoadReportsNone) {
  const Report report = quick(real_car_load, "nls");
  EXPECT_TRUE(std::isinf(bar_named(report, "load 0.8°: delay").figure));
  EXPECT_EQ(bar_named(report, "load 0.8°: reported within").figure, 0.0);
  EXPECT_TRUE(std::isfinite(bar_named(report, "load 0.8°: pitch").figure));
}

TEST(RealCarGroups, CostHasAnExponentForEachNumberOfDetections) {
  const Report report = quick(cost, "");
  for (const char* detections : {", 60 d", ", 300 d", ", 1000 d"}) {
    const double power = bar_named(report, std::string("exponent from 1 to 16 radars") + detections).figure;
    EXPECT_GT(power, 0.5);
    EXPECT_LT(power, 2.5);
  }
  EXPECT_GT(bar_named(report, "longest call").figure, 0.0);
  EXPECT_GT(bar_named(report, "mean").figure, 0.0);
}

}  // namespace
}  // namespace boresight::bench
