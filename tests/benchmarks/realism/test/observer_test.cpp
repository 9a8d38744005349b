// What the statistics read of a simulated drive.
#include "tests/benchmarks/realism/common/observer.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/realism/common/drives.hpp"

namespace boresight::bench::realism {
namespace {

VehicleConfig demo() {
  return config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml",
                                   config::VehicleUse::kOffline);
}

TEST(Observer, WithoutNoiseStationaryDetectionsDoNotDeviateAndMoversLieOnTheirBody) {
  // Radar 2 is misaligned in this scenario: the true mounting counts.
  simulator::Scenario scenario = with_profile(simulator::scenario("demo_drive"), "ideal");
  scenario.effects.noise = false;
  const VehicleConfig vehicle = measuring_vehicle(demo(), Source::kRadarScenes);
  simulator::Drive drive(scenario, vehicle, 5, 1.5);
  Observer observer(scenario, vehicle);
  Samples deviation_mps;  // of the misaligned radar's stationary detections
  std::size_t of_movers = 0;
  while (const simulator::Event* event = drive.next()) {
    if (event->scan == nullptr) continue;
    const ObservedScan scan = observer.observe(drive, *event);
    ASSERT_EQ(scan.detections.size(), event->truth->size());
    for (const ObservedDetection& d : scan.detections) {
      if (scan.radar == 2 && d.provenance == Provenance::kStationary) deviation_mps.add(std::abs(d.deviation_mps));
      const ObservedObject* const object = d.is_of_mover() ? scan.object(d.object) : nullptr;
      if (object == nullptr) continue;
      EXPECT_GT(object->depth_m(d.position_m), -1.0);
      EXPECT_GE(d.range_m, object->range_m - 0.5);
      ++of_movers;
    }
  }
  // With the nominal mounting it would be some 0.3 m/s. Glint by the road remains.
  EXPECT_GT(deviation_mps.size(), 300u);
  EXPECT_LT(deviation_mps.quantile(0.5), 0.05);
  EXPECT_GT(of_movers, 50u);
}

TEST(MeasuringVehicle, RadarsStandAsTheMeasuredOnes) {
  const VehicleConfig four = measuring_vehicle(demo(), Source::kRadarScenes);
  ASSERT_EQ(four.radars.size(), 4u);
  EXPECT_NEAR(four.radars[0].mounting_pose.yaw_rad, 25.0 * M_PI / 180.0, 1e-9);
  EXPECT_DOUBLE_EQ(four.radars[3].cycle_time_s, 0.075);
  EXPECT_EQ(measuring_vehicle(demo(), Source::kNuScenes).radars.size(), 5u);
}

TEST(Drives, StatisticsDependOnTheSeedAndNotOnTheThreads) {
  Drives drives{{"straight_rail", "city_canyon"}, 3, 1.0, 1};
  const Statistics one = simulate(drives, "series_77ghz", demo());
  drives.jobs = 2;
  const Statistics two = simulate(drives, "series_77ghz", demo());
  EXPECT_GT(one.detections, 1000u);
  EXPECT_EQ(one.detections, two.detections);
  EXPECT_EQ(one.false_movers.per_scan(), two.false_movers.per_scan());
  drives.seed = 4;
  EXPECT_NE(simulate(drives, "series_77ghz", demo()).detections, one.detections);
}

TEST(Drives, UnknownProfileIsAnError) {
  EXPECT_THROW(static_cast<void>(simulate({{"straight_rail"}, 1, 1.0, 1}, "no_such_radar", demo())), std::exception);
}

}  // namespace
}  // namespace boresight::bench::realism
