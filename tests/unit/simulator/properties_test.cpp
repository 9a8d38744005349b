// What holds of every drive: effects do not disturb each other's random draws, a shorter drive is the beginning of a
// longer one, and what stands has the range rate that the ego vehicle's motion gives it.
#include <algorithm>
#include <array>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "services/common/geometry/frames.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "tests/simulator/drive.hpp"
#include "tests/simulator/radar/mounting.hpp"
#include "tests/simulator/radar/round_trip.hpp"

namespace boresight::simulator {
namespace {

VehicleConfig vehicle_named(const std::string& name) {
  return config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle" / (name + ".toml"));
}

/// Everything that a scan says of a detection, to the last bit, and what is true of it.
struct Row {
  double t_s;
  std::uint32_t radar;
  std::array<float, 10> said;
  Provenance provenance;
  std::uint32_t object, bounces, mirror;
  auto operator<=>(const Row&) const = default;
};

Row row_of(const Event& event, std::size_t i) {
  const RadarScan& s = *event.scan;
  const DetectionTruth& t = (*event.truth)[i];
  return {event.t_s,
          s.header.source_id,
          {s.range_m[i], s.azimuth_rad[i], s.elevation_rad[i], s.range_rate_mps[i], s.rcs_dbsm[i], s.range_std_m[i],
           s.azimuth_std_rad[i], s.elevation_std_rad[i], s.range_rate_std_mps[i], s.existence_probability[i]},
          t.provenance,
          t.object_id,
          t.bounces,
          t.mirror_body};
}

struct Seen {
  std::vector<Row> rows;  // sorted
  std::vector<EgoSignals> ego;
};

constexpr double kShort_s = 2.0;

Seen drive(const Scenario& scenario, double duration_s = kShort_s, double until_s = kShort_s) {
  Drive drive(scenario, vehicle_named(scenario.vehicle), 11, duration_s);
  Seen seen;
  while (const Event* event = drive.next()) {
    if (event->t_s > until_s) break;
    if (event->scan == nullptr) seen.ego.push_back(event->ego);
    for (std::size_t i = 0; event->scan != nullptr && i < event->scan->number_of_valid_detections; ++i) {
      seen.rows.push_back(row_of(*event, i));
    }
  }
  std::sort(seen.rows.begin(), seen.rows.end());
  return seen;
}

std::vector<Row> only(const std::vector<Row>& rows, const std::function<bool(const Row&)>& wanted) {
  std::vector<Row> some;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(some), wanted);
  return some;
}

bool has_all(const std::vector<Row>& more, const std::vector<Row>& fewer) {
  return std::includes(more.begin(), more.end(), fewer.begin(), fewer.end());
}

bool same_ego(const Seen& a, const Seen& b) {
  return a.ego.size() == b.ego.size() &&
         std::memcmp(a.ego.data(), b.ego.data(), a.ego.size() * sizeof(EgoSignals)) == 0;
}

class Shipped : public testing::TestWithParam<std::string> {};

TEST_P(Shipped, AShorterDriveIsTheBeginningOfALongerOne) {
  const Scenario s = scenario(GetParam());
  const Seen brief = drive(s, 1.0, 1.0), whole = drive(s, s.duration_s, 1.0);
  EXPECT_GT(brief.rows.size(), 100u);
  EXPECT_EQ(brief.rows, whole.rows);
  EXPECT_TRUE(same_ego(brief, whole));
}

TEST_P(Shipped, FalseDetectionsChangeNoOther) {
  Scenario s = scenario(GetParam());
  s.effects.sensitivity.max_detections = 800;
  s.effects.clutter_per_scan = 0.0;
  const Seen without = drive(s);
  const auto real = [](const Row& r) { return r.provenance != Provenance::kClutter; };
  EXPECT_EQ(only(without.rows, real), without.rows);
  s.effects.clutter_per_scan = 5.0;
  s.effects.interference = {{0, 0.5, 1.0, 0.0, 30.0}};  // without a rise of the noise floor
  const Seen with = drive(s);
  EXPECT_GT(with.rows.size(), without.rows.size() + 100);
  EXPECT_EQ(only(with.rows, real), without.rows);
  EXPECT_TRUE(same_ego(with, without));
}

TEST_P(Shipped, WhatHappensToOneRadarChangesNoOther) {
  const Scenario s = scenario(GetParam());
  const Seen as_it_is = drive(s);
  const auto others = [](const Row& r) { return r.radar != 2; };
  const auto before = [](const Row& r) { return r.radar == 2 && r.t_s < 1.0; };
  const auto after = [](const Row& r) { return r.radar == 2 && r.t_s >= 1.0; };
  const std::map<std::string, std::function<void(RadarEffects&)>> effects = {
      {"knock",
       [](RadarEffects& e) {
         e.knocks.push_back({2, 1.0, {0.05, 0.02, -0.03}});
       }},
      {"blockage",
       [](RadarEffects& e) {
         e.blockages.push_back({2, 1.0, 1.2, 30.0, -3.2, 3.2});
       }},
      {"interference", [](RadarEffects& e) {
         e.interference.push_back({2, 1.0, 9.0, 10.0, 20.0});
       }}};
  for (const auto& [name, add] : effects) {
    Scenario more = s;
    add(more.effects);
    const Seen with = drive(more);
    EXPECT_EQ(only(with.rows, others), only(as_it_is.rows, others)) << name;
    EXPECT_EQ(only(with.rows, before), only(as_it_is.rows, before)) << name;
    EXPECT_NE(only(with.rows, after), only(as_it_is.rows, after)) << name;
    EXPECT_TRUE(same_ego(with, as_it_is)) << name;
  }
  Scenario crooked = s;
  crooked.effects.misalignment[2].yaw_rad += 0.05;
  EXPECT_EQ(only(drive(crooked).rows, others), only(as_it_is.rows, others));
}

TEST_P(Shipped, ASpeedSignalThatIsWrongChangesNoScanAndNoNoise) {
  Scenario s = scenario(GetParam());
  s.effects.speed_scale = 1.0;
  const Seen right = drive(s);
  s.effects.speed_scale = 1.02;
  const Seen wrong = drive(s);
  EXPECT_EQ(right.rows, wrong.rows);
  const World world(s, 11, kShort_s);
  for (std::size_t i = 0; i < right.ego.size(); ++i) {
    const double speed = world.ego(static_cast<double>(i) * Drive::kEgoPeriod_s).speed_mps;
    EXPECT_NEAR(right.ego[i].speed_mps - speed, wrong.ego[i].speed_mps - speed / 1.02, 1e-12);
    EXPECT_EQ(right.ego[i].yaw_rate_radps, wrong.ego[i].yaw_rate_radps);
  }
}

/// Without cells, in which things share a detection, and without the images of one in another.
Scenario apart(const std::string& name) {
  Scenario s = scenario(name);
  s.effects.resolution = {0.0, 0.0, 0.0};
  s.effects.multipath.on = false;
  s.effects.multipath.ground_bounce = false;
  s.effects.clutter_per_scan = 0.0;
  s.effects.sensitivity.max_detections = 1024;
  return s;
}

TEST_P(Shipped, MoreThingsChangeNoneOfThoseThatWereThere) {
  const Scenario s = apart(GetParam());
  const Seen before = drive(s);
  EXPECT_TRUE(std::all_of(before.rows.begin(), before.rows.end(), [](const Row& r) { return r.bounces == 0; }));
  // Another vehicle hides some of it; what is left is as it was. Parked cars keep their numbers.
  Scenario another = s;
  BodySpec car;
  car.start_m = s.ego.start_m + 12.0;
  car.lateral_m = {{0.0, 2.5}};
  another.bodies.push_back(car);
  const auto id = static_cast<std::uint32_t>(another.bodies.size());
  const Seen with_car = drive(another);
  const auto not_it = [&](const Row& r) { return r.object != id; };
  EXPECT_LT(only(with_car.rows, not_it).size(), with_car.rows.size());
  EXPECT_TRUE(has_all(before.rows, only(with_car.rows, not_it)));
  // A rail that hides nothing, and poles.
  Scenario roadside = s;
  StructureSpec rail;
  rail.from_m = s.ego.start_m - 50.0;
  rail.to_m = s.ego.start_m + 150.0;
  rail.lateral_m = 4.1;
  rail.opaque = false;
  roadside.structures.push_back(rail);
  ScatterSpec poles;
  poles.from_m = rail.from_m;
  poles.to_m = rail.to_m;
  poles.lateral_min_m = 4.0;
  poles.lateral_max_m = 5.0;
  roadside.scatter.push_back(poles);
  const Seen with_roadside = drive(roadside);
  EXPECT_GT(with_roadside.rows.size(), before.rows.size() + 200);
  EXPECT_TRUE(has_all(with_roadside.rows, before.rows));
}

TEST_P(Shipped, MirrorsAddGhostsAndChangeNothingElse) {
  Scenario s = apart(GetParam());
  const Seen direct = drive(s);
  s.effects.multipath.on = true;
  const Seen with = drive(s);
  EXPECT_EQ(only(with.rows, [](const Row& r) { return r.bounces == 0; }), direct.rows);
  s.effects.multipath.max_bounces = 2;
  const Seen two = drive(s);
  EXPECT_EQ(only(with.rows, [](const Row& r) { return r.bounces <= 1; }), two.rows);
}

TEST_P(Shipped, FoldingChangesRangeRatesByWholeIntervalsOnly) {
  Scenario s = apart(GetParam());
  s.effects.unambiguous_mps = 0.0;
  const Seen resolved = drive(s);
  s.effects.unambiguous_mps = 1.5;
  const Seen folded = drive(s);
  ASSERT_EQ(resolved.rows.size(), folded.rows.size());
  std::multimap<std::array<float, 2>, float> rates;  // by range and azimuth
  for (const Row& r : resolved.rows) rates.emplace(std::array<float, 2>{r.said[0], r.said[1]}, r.said[3]);
  std::size_t changed = 0;
  for (const Row& r : folded.rows) {
    EXPECT_GE(r.said[3], -1.5F);
    EXPECT_LE(r.said[3], 1.5F);
    const auto [first, last] = rates.equal_range({r.said[0], r.said[1]});
    EXPECT_TRUE(std::any_of(first, last, [&](const auto& entry) {
      return std::abs(std::remainder(static_cast<double>(entry.second) - static_cast<double>(r.said[3]), 3.0)) < 2e-5;
    }));
    changed += first->second != r.said[3] ? 1 : 0;
  }
  EXPECT_GT(changed, folded.rows.size() / 20);
}

/// Direct echoes of what stands, as the propagation hands them on, in full precision.
TEST_P(Shipped, WhatStandsHasTheRangeRateOfTheEgoMotionEquation) {
  Scenario s = apart(GetParam());
  s.effects.noise = false;
  s.effects.unambiguous_mps = 0.0;
  const VehicleConfig vehicle = vehicle_named(s.vehicle);
  const World world(s, 3, s.duration_s);
  Scene scene;
  std::size_t compared = 0;
  const auto expected = [&](const RadarConfig& radar, double azimuth, double elevation) {
    const Eigen::Matrix3d rotation = radar::actual_mounting(radar.mounting_pose, s.effects, radar.id, scene.t_s);
    // (12) of Report A in three dimensions: ṙ = −(R u)·v_s with the velocity of the place where the radar sits.
    const auto& p = radar.mounting_pose.position_m;
    const Eigen::Vector3d velocity(scene.ego.speed_mps - scene.ego.yaw_rate_radps * p[1],
                                   scene.ego.yaw_rate_radps * p[0], 0.0);
    const Eigen::Vector3d u(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                            std::sin(elevation));
    return -(rotation * u).dot(velocity);
  };
  for (double t = 0.3; t < s.duration_s; t += 0.25 * s.duration_s) {
    world.at(t, 100.0, scene);
    for (const RadarConfig& radar : vehicle.radars) {
      const radar::Viewpoint view = radar::viewpoint(
          scene.ego, radar.mounting_pose, radar::actual_mounting(radar.mounting_pose, s.effects, radar.id, scene.t_s));
      radar::Propagation propagation(s.effects.multipath, radar.field_of_view.range_max_m);
      propagation.prepare(scene, view,
                          radar::seen_from(ego_body(s.ego), Eigen::Vector3d(radar.mounting_pose.position_m.data())));
      radar::Antenna antenna(radar.field_of_view);
      std::vector<radar::OneWay> paths;
      std::vector<radar::Echo> echoes;
      for (const Scatterer& point : scene.scatterers) {
        const radar::Target target{
            point.position_m, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0, 0, false, 0};
        paths.clear();
        propagation.direct(target, 0.5, paths);
        radar::combine(target, paths, s.effects.multipath, antenna, view.sensor_to_world.transpose(), echoes);
      }
      for (const radar::Echo& e : echoes) {
        ASSERT_NEAR(e.range_rate_mps, expected(radar, e.azimuth_rad, e.elevation_rad), 1e-9);
      }
      compared += echoes.size();
      // And in the scan, which has 32-bit floats: half a unit in the last place of the rate and of both angles.
      RadarSensor sensor(radar, s.effects, ego_body(s.ego), 3);
      RadarScan scan;
      std::vector<DetectionTruth> truth;
      sensor.measure(scene, 0, scan, truth);
      const double rounding = 1.2e-7 * (1.0 + 3.0 * std::abs(scene.ego.speed_mps));
      for (std::size_t i = 0; i < truth.size(); ++i) {
        if (truth[i].provenance != Provenance::kStationary || truth[i].object_id != 0) continue;
        ASSERT_NEAR(scan.range_rate_mps[i], expected(radar, scan.azimuth_rad[i], scan.elevation_rad[i]),
                    1e-6 + rounding);
      }
    }
  }
  EXPECT_GT(compared, 500u);
}

TEST_P(Shipped, IsFasterThanRealTime) {
  const Scenario s = scenario(GetParam());
  const VehicleConfig vehicle = vehicle_named(s.vehicle);
  constexpr double kPart_s = 5.0;
  const std::clock_t begin = std::clock();
  Drive drive(s, vehicle, 1, kPart_s);
  std::size_t detections = 0;
  while (const Event* event = drive.next()) {
    if (event->scan != nullptr) detections += event->truth->size();
  }
  const double cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::printf("%s: %.0f times real time, %zu detections in %.0f s\n", s.name.c_str(), kPart_s / cpu_s, detections,
              kPart_s);
  EXPECT_LT(cpu_s, kPart_s);
}

INSTANTIATE_TEST_SUITE_P(All, Shipped, testing::ValuesIn(scenario_names()));

}  // namespace
}  // namespace boresight::simulator
