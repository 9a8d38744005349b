#include "services/common/runtime/config/vehicle_file.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boresight::config {
namespace {

using testing::HasSubstr;

constexpr std::string_view kEgo = "name = \"car\"\n[ego]\nsource = {link = \"can\", interface = \"can0\"}\n";
constexpr std::string_view kRadar =
    "[[radar]]\nid = 2\nname = \"front\"\nprofile = \"ars548\"\n"
    "source = {link = \"udp\", address = \"224.0.2.2\", port = 42102, sender = \"10.13.1.113\"}\n"
    "mounting_pose = {position_m = [3.5, 0.5, 0.6], yaw_deg = 45.0, pitch_deg = 1.0, roll_deg = 180.0}\n";

VehicleConfig read(const std::string& text) {
  return read_vehicle(Reader::parse(text, "car.toml"));
}

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(read(text));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(VehicleFile, ReadsARadar) {
  const VehicleConfig vehicle = read(std::string(kEgo) + std::string(kRadar));
  ASSERT_EQ(vehicle.radars.size(), 1u);
  const RadarConfig* radar = vehicle.radar(2);
  ASSERT_NE(radar, nullptr);
  EXPECT_EQ(radar->name, "front");
  EXPECT_EQ(radar->source.sender, "10.13.1.113");
  EXPECT_EQ(radar->source.port, 42102);
  EXPECT_DOUBLE_EQ(radar->mounting_pose.yaw_rad, M_PI / 4);
  EXPECT_DOUBLE_EQ(radar->mounting_pose.roll_rad, M_PI);
  EXPECT_EQ(vehicle.radar(1), nullptr);
  EXPECT_EQ(vehicle.ego.source.interface, "can0");
}

TEST(VehicleFile, ARadarsStatisticsAreAProfilesNameOrFile) {
  const std::string text = std::string(kEgo) + std::string(kRadar);
  EXPECT_EQ(read(text).radars.at(0).statistics, "series_77ghz");
  EXPECT_EQ(read(text + "statistics = \"can_cluster\"\n").radars.at(0).statistics, "can_cluster");
  EXPECT_EQ(read(text + "statistics = \"./mine.toml\"\n").radars.at(0).statistics, "./mine.toml");
  EXPECT_THAT(error_of(text + "statistics = \"\"\n"), HasSubstr("radar[0].statistics: must be the name"));
  EXPECT_THAT(error_of(text + "statistics = 3\n"), HasSubstr("radar[0].statistics: must be a string"));
}

TEST(VehicleFile, LimitOfUseIsAboveTheToleranceAndTwiceItByDefault) {
  const std::string text = std::string(kEgo) + std::string(kRadar);
  const RadarConfig plain = read(text).radars.at(0);
  EXPECT_NEAR(plain.limit.yaw_rad * 180.0 / M_PI, 3.0, 1e-3);
  EXPECT_NEAR(plain.limit.roll_rad * 180.0 / M_PI, 6.0, 1e-3);
  EXPECT_NEAR(RadarConfig{}.limit.yaw_rad, plain.limit.yaw_rad, 1e-12);
  const RadarConfig stated = read(text + "tolerance = {yaw_deg = 2.0}\nlimit = {pitch_deg = 4.0}\n").radars.at(0);
  EXPECT_NEAR(stated.limit.yaw_rad * 180.0 / M_PI, 4.0, 1e-9);
  EXPECT_NEAR(stated.limit.pitch_rad * 180.0 / M_PI, 4.0, 1e-9);
  const std::string error = error_of(text + "tolerance = {yaw_deg = 2.0}\nlimit = {yaw_deg = 2.0, roll_deg = 31.0}\n");
  EXPECT_THAT(error, HasSubstr("car.toml:11: radar[0].limit.yaw_deg: must be above the tolerance of this axis"));
  EXPECT_THAT(error, HasSubstr("radar[0].limit.roll_deg: 31 is out of range"));
}

TEST(VehicleFile, LobeOfTheAntennaIsAsWideAsTheFieldOfViewByDefault) {
  const std::string text =
      std::string(kEgo) + std::string(kRadar) + "field_of_view = {azimuth_min_deg = -60.0, azimuth_max_deg = 70.0}\n";
  EXPECT_NEAR(read(text).radars.at(0).antenna.azimuth_width_rad * 180.0 / M_PI, 130.0, 1e-9);
  const RadarConfig stated = read(text + "antenna = {azimuth_width_deg = 80.0}\n").radars.at(0);
  EXPECT_NEAR(stated.antenna.azimuth_width_rad * 180.0 / M_PI, 80.0, 1e-9);
  EXPECT_THAT(error_of(text + "antenna = {azimuth_width_deg = 0.0}\n"),
              HasSubstr("antenna.azimuth_width_deg: 0 is out"));
}

TEST(VehicleFile, RegionOfInterestIsEverythingByDefaultAndInOrder) {
  const std::string text = std::string(kEgo) + std::string(kRadar);
  EXPECT_DOUBLE_EQ(read(text).radars.at(0).region_of_interest.azimuth_min_rad, -M_PI);
  EXPECT_DOUBLE_EQ(read(text).radars.at(0).region_of_interest.elevation_max_rad, M_PI / 2.0);
  EXPECT_THAT(error_of(text + "region_of_interest = {azimuth_min_deg = 20.0, azimuth_max_deg = 10.0}\n"),
              HasSubstr("region_of_interest.azimuth_min_deg: must be below azimuth_max_deg"));
  EXPECT_EQ(error_of(text + "region_of_interest = {azimuth_min_deg = 150.0, azimuth_max_deg = 210.0}\n"), "");
}

TEST(VehicleFile, SortsRadarsById) {
  std::string second(kRadar);
  second.replace(second.find("id = 2"), 6, "id = 1");
  second.replace(second.find("front"), 5, "rear_");
  second.replace(second.find("10.13.1.113"), 11, "10.13.1.114");
  second.replace(second.find("[3.5, 0.5"), 9, "[3.5, 0.4");
  const VehicleConfig vehicle = read(std::string(kEgo) + std::string(kRadar) + second);
  ASSERT_EQ(vehicle.radars.size(), 2u);
  EXPECT_EQ(vehicle.radars[0].id, 1u);
}

TEST(VehicleFile, RefusesTwoRadarsOfOneIdNameOrSource) {
  const std::string text = error_of(std::string(kEgo) + std::string(kRadar) + std::string(kRadar));
  EXPECT_THAT(text, HasSubstr("radar[1].id: 2 is already used by front"));
  EXPECT_THAT(text, HasSubstr("radar[1].name"));
  EXPECT_THAT(text, HasSubstr("radar[1].source: is the source of front too"));
  EXPECT_THAT(text, HasSubstr("radar[1].mounting_pose: is that of front too"));
}

TEST(VehicleFile, NeedsARadar) {
  EXPECT_THAT(error_of("radar = []\n" + std::string(kEgo)),
              HasSubstr("radar: has 0 tables; their number must be 1 … 16"));
}

TEST(VehicleFile, NameOfARadarMayHoldBlanksQuotesAndAnyLettersButNoControlCharacters) {
  const auto with_name = [](const std::string& toml) {
    std::string text = std::string(kEgo) + std::string(kRadar);
    return text.replace(text.find("\"front\""), 7, toml);
  };
  EXPECT_EQ(read(with_name(R"("front \"long\", größte")")).radars.at(0).name, "front \"long\", größte");
  EXPECT_THAT(error_of(with_name(R"("front\nleft")")), HasSubstr("radar[0].name: must not contain control characters"));
  EXPECT_THAT(error_of(with_name(R"("a name of more than thirty-one bytes")")), HasSubstr("must have 1 … 31 bytes"));
}

TEST(VehicleFile, RefusesWrongAddressesLinksAndMissingKeys) {
  std::string bad(kRadar);
  bad.replace(bad.find("224.0.2.2"), 9, "radar.lan");
  EXPECT_THAT(error_of(std::string(kEgo) + bad), HasSubstr("\"radar.lan\" is neither an IPv4 nor an IPv6 address"));
  bad = kRadar;
  bad.replace(bad.find("ars548"), 6, "toyota");
  EXPECT_THAT(error_of(std::string(kEgo) + bad), HasSubstr("this profile needs link = \"can\""));
  EXPECT_THAT(error_of(std::string(kEgo) + "[[radar]]\n"), HasSubstr("radar[0].mounting_pose: is missing"));
  EXPECT_THAT(error_of("name = \"x\"\n"), HasSubstr("ego: is missing"));
}

TEST(VehicleFile, OfflineLinksAreOptionalButMustBeValid) {
  const std::string bare =
      "name = \"car\"\n"
      "[[radar]]\nid = 1\nname = \"a\"\nmounting_pose = {position_m = [3.0, 0.0, 0.5], yaw_deg = 10.0}\n"
      "[[radar]]\nid = 2\nname = \"b\"\nmounting_pose = {position_m = [3.0, 0.0, 0.5], yaw_deg = -10.0}\n";
  const VehicleConfig vehicle = read_vehicle(Reader::parse(bare, "car.toml"), VehicleUse::kOffline);
  ASSERT_EQ(vehicle.radars.size(), 2u);
  EXPECT_DOUBLE_EQ(vehicle.radars[0].mounting_pose.yaw_rad, 10.0 * M_PI / 180.0);
  EXPECT_THAT(error_of(bare), HasSubstr("radar[0].source: is missing")) << "for a service they may not";
  std::string twice(kRadar);
  twice.replace(twice.find("id = 2"), 6, "id = 3");
  twice.replace(twice.find("front"), 5, "rear_");
  EXPECT_THROW(static_cast<void>(read_vehicle(Reader::parse("name = \"car\"\n" + std::string(kRadar) + twice, "c"),
                                              VehicleUse::kOffline)),
               Error)
      << "a source that is given is checked";
}

VehicleConfig example_mixed() {
  return read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/example_mixed.toml");
}

TEST(VehicleFile, KnowsEveryKindOfRadar) {
  const VehicleConfig v = example_mixed();
  ASSERT_EQ(v.radars.size(), 7u);
  EXPECT_EQ(v.ego.profile, EgoProfile::kMapping);
  EXPECT_TRUE(std::filesystem::exists(v.ego.mapping)) << "relative to the vehicle file";
  EXPECT_TRUE(v.radar(1)->ego_feed);
  EXPECT_FALSE(v.radar(1)->e2e.required) << "some firmware leaves it at zero";
  EXPECT_EQ(v.radar(2)->source.link, LinkKind::kSomeIp);
  EXPECT_TRUE(v.radar(2)->e2e.required);
  EXPECT_EQ(v.radar(2)->e2e.protection.profile, e2e::Profile::kP07);
  EXPECT_EQ(v.radar(2)->e2e.protection.data_id, 0x42530201u);
  EXPECT_EQ(v.radar(2)->e2e.protection.offset_bytes, 8u);
  EXPECT_EQ(v.radar(2)->source.discovery_port, 30490);
  EXPECT_EQ(v.radar(3)->e2e.protection.data_id, 0x10203u);
  EXPECT_EQ(v.radar(6)->sensor_id, 1u);
  EXPECT_EQ(v.radar(6)->output, Ars408Output::kClusters);
  EXPECT_TRUE(std::filesystem::exists(v.radar(7)->mapping));
}

TEST(VehicleFile, RejectsKeysThatAProfileDoesNotHave) {
  const std::string someip =
      "[[radar]]\nid = 1\nname = \"a\"\nprofile = \"boresight\"\nmounting_pose = {position_m = [0.0, 0.0, 0.0], "
      "yaw_deg "
      "= 0.0}\n";
  const auto with = [&](const std::string& lines) { return error_of(std::string(kEgo) + someip + lines); };
  EXPECT_THAT(with("source = {link = \"someip\", address = \"10.0.0.1\"}\n"), HasSubstr("source.instance: is missing"));
  EXPECT_THAT(with("source = {link = \"someip\", address = \"10.0.0.1\", instance = 0}\n"), HasSubstr("instance"));
  EXPECT_THAT(with("source = {link = \"someip\", address = \"10.0.0.1\", instance = 1, sender = \"10.0.0.2\"}\n"),
              HasSubstr("sender and sender_port are given together"));
  EXPECT_THAT(with("source = {link = \"someip\", address = \"10.0.0.1\", instance = 1, port = 30490}\n"),
              HasSubstr("port of service discovery"));
  const std::string source = "source = {link = \"someip\", address = \"10.0.0.1\", instance = 1}\n";
  EXPECT_THAT(with(source + "e2e = {mode = \"on\"}\n"), HasSubstr("must be one of \"off\", \"required\""));
  EXPECT_THAT(with(source + "e2e = {offset_bytes = 4}\n"), HasSubstr("offset_bytes"));
  EXPECT_THAT(with(source + "sensor_id = 1\n"), HasSubstr("sensor_id"));
  EXPECT_THAT(with(source + "ego_feed = true\n"), HasSubstr("ego_feed"));
  EXPECT_THAT(with(source + "mapping = \"x.toml\"\n"), HasSubstr("for profile = \"mapping\" only"));
}

TEST(VehicleFile, ShippedVehiclesAreValid) {
  const std::filesystem::path folder = std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config" / "vehicle";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    // The car of a recorded table has no links.
    const auto use = entry.path().stem() == "alignment_drive" ? VehicleUse::kOffline : VehicleUse::kLive;
    EXPECT_NO_THROW(static_cast<void>(read_vehicle_file(entry.path(), use))) << entry.path();
  }
}

}  // namespace
}  // namespace boresight::config
