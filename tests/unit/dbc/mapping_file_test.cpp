// Mapping files: the shipped example, and the errors of invalid files.
#include "services/ingest_gateway/mapping/mapping_file.hpp"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boresight::ingest {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const std::filesystem::path kExamples = std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/mappings";

constexpr std::string_view kDbc = R"(BO_ 528 TRACK_A_0: 8 R
 SG_ COUNTER : 7|8@0+ (1,0) [0|0] "" X
 SG_ LONG_DIST : 15|15@0+ (0.01,0) [0|0] "m" X
 SG_ LAT_DIST : 31|11@0- (0.04,0) [0|0] "" X
 SG_ REL_SPEED : 47|12@0- (0.025,0) [0|0] "m/s" X
BO_ 529 TRACK_A_1: 8 R
 SG_ COUNTER : 7|8@0+ (1,0) [0|0] "" X
 SG_ LONG_DIST : 15|15@0+ (0.01,0) [0|0] "m" X
 SG_ LAT_DIST : 31|11@0- (0.04,0) [0|0] "" X
 SG_ REL_SPEED : 47|12@0- (0.025,0) [0|0] "m/s" X
BO_ 544 TRACK_B_0: 6 R
 SG_ COUNTER : 7|8@0+ (1,0) [0|0] "" X
 SG_ SCORE : 23|8@0+ (1,0) [0|0] "" X
BO_ 545 TRACK_B_1: 6 R
 SG_ COUNTER : 7|8@0+ (1,0) [0|0] "" X
 SG_ SCORE : 23|8@0+ (1,0) [0|0] "" X
BO_ 600 EMPTY: 0 R
)";

constexpr std::string_view kRadar = R"(kind = "radar"
dbc = "x.dbc"
[cycle]
end = "all_messages"
[[detections]]
index = [0, 1]
counter = "COUNTER"
[[detections.message]]
name = "TRACK_A_{}"
[[detections.message]]
name = "TRACK_B_{}"
[detections.signals]
longitudinal = { signal = "LONG_DIST" }
lateral = { signal = "LAT_DIST", unit = "m" }
range_rate = { signal = "REL_SPEED" }
existence = { signal = "SCORE", unit = "%" }
)";

constexpr std::string_view kEgo = R"(kind = "ego"
dbc = "x.dbc"
[speed]
message = "TRACK_A_0"
signals = ["REL_SPEED"]
[reverse]
message = "TRACK_A_1"
signal = "COUNTER"
is = [1, 2]
)";

dbc::Database load(const std::string&) {
  return dbc::parse_dbc(kDbc, "x.dbc");
}

/// The text with one existing part replaced.
std::string with(std::string_view text, std::string_view old, std::string_view replacement) {
  std::string changed(text);
  const std::size_t at = changed.find(old);
  if (at == std::string::npos) {
    ADD_FAILURE() << "not in the mapping: " << old;
    return changed;
  }
  return changed.replace(at, old.size(), replacement);
}

std::string error_of(const std::string& text) {
  try {
    const config::Reader root = config::Reader::parse(text, "m.toml");
    if (text.find("\"ego\"") != std::string::npos) {
      static_cast<void>(read_ego_mapping(root, load));
    } else {
      static_cast<void>(read_radar_mapping(root, load));
    }
  } catch (const config::Error& error) {
    return error.what();
  }
  return "";
}

std::string radar_error(std::string_view old, std::string_view replacement) {
  return error_of(with(kRadar, old, replacement));
}

std::string ego_error(std::string_view old, std::string_view replacement) {
  return error_of(with(kEgo, old, replacement));
}

