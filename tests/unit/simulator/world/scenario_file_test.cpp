// Scenario files are read completely, and errors name file, line and key.
#include "services/simulator/scenario_file.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boresight::simulator {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::string problems(std::string_view text) {
  try {
    static_cast<void>(read_scenario(config::Reader::parse(text, "my.toml")));
  } catch (const config::Error& error) {
    return error.what();
  }
  return "";
}

TEST(ScenarioFile, ReadsEveryPartOfAScenario) {
  const Scenario s = read_scenario(config::Reader::parse(R"(
name = "mine"
vehicle = "demo"
duration_s = 12.0
[road]
segments = [{length_m = 100.0}, {length_m = 50.0, curvature_per_m = 0.02}]
transition_m = 20.0
waves = [{curvature_per_m = 0.001, length_m = 30.0}]
[ego]
start_m = 5.0
speed = [{t_s = 0.0, speed_mps = 10.0}, {t_s = 4.0, speed_mps = 2.0}]
lateral_m = 0.5
length_m = 4.2
[[structure]]
kind = "noise_barrier"
from_m = 0.0
to_m = 90.0
lateral_m = -6.0
gaps = [{from_m = 10.0, to_m = 12.0}]
loss_db = 4.5
[[structure]]
kind = "wall"
from_m = 20.0
to_m = 40.0
lateral_m = 7.0
heading_deg = 90.0
[[scatter]]
kind = "parked_cars"
from_m = 0.0
to_m = 90.0
lateral_min_m = 4.0
lateral_max_m = 4.2
both_sides = false
[[body]]
kind = "truck"
start_m = 30.0
lateral = [{at_m = 40.0, lateral_m = 0.0}, {at_m = 90.0, lateral_m = 3.5}]
speed_mps = 9.0
length_m = 16.5
repeat = {count = 3, every_m = 40.0}
[[body]]
kind = "pedestrian"
start_m = 50.0
lateral_m = 6.0
heading_deg = -90.0
speed_mps = 1.4
[radars]
speed_scale = 1.01
noise = false
clutter_per_scan = 0.5
unambiguous_mps = 60.0
misalignment = [{radar = 2, yaw_deg = 90e-1}]
step_change = [{radar = 1, time_s = 3.0, pitch_deg = 1.0}]
blockage = [{radar = 3, begin_s = 1.0, full_s = 9.0, loss_db = 20.0, azimuth_min_deg = 0.0}]
interference = [{begin_s = 2.0, duration_s = 0.5, noise_rise_db = 10.0, detections_per_scan = 20.0}]
data_fault = [{kind = "near", begin_s = 3.0, duration_s = 2.0, reach_m = 6.0}]
multipath = {on = true, max_bounces = 2, ground_bounce = false}
resolution = {range_m = 0.5, azimuth_deg = 3.0}
sensitivity = {threshold_db = -30.0, max_detections = 200}
)",
                                                         "my.toml"));
  EXPECT_EQ(s.name, "mine");
  EXPECT_EQ(s.duration_s, 12.0);
  ASSERT_EQ(s.road.segments.size(), 2u);
  EXPECT_EQ(s.road.segments[1].curvature_per_m, 0.02);
  EXPECT_EQ(s.road.waves.at(0).length_m, 30.0);
  ASSERT_EQ(s.ego.speed_mps.size(), 2u);
  EXPECT_EQ(s.ego.speed_mps[1].at, 4.0);
  EXPECT_EQ(s.ego.lateral_m.at(0).value, 0.5);
  ASSERT_EQ(s.structures.size(), 2u);
  EXPECT_EQ(s.structures[0].high_m, 4.0) << "what is usual of the kind";
  EXPECT_EQ(s.structures[0].loss_db, 4.5);
  EXPECT_EQ(s.structures[0].gaps.at(0).to_m, 12.0);
  EXPECT_NEAR(s.structures[1].heading_rad, 0.5 * M_PI, 1e-12);
  EXPECT_EQ(s.scatter.at(0).kind, ScatterKind::kParkedCars);
  ASSERT_EQ(s.bodies.size(), 4u);
  EXPECT_EQ(s.bodies[2].start_m, 110.0);
  EXPECT_EQ(s.bodies[2].lateral_m[1].value, 3.5);
  EXPECT_EQ(s.bodies[3].kind, BodyKind::kPedestrian);
  EXPECT_NEAR(s.effects.misalignment[2].yaw_rad, 9.0 * M_PI / 180.0, 1e-12);
  EXPECT_FALSE(s.effects.noise);
  EXPECT_EQ(s.effects.step_changes.at(0).time_s, 3.0);
  EXPECT_EQ(s.effects.blockages.at(0).azimuth_min_rad, 0.0);
  EXPECT_EQ(s.effects.blockages.at(0).azimuth_max_rad, RadarBlockage{}.azimuth_max_rad);
  EXPECT_EQ(s.effects.interference.at(0).radar, 0u);
  EXPECT_EQ(s.effects.data_faults.at(0), (RadarDataFault{0, DataFaultKind::kNear, 3.0, 2.0, 0, 6.0}));
  EXPECT_EQ(s.effects.multipath.max_bounces, 2u);
  EXPECT_NEAR(s.effects.resolution.azimuth_rad, 3.0 * M_PI / 180.0, 1e-12);
  EXPECT_EQ(s.effects.sensitivity.max_detections, 200u);
}

