// Properties of every drive: effects do not change each other's random draws, a shorter drive is the beginning of a
// longer one, and stationary detections have the range rate that follows from the ego vehicle's motion.
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "services/common/geometry/frames.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/radar/mounting.hpp"
#include "services/simulator/radar/round_trip.hpp"

namespace boresight::simulator {
namespace {

VehicleConfig vehicle_named(const std::string& name) {
  return config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle" / (name + ".toml"));
}

/// All values of a detection, to the last bit, and its truth.
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

TEST_P(Shipped, EffectsOnOneRadarChangeNoOther) {
  const Scenario s = scenario(GetParam());
  const Seen as_it_is = drive(s);
  const auto others = [](const Row& r) { return r.radar != 2; };
  const auto before = [](const Row& r) { return r.radar == 2 && r.t_s < 1.0; };
  const auto after = [](const Row& r) { return r.radar == 2 && r.t_s >= 1.0; };
  const std::map<std::string, std::function<void(RadarEffects&)>> effects = {
      {"step_change",
       [](RadarEffects& e) {
         e.step_changes.push_back({2, 1.0, {0.05, 0.02, -0.03}});
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
  Scenario misaligned = s;
  misaligned.effects.misalignment[2].yaw_rad += 0.05;
  EXPECT_EQ(only(drive(misaligned).rows, others), only(as_it_is.rows, others));
}

TEST_P(Shipped, AScaledSpeedSignalChangesNoScanAndNoNoise) {
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

/// Without resolution cells, in which targets share a detection, and without mirrors.
Scenario apart(const std::string& name) {
  Scenario s = scenario(name);
  s.effects.resolution = {0.0, 0.0, 0.0};
  s.effects.multipath.on = false;
  s.effects.multipath.ground_bounce = false;
  s.effects.clutter_per_scan = 0.0;
  s.effects.sensitivity.max_detections = 1024;
  return s;
}

TEST_P(Shipped, AddedTargetsDoNotChangeExistingOnes) {
  const Scenario s = apart(GetParam());
  const Seen before = drive(s);
  EXPECT_TRUE(std::all_of(before.rows.begin(), before.rows.end(), [](const Row& r) { return r.bounces == 0; }));
  // Another vehicle hides some targets; the other detections do not change. Parked cars keep their numbers.
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

/// Direct echoes of stationary targets from the propagation, in full precision.
TEST_P(Shipped, StationaryDetectionsHaveTheRangeRateOfTheEgoMotion) {
  Scenario s = apart(GetParam());
  s.effects.noise = false;
  s.effects.unambiguous_mps = 0.0;
  const VehicleConfig vehicle = vehicle_named(s.vehicle);
  const World world(s, 3, s.duration_s);
  Scene scene;
  std::size_t compared = 0;
  const auto expected = [&](const RadarConfig& radar, double azimuth, double elevation) {
    const Eigen::Matrix3d rotation = radar::actual_mounting(radar.mounting_pose, s.effects, radar.id, scene.t_s);
    // (12) of Burza 2025 in three dimensions: ṙ = −(R u)·v_s with the velocity of the radar's place.
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
      // The scan has 32-bit floats: half a unit in the last place of the rate and of both angles.
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

INSTANTIATE_TEST_SUITE_P(All, Shipped, testing::ValuesIn(scenario_names()));

/// Motion of the ego vehicle in a scenario.
struct Course {
  double fastest_mps = -1e9, slowest_mps = 1e9, hardest_braking_mps2 = 0.0, turned_rad = 0.0;
  double stood_s = 0.0;  // between driving and driving
};

Course course_of(const std::string& name) {
  const Scenario s = scenario(name);
  const World world(s, 1, s.duration_s);
  Course c;
  double standing_s = 0.0;
  constexpr double kStep_s = 0.01;
  for (double t = 0.0; t < s.duration_s; t += kStep_s) {
    const EgoState ego = world.ego(t);
    c.fastest_mps = std::max(c.fastest_mps, ego.speed_mps);
    c.slowest_mps = std::min(c.slowest_mps, ego.speed_mps);
    c.hardest_braking_mps2 = std::max(c.hardest_braking_mps2, -ego.acceleration_mps2);
    c.turned_rad += ego.yaw_rate_radps * kStep_s;
    if (std::abs(ego.speed_mps) < 0.05) {
      standing_s += kStep_s;
    } else {
      c.stood_s += std::exchange(standing_s, 0.0);
    }
  }
  return c;
}

TEST(ShippedScenarios, ContainTheirDescribedManoeuvres) {
  for (const char* motorway : {"highway_multipath", "truck_overtaking"}) {
    const Course c = course_of(motorway);
    EXPECT_GT(c.slowest_mps, 14.0) << motorway;
    EXPECT_LT(std::abs(c.turned_rad), 0.5) << motorway;
  }
  const Course street = course_of("city_canyon"), junction = course_of("junction"),
               braking = course_of("motorway_braking"), garage = course_of("parking_garage"),
               bends = course_of("curve_with_rail");
  EXPECT_NEAR(street.turned_rad, 0.5 * M_PI, 0.02) << "turns left";
  EXPECT_GT(street.stood_s, 3.0);
  EXPECT_GT(junction.stood_s, 5.0);
  EXPECT_GT(junction.fastest_mps, 11.0);
  EXPECT_GT(braking.fastest_mps, 29.0);
  EXPECT_GT(braking.hardest_braking_mps2, 7.0);
  EXPECT_LT(braking.hardest_braking_mps2, 9.0);
  EXPECT_GT(braking.stood_s, 4.0);
  EXPECT_NEAR(garage.turned_rad, -0.5 * M_PI, 0.15) << "turns right";
  EXPECT_LT(garage.slowest_mps, -1.0) << "reverses";
  EXPECT_GT(bends.turned_rad, -0.5);
  EXPECT_GT(bends.hardest_braking_mps2, 3.0);
}

/// A car on the right that drives a little faster than the ego vehicle, and one mirror on the left.
std::map<std::pair<Provenance, unsigned>, std::size_t> ghosts_by(const std::string& thing, bool of_body) {
  const Scenario s = read_scenario(
      config::Reader::parse("name = \"x\"\nvehicle = \"demo\"\n[[body]]\nkind = \"car\"\nstart_m = 4.0\nlateral_m = "
                            "-3.5\nspeed_mps = 19.0\n" +
                                thing + "[radars]\nsensitivity = {threshold_db = -60.0, max_detections = 800}\n",
                            "x.toml"));
  std::map<std::pair<Provenance, unsigned>, std::size_t> ghosts;
  for (const Row& r : drive(s, 4.0, 4.0).rows) {
    if (r.bounces == 0 || r.object != 1) continue;
    EXPECT_EQ(r.mirror, of_body ? 2u : 0u);
    ++ghosts[{r.provenance, r.bounces}];
  }
  return ghosts;
}

TEST(Reflectors, EachMakesGhostsOfBothTypesByTwoAndThreeBounces) {
  const auto expect_all = [](const std::string& name, std::map<std::pair<Provenance, unsigned>, std::size_t> ghosts) {
    EXPECT_GT((ghosts[{Provenance::kGhostType1, 1}]), 5u) << name;
    EXPECT_GT((ghosts[{Provenance::kGhostType2, 1}]), 5u) << name;
    EXPECT_GT((ghosts[{Provenance::kGhostType2, 2}]), 5u) << name;
  };
  for (const char* kind : {"guard_rail", "wall", "noise_barrier", "tunnel", "facade", "pillars"}) {
    const std::string structure =
        std::string("[[structure]]\nkind = \"") + kind + "\"\nfrom_m = -200.0\nto_m = 400.0\nlateral_m = 4.5\n";
    expect_all(kind, ghosts_by(structure + (std::string(kind) == "tunnel" ? "width_m = 12.0\n" : ""), false));
  }
  for (const char* kind : {"truck", "van"}) {
    expect_all(kind, ghosts_by(std::string("[[body]]\nkind = \"") + kind +
                                   "\"\nstart_m = 4.0\nlateral_m = 3.5\nspeed_mps = 16.0\n",
                               true));
  }
  const auto none = ghosts_by("[[body]]\nkind = \"car\"\nstart_m = 4.0\nlateral_m = 3.5\nspeed_mps = 16.0\n", true);
  EXPECT_TRUE(none.empty()) << "cars do not mirror";
}

}  // namespace
}  // namespace boresight::simulator