TEST(MappingFile, ShippedExamplesAreRead) {
  const dbc::RadarMapping radar = read_radar_mapping(kExamples / "example_radar.toml");
  EXPECT_THAT(radar.warnings, IsEmpty());
  EXPECT_THAT(radar.messages, SizeIs(2));
  EXPECT_THAT(radar.parts_of_slot, SizeIs(64));
  EXPECT_EQ(radar.parts_of_slot[63], 3);  // two pages
  EXPECT_EQ(radar.counter_bits, 16u);
  EXPECT_TRUE(radar.header_begins_cycle);
  const dbc::EgoMapping ego = read_ego_mapping(kExamples / "example_ego.toml");
  ASSERT_THAT(ego.messages, SizeIs(2));
  EXPECT_FALSE(ego.messages[0].pulses);
  ASSERT_TRUE(ego.messages[1].pulses);
  EXPECT_TRUE(ego.messages[1].frame.extended);
  EXPECT_EQ(ego.messages[1].frame.protection.profile, e2e::Profile::kP11);
}

TEST(MappingFile, NamesAreResolvedForEveryIndex) {
  const dbc::RadarMapping mapping = read_radar_mapping(config::Reader::parse(kRadar, "m.toml"), load);
  ASSERT_THAT(mapping.messages, SizeIs(4));
  EXPECT_EQ(mapping.messages[1].frame.id, 529u);
  EXPECT_EQ(mapping.messages[1].parts.at(0).slot, 1);
  EXPECT_EQ(mapping.messages[3].parts.at(0).slot, 1);
  EXPECT_EQ(mapping.messages[3].parts.at(0).part_bit, 2);
  EXPECT_EQ(mapping.counter_bits, 8u);
  for (const dbc::RadarMessage& message : mapping.messages) EXPECT_TRUE(message.counter);
}

TEST(MappingFile, UnknownNameIsReportedWithSimilarOnes) {
  EXPECT_THAT(radar_error("TRACK_A_{}", "TRAC_A_{}"),
              HasSubstr("m.toml:9: detections[0].message[0].name: there is no message \"TRAC_A_0\" in the DBC file; "
                        "similar: \"TRACK_A_0\", \"TRACK_A_1\", \"TRACK_B_0\""));
  EXPECT_THAT(radar_error("[0, 1]", "[0, 2]"), HasSubstr("there is no message \"TRACK_A_2\""));
  EXPECT_THAT(radar_error("LONG_DIST", "LONG_DST"),
              HasSubstr("m.toml:13: detections[0].signals.longitudinal.signal: there is no signal \"LONG_DST\" in "
                        "\"TRACK_A_0\", \"TRACK_B_0\"; similar: \"LONG_DIST\""));
  EXPECT_THAT(ego_error("[\"REL_SPEED\"]", "[\"REL_SPEED\", \"SPEED\"]"),
              HasSubstr("m.toml:5: speed.signals: there is no signal \"SPEED\" in \"TRACK_A_0\""));
}

TEST(MappingFile, SignalInTwoMessagesNeedsTheMessagesNumber) {
  EXPECT_THAT(
      radar_error("\"SCORE\"", "\"COUNTER\""),
      HasSubstr("signal \"COUNTER\" is in the messages \"TRACK_A_0\" and \"TRACK_B_0\"; choose one: message = 1 "
                "or 2"));
  EXPECT_THAT(radar_error("\"SCORE\", unit", "\"COUNTER\", message = 2, unit"), IsEmpty());
  EXPECT_THAT(radar_error("\"SCORE\"", "\"SCORE\", message = 3"), HasSubstr("existence.message: must be 1 … 2"));
}

TEST(MappingFile, UnitMustBeKnown) {
  EXPECT_THAT(radar_error(", unit = \"m\"", ""),
              HasSubstr("m.toml:14: detections[0].signals.lateral: unit of \"LAT_DIST\" is not in the DBC file; unit "
                        "must be one of \"m\", \"cm\", \"mm\", \"km\", \"ft\""));
  EXPECT_THAT(radar_error("unit = \"m\"", "unit = \"deg\""), HasSubstr("\"deg\" is unknown; must be one of \"m\""));
  EXPECT_THAT(radar_error("unit = \"%\"", "unit = \"%\", factor = 0"), HasSubstr("existence.factor: must not be 0"));
}