TEST(ScenarioFile, NamesFileLineKeyAndWhatIsAllowed) {
  EXPECT_THAT(problems("name = \"x\"\n[ego]\nspeed_mps = 200.0\n"),
              HasSubstr("my.toml:3: ego.speed_mps: 200 is out of"));
  EXPECT_THAT(problems("name = \"x\"\n[ego]\nspeed_mps = nan\n"), HasSubstr("my.toml:3: ego.speed_mps: "));
  EXPECT_THAT(problems("name = \"x\"\n\n[[body]]\nkind = \"cat\"\nstart_m = 1.0\n"),
              HasSubstr("my.toml:4: body[0].kind: \"cat\" is unknown"));
  EXPECT_THAT(problems("name = \"x\"\n[[body]]\nkind = \"car\"\nstart_m = 1.0\ncolour = 3\n"),
              HasSubstr("my.toml:5: body[0].colour: unknown key"));
  EXPECT_THAT(problems(""), HasSubstr("name: is missing"));
  EXPECT_THAT(problems("name = \"x\"\n[radars]\nstep_change = [{time_s = 1.0}]\n"),
              HasSubstr("radars.step_change[0].radar"));
  EXPECT_THAT(problems("name = \"x\"\n[radars]\nmisalignment = [{radar = 17}]\n"), HasSubstr("1 … 16"));
}

TEST(ScenarioFile, FormerKeyIsAnErrorThatNamesTheKeyOfToday) {
  EXPECT_THAT(problems("name = \"x\"\n[[body]]\nkind = \"truck\"\nstart_m = 1.0\nflank_low_m = 0.8\n"),
              HasSubstr("my.toml:5: body[0].flank_low_m: is called 'side_low_m' now"));
}

TEST(ScenarioFile, RefusesContradictions) {
  const std::string head = "name = \"x\"\n";
  const std::string rail = "[[structure]]\nkind = \"guard_rail\"\nlateral_m = 1.0\n";
  EXPECT_THAT(problems(head + rail + "from_m = 9.0\nto_m = 3.0\n"), HasSubstr("my.toml:6: structure[0].to_m"));
  EXPECT_THAT(problems(head + rail + "from_m = 0.0\nto_m = 900.0\nheading_deg = 90.0\n"), HasSubstr("heading_deg"));
  EXPECT_THAT(problems(head + rail + "from_m = 0.0\nto_m = 9.0\nlow_m = 2.0\nhigh_m = 1.0\n"), HasSubstr("high_m"));
  EXPECT_THAT(problems(head + "[ego]\nspeed_mps = 5.0\nspeed = [{t_s = 0.0, speed_mps = 1.0}]\n"),
              HasSubstr("cannot be given together"));
  EXPECT_THAT(problems(head + "[ego]\nspeed = [{t_s = 3.0, speed_mps = 1.0}, {t_s = 2.0, speed_mps = 1.0}]\n"),
              HasSubstr("ego.speed[1].t_s"));
  EXPECT_THAT(problems(head + "[ego]\nspeed = []\n"), HasSubstr("must not be empty"));
  EXPECT_THAT(problems(head + "[ego]\nspeed_mps = 5.0\nswing_mps = 6.0\n"), HasSubstr("swing_mps"));
  EXPECT_THAT(problems(head + "[[body]]\nkind = \"car\"\nstart_m = 0.0\nparked = true\nspeed_mps = 1.0\n"),
              HasSubstr("body[0].parked"));
  EXPECT_THAT(problems(head + "[[body]]\nkind = \"car\"\nstart_m = 0.0\nrepeat = {count = 2}\n"), HasSubstr("every_m"));
  EXPECT_THAT(
      problems(head + "[road]\nsegments = [{length_m = 90.0, curvature_per_m = 0.2}]\n[ego]\nlateral_m = 6.0\n"),
      HasSubstr("beyond the centre"));
}

TEST(ScenarioFile, ShippedScenariosAreFoundByNameAndOwnOnesByPath) {
  const auto names = scenario_names();
  for (const char* name : {"demo_drive", "aligned_drive", "straight_rail", "highway_multipath", "tunnel", "city_canyon",
                           "parking_garage", "truck_overtaking", "curve_with_rail", "junction", "motorway_braking",
                           "stopped_car", "crossing_pedestrian", "parked_row_in_curve"}) {
    EXPECT_THAT(names, Contains(name));
  }
  for (const std::string& name : names) {
    const Scenario s = scenario(name);
    EXPECT_EQ(s.name, name);
    EXPECT_FALSE(s.about.empty()) << name;
    EXPECT_TRUE(std::filesystem::exists(BORESIGHT_SOURCE_DIR "/config/vehicle/" + s.vehicle + ".toml")) << name;
  }
  const std::string file = testing::TempDir() + "own.toml";
  std::ofstream(file) << "name = \"own\"\n";
  EXPECT_EQ(scenario(file).name, "own");
  EXPECT_THROW(static_cast<void>(scenario("./nowhere.toml")), config::Error);
  EXPECT_THROW(static_cast<void>(scenario("nowhere")), std::invalid_argument);
}

}  // namespace
}  // namespace boresight::simulator
