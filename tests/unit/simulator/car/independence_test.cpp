// Effects of a real car disturb no draw of anything else. Without effects the drives are those of before.
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/scenario_file.hpp"

namespace boresight::simulator {
namespace {

/// All that the messages of a drive state.
struct Columns {
  std::vector<std::int64_t> stamps_ns;
  std::vector<std::size_t> counts;
  std::vector<float> range, azimuth, elevation, range_rate, rcs;
  std::vector<double> speed, yaw_rate;

  void add(const RadarScan& scan) {
    stamps_ns.push_back(scan.header.measurement_time_ns);
    counts.push_back(scan.number_of_valid_detections);
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      range.push_back(scan.range_m[i]);
      azimuth.push_back(scan.azimuth_rad[i]);
      elevation.push_back(scan.elevation_rad[i]);
      range_rate.push_back(scan.range_rate_mps[i]);
      rcs.push_back(scan.rcs_dbsm[i]);
    }
  }
};

Columns statistical(const car::RealCar& car) {
  AlignmentSpec spec = four_corner_radars();
  spec.seed = 5;
  spec.duration_s = 4.0;
  spec.road = RoadKind::kCity;
  spec.real_car = car;
  AlignmentDrive drive(spec);
  AlignmentEvent event;
  Columns c;
  while (drive.next(event)) {
    if (event.scan != nullptr) {
      c.add(*event.scan);
    } else {
      c.speed.push_back(static_cast<double>(event.ego->speed_mps));
      c.yaw_rate.push_back(static_cast<double>(event.ego->yaw_rate_radps));
    }
  }
  return c;
}

/// With noise, clutter, ghosts and moving bodies, on a winding road.
Columns world(const car::RealCar& car) {
  Scenario s = scenario("truck_overtaking");
  s.road.waves = {{0.004, 50.0}};
  s.effects.real_car = car;
  Drive drive(s, AlignmentDrive(four_corner_radars()).vehicle(), 5, 2.0);
  Columns c;
  while (const Event* event = drive.next()) {
    if (event->scan != nullptr) {
      c.add(*event->scan);
    } else {
      c.speed.push_back(event->ego.speed_mps);
      c.yaw_rate.push_back(event->ego.yaw_rate_radps);
    }
  }
  return c;
}

/// What an effect may change.
enum : unsigned { kRate = 1, kAzimuth = 2, kElevation = 4, kStamps = 8, kSpeed = 16, kYawRate = 32 };

struct Effect {
  std::string name;
  std::function<void(car::RealCar&)> set;
  unsigned changes;
  bool moves_the_sensor;  ///< in the world the sensor then sees other things: only its draws stay
};

const std::vector<Effect>& effects() {
  static const std::vector<Effect> kEffects = {
      {"scale", [](car::RealCar& c) { c.range_rate_scale = 0.0025; }, kRate, false},
      {"curve", [](car::RealCar& c) { c.azimuth_curve_rms_rad = 0.004; }, kAzimuth, false},
      {"position", [](car::RealCar& c) { c.position_error_m = 0.05; }, kRate, true},
      {"stamps", [](car::RealCar& c) { c.stamp_offset_s = 0.02; }, kStamps, false},
      {"side slip", [](car::RealCar& c) { c.side_slip_std_rad = 0.002; }, kRate, true},
      {"slip in bends", [](car::RealCar& c) { c.slip_coefficient_radps2pm = 0.0045; }, kRate, true},
      {"load", [](car::RealCar& c) { c.load_pitch_rad = 0.01, c.load_time_s = 1.0; }, kRate, true},
      {"yaw-rate gain", [](car::RealCar& c) { c.yaw_rate_gain = 0.01; }, kYawRate, false},
      {"yaw-rate bias", [](car::RealCar& c) { c.yaw_rate_bias_radps = 0.002; }, kYawRate, false},
      {"speed step", [](car::RealCar& c) { c.speed_step_mps = 0.028; }, kSpeed, false},
      {"road mirror", [](car::RealCar& c) { c.road_mirror_share = 0.1; }, kElevation, false},
  };
  return kEffects;
}

void expect_changes(const Columns& plain, const Columns& with, unsigned changes) {
  ASSERT_EQ(plain.counts, with.counts);
  EXPECT_EQ(plain.range, with.range);
  EXPECT_EQ(plain.rcs, with.rcs);
  EXPECT_EQ(plain.range_rate != with.range_rate, (changes & kRate) != 0);
  EXPECT_EQ(plain.elevation != with.elevation, (changes & kElevation) != 0);
  EXPECT_EQ(plain.stamps_ns != with.stamps_ns, (changes & kStamps) != 0);
  EXPECT_EQ(plain.speed != with.speed, (changes & kSpeed) != 0);
  EXPECT_EQ(plain.yaw_rate != with.yaw_rate, (changes & kYawRate) != 0);
  double largest = 0.0;
  for (std::size_t i = 0; i < plain.azimuth.size(); ++i) {
    largest = std::max(largest, std::abs(static_cast<double>(plain.azimuth[i] - with.azimuth[i])));
  }
  EXPECT_EQ(largest > 1e-5, (changes & kAzimuth) != 0) << largest;
}

TEST(RealCarIndependence, EachEffectChangesOnlyItsQuantities) {
  const Columns in_tables = statistical({}), in_world = world({});
  for (const Effect& effect : effects()) {
    SCOPED_TRACE(effect.name);
    car::RealCar car;
    effect.set(car);
    expect_changes(in_tables, statistical(car), effect.changes);
    if (!effect.moves_the_sensor) expect_changes(in_world, world(car), effect.changes);
  }
}

TEST(RealCarIndependence, OffGivesTheDriveOfBefore) {
  // Sums over the tables of `simulate --alignment-drive city --seed 5 --duration 10`, written before these effects
  // existed. The last digits may differ on another instruction set.
  AlignmentSpec spec = four_corner_radars();
  for (AlignmentRadar& radar : spec.radars) radar.states_stds = false;
  spec.seed = 5;
  spec.duration_s = 10.0;
  spec.road = RoadKind::kCity;
  spec.real_car.load_time_s = 2.0;
  spec.real_car.side_slip_correlation_s = 7.0;
  AlignmentDrive drive(spec);
  AlignmentEvent event;
  double rate = 0.0, azimuth = 0.0, elevation = 0.0, speed = 0.0, yaw_rate = 0.0;
  std::size_t detections = 0;
  while (drive.next(event)) {
    if (event.ego != nullptr) {
      speed += static_cast<double>(event.ego->speed_mps);
      yaw_rate += static_cast<double>(event.ego->yaw_rate_radps);
      continue;
    }
    for (std::size_t i = 0; i < event.scan->number_of_valid_detections; ++i, ++detections) {
      rate += static_cast<double>(event.scan->range_rate_mps[i]);
      azimuth += std::abs(static_cast<double>(event.scan->azimuth_rad[i]));
      elevation += std::abs(static_cast<double>(event.scan->elevation_rad[i]));
    }
  }
  EXPECT_EQ(detections, 47667U);
  EXPECT_NEAR(rate, -1016.6, 0.5);
  EXPECT_NEAR(azimuth, 22862.662, 0.01);
  EXPECT_NEAR(elevation, 2580.769, 0.01);
  EXPECT_NEAR(speed, 1604.182, 0.001);
  EXPECT_NEAR(yaw_rate, 14.6057, 0.0005);
}

}  // namespace
}  // namespace boresight::simulator