TEST(MappingFile, UnknownKeysAreErrors) {
  EXPECT_THAT(radar_error("counter =", "conter ="), HasSubstr("m.toml:7: detections[0].conter: unknown key"));
  EXPECT_THAT(radar_error("existence =", "exists ="),
              HasSubstr("m.toml:16: detections[0].signals.exists: unknown key"));
  EXPECT_THAT(radar_error("existence =", "exists ="), HasSubstr("range_rate_std"));
  EXPECT_THAT(ego_error("[reverse]", "[revers]"), HasSubstr("m.toml:6: revers: unknown key"));
}

TEST(MappingFile, QuantitiesMustMakeAPositionAndARangeRate) {
  EXPECT_THAT(radar_error("lateral", "range"), HasSubstr("needs either range and azimuth (and elevation), or"));
  EXPECT_THAT(radar_error("range_rate =", "velocity_lateral ="),
              HasSubstr("needs either range_rate or velocity_longitudinal"));
  EXPECT_THAT(radar_error("range_rate =", "velocity_lateral ="), HasSubstr("velocity_lateral needs"));
  EXPECT_THAT(radar_error("existence =", "elevation ="), HasSubstr("needs either range and azimuth"));
}

TEST(MappingFile, CycleMustBeAbleToEnd) {
  EXPECT_THAT(radar_error("all_messages", "count"), HasSubstr("m.toml:4: cycle.end: \"count\" needs a table header"));
  EXPECT_THAT(radar_error("all_messages", "last_message"), HasSubstr("cycle.last_message: is missing"));
  EXPECT_THAT(radar_error("end = \"all_messages\"", "end = \"timeout\"\nlast_message = \"TRACK_A_0\""),
              HasSubstr("cycle.last_message: is allowed with end = \"last_message\" only"));
  EXPECT_THAT(radar_error("index = [0, 1]", "slot_by = \"arrival\"\nslots = 4"),
              HasSubstr("a cycle that ends with all_messages needs \"index\""));
  EXPECT_THAT(radar_error("[[detections]]", "[header]\nmessage = \"TRACK_A_0\"\ncounts = [\"NO\"]\n[[detections]]"),
              HasSubstr("header.counts: there is no signal \"NO\""));
  const std::string trailer = with(kRadar, "end = \"all_messages\"", "end = \"count\"");
  EXPECT_THAT(error_of(with(trailer, "[[detections]]",
                            "[header]\nmessage = \"TRACK_B_1\"\ncounts = [\"SCORE\"]\n[[detections]]")),
              IsEmpty());
}

TEST(MappingFile, SlotsMustFit) {
  EXPECT_THAT(radar_error("[0, 1]", "[0, 1024]"), HasSubstr("must be [first, last] with at most 1024 numbers"));
  EXPECT_THAT(radar_error("[0, 1]", "[1, 0]"), HasSubstr("must be [first, last]"));
  EXPECT_THAT(radar_error("[0, 1]", "[0]"), HasSubstr("index: has 1 elements; must be"));
  EXPECT_THAT(radar_error("index = [0, 1]", "slots = 2"), HasSubstr("slots: is allowed with slot_by"));
  EXPECT_THAT(radar_error("name = \"TRACK_B_{}\"", "names = [\"TRACK_B_0\"]"), HasSubstr("has 1 names for 2 indices"));
  EXPECT_THAT(radar_error("name = \"TRACK_B_{}\"", "names = [\"TRACK_B_0\", \"TRACK_B_1\"]"), IsEmpty());
  EXPECT_THAT(radar_error("TRACK_B_{}", "TRACK_B_{x}"), HasSubstr("braces must be {}"));
  EXPECT_THAT(radar_error("existence = { signal = \"SCORE\", unit = \"%\" }", ""),
              HasSubstr("m.toml:10: detections[0].message[1]: no signal is taken from \"TRACK_B_0\""));
}

TEST(MappingFile, ProtectionMustFitItsMessage) {
  const auto protect = [](std::string_view keys) {
    return radar_error("\"TRACK_B_{}\"", "\"TRACK_B_{}\"\ne2e = { " + std::string(keys) + " }");
  };
  EXPECT_THAT(protect("profile = \"P05\", data_ids = [1, 2]"), IsEmpty());
  EXPECT_THAT(protect("profile = \"P05\", data_id = 1, offset_bytes = 4"),
              HasSubstr("E2E header does not fit into \"TRACK_B_0\""));
  EXPECT_THAT(protect("profile = \"P05\", data_ids = [1]"), HasSubstr("data_ids: has 1 elements"));
  EXPECT_THAT(protect("profile = \"P05\""), HasSubstr("needs either data_id, or data_ids"));
  EXPECT_THAT(protect("profile = \"P02\", data_id = 1"), HasSubstr("profiles P02 and P22 need data_id_list"));
  EXPECT_THAT(protect("profile = \"P07\", data_id = 1"), HasSubstr("must be one of \"P01\", \"P02\", \"P05\""));
  EXPECT_THAT(protect("profile = \"P11\", data_id = 1, data_id_mode = \"low\""),
              HasSubstr("data_id_mode of profile 11"));
}

TEST(MappingFile, IdOffsetMovesEveryMessage) {
  const dbc::RadarMapping mapping =
      read_radar_mapping(config::Reader::parse(with(kRadar, "[cycle]", "id_offset = 16\n[cycle]"), "m.toml"), load);
  EXPECT_EQ(mapping.messages.front().frame.id, 544u);
  EXPECT_THAT(radar_error("[cycle]", "id_offset = 2000\n[cycle]"), HasSubstr("is out of range with id_offset"));
}

TEST(MappingFile, EgoMappingMustBeComplete) {
  EXPECT_THAT(error_of(std::string(kEgo)), IsEmpty());
  EXPECT_THAT(ego_error("[speed]", "[yaw_rate]"), HasSubstr("needs either a table speed or a table pulses"));
  EXPECT_THAT(ego_error("is = [1, 2]", ""), HasSubstr("reverse: needs either is or is_not"));
  EXPECT_THAT(ego_error("\"x.dbc\"", "\"\""), HasSubstr("m.toml:2: dbc: is empty"));
  EXPECT_THAT(ego_error("\"TRACK_A_0\"", "\"\""), HasSubstr("speed.message: is empty"));
  EXPECT_THAT(ego_error("\"COUNTER\"", "\"\""), HasSubstr("reverse.signal: there is no signal \"\""));
  EXPECT_THAT(ego_error("is = [1, 2]", "is = []"), HasSubstr("reverse.is: has 0 elements"));
  EXPECT_THAT(ego_error("[\"REL_SPEED\"]", "[]"), HasSubstr("speed.signals: has 0 elements; must have 1 … 8"));
  EXPECT_THAT(ego_error("signals = [", "plausible_mps = [5, 5]\nsignals = ["),
              HasSubstr("the first number must be less than the second"));
  EXPECT_THAT(ego_error("[speed]", "[pulses]\nmetres_per_pulse = 0.1"),
              HasSubstr("\"REL_SPEED\" must be an unsigned integer"));
  EXPECT_THAT(ego_error("message = \"TRACK_A_1\"", "message = \"TRACK_A_0\"\nchecksum = \"toyota\""),
              HasSubstr("\"TRACK_A_0\" is named above; give its checksum and e2e there"));
  EXPECT_THAT(ego_error("\"TRACK_A_1\"", "\"EMPTY\""), HasSubstr("message \"EMPTY\" has no bytes"));
}

TEST(MappingFile, WrongKindOrMissingDatabaseIsOneError) {
  const auto refuse = [](const std::string&) -> dbc::Database { throw config::Error("x.dbc cannot be read"); };
  try {
    static_cast<void>(read_radar_mapping(config::Reader::parse(kRadar, "m.toml"), refuse));
    FAIL();
  } catch (const config::Error& error) {
    EXPECT_STREQ(error.what(), "m.toml:2: dbc: x.dbc cannot be read");
  }
  EXPECT_THAT(radar_error("\"radar\"", "\"camera\""),
              HasSubstr("m.toml:1: kind: is \"camera\", but a mapping of kind \"radar\" is needed"));
  try {
    static_cast<void>(read_ego_mapping(kExamples / "example_radar.toml"));
    FAIL();
  } catch (const config::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("but a mapping of kind \"ego\" is needed"));
  }
}

}  // namespace
}  // namespace boresight::ingest
