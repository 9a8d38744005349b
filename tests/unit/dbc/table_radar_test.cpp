// Radars by table: the shipped example, and all kinds of begin, end and faults of a cycle.
#include "services/ingest_gateway/codecs/table_radar.hpp"

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/common/e2e/protector.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/ingest_gateway/mapping/mapping_file.hpp"
#include "tests/unit/dbc/bus.hpp"

namespace boresight::ingest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

dbc::Database example_database() {
  std::ifstream stream(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/mappings/example_radar.dbc");
  return dbc::parse_dbc(std::string{std::istreambuf_iterator<char>(stream), {}}, "example_radar.dbc");
}

/// The shipped example of a radar, with the names of its DBC file.
class ExampleRadar : public testing::Test {
 protected:
  void send_header(int near, int far, int counter = 7) {
    bus.send("LIST_HEADER", {{"CYCLE_COUNTER", counter}, {"NUMBER_NEAR", near}, {"NUMBER_FAR", far}});
  }
  void send_place(int number, double range_m, int state = 1) {
    bus.send("DETECTION", {{"NUMBER", number},
                           {"PAGE", 0},
                           {"STATE", state},
                           {"RANGE", range_m},
                           {"AZIMUTH", -10.0},
                           {"ELEVATION", 2.5},
                           {"RANGE_RATE", -3.25}});
  }
  void send_strength(int number, int state = 1) {
    bus.send("DETECTION",
             {{"NUMBER", number}, {"PAGE", 1}, {"STATE", state}, {"RCS", -4.5}, {"SNR", 17.5}, {"EXISTENCE", 80}});
  }
  void send_detection(int number, double range_m, int state = 1) {
    send_place(number, range_m, state);
    send_strength(number, state);
  }

  dbc::Database database = example_database();
  TableRadar decoder{
      read_radar_mapping(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/mappings/example_radar.toml")};
  Bus bus{database, decoder};
};

TEST_F(ExampleRadar, DetectionsOfBothPagesMakeAScan) {
  const std::int64_t begin_ns = bus.now_ns;
  send_header(1, 1, 65535);
  send_detection(40, 123.45);
  EXPECT_THAT(bus.out.scans, IsEmpty());
  send_strength(3);
  send_place(3, 20.0);
  EXPECT_THAT(bus.out.faults, IsEmpty());
  ASSERT_THAT(bus.out.scans, SizeIs(1));
  const RadarScan& scan = *bus.out.scans[0];
  EXPECT_EQ(scan.header.measurement_time_ns, begin_ns);
  EXPECT_EQ(scan.cycle_counter, 65535u);
  EXPECT_EQ(bus.out.counter_bits, 16u);
  EXPECT_EQ(scan.integrity, 0);
  EXPECT_EQ(scan.dropped_detections, 0);
  EXPECT_EQ(scan.fields, scan_field::kElevation | scan_field::kRcs | scan_field::kSnr | scan_field::kExistence);
  ASSERT_EQ(scan.number_of_valid_detections, 2u);  // in the order of their numbers
  EXPECT_FLOAT_EQ(scan.range_m[0], 20.0F);
  EXPECT_FLOAT_EQ(scan.range_m[1], 123.45F);
  EXPECT_NEAR(scan.azimuth_rad[1], 10.0 * kRadiansPerDegree, 1e-6);  // this radar's azimuth is positive to the right
  EXPECT_NEAR(scan.elevation_rad[1], 2.5 * kRadiansPerDegree, 1e-6);
  EXPECT_FLOAT_EQ(scan.range_rate_mps[1], -3.25F);
  EXPECT_FLOAT_EQ(scan.rcs_dbsm[1], -4.5F);
  EXPECT_FLOAT_EQ(scan.snr_db[1], 17.5F);
  EXPECT_FLOAT_EQ(scan.existence_probability[1], 0.8F);
  EXPECT_EQ(scan.detection_flags[1], 0);
  EXPECT_EQ(scan.range_std_m[1], 0.0F);
}

TEST_F(ExampleRadar, EmptyListIsAScanToo) {
  send_header(0, 0);
  ASSERT_THAT(bus.out.scans, SizeIs(1));
  EXPECT_EQ(bus.out.scans[0]->number_of_valid_detections, 0u);
  EXPECT_EQ(bus.out.scans[0]->integrity, 0);
}

TEST_F(ExampleRadar, InvalidDetectionsAreSkipped) {
  send_header(3, 0);
  send_detection(0, 10.0, 0);
  send_detection(1, 11.0, 7);
  send_detection(2, 12.0, 3);
  EXPECT_THAT(bus.out.faults, IsEmpty());
  ASSERT_THAT(bus.out.scans, SizeIs(1));
  ASSERT_EQ(bus.out.scans[0]->number_of_valid_detections, 1u);
  EXPECT_FLOAT_EQ(bus.out.scans[0]->range_m[0], 12.0F);
}

TEST_F(ExampleRadar, NoDetectionOfACycleAppearsInTheNext) {
  send_header(2, 0, 1);
  send_detection(0, 10.0);
  send_detection(1, 11.0);
  send_header(1, 0, 2);
  send_detection(1, 21.0);
  ASSERT_THAT(bus.out.scans, SizeIs(2));
  EXPECT_EQ(bus.out.scans[1]->cycle_counter, 2u);
  ASSERT_EQ(bus.out.scans[1]->number_of_valid_detections, 1u);
  EXPECT_FLOAT_EQ(bus.out.scans[1]->range_m[0], 21.0F);
}

TEST_F(ExampleRadar, LostFrameLeavesTheCycleIncompleteUntilTheNextHeader) {
  send_header(2, 0);
  send_detection(0, 10.0);
  send_place(1, 11.0);  // its second page is lost
  send_header(0, 0);
  ASSERT_THAT(bus.out.scans, SizeIs(2));
  EXPECT_EQ(bus.out.scans[0]->integrity, scan_integrity::kIncomplete);
  ASSERT_EQ(bus.out.scans[0]->number_of_valid_detections, 2u);
  EXPECT_EQ(bus.out.scans[0]->existence_probability[1], 0.0F);
  EXPECT_EQ(bus.out.scans[1]->integrity, 0);
  EXPECT_THAT(bus.out.faults, ElementsAre("frames of a cycle are missing"));
}

TEST_F(ExampleRadar, DetectionWithoutAPositionIsSkipped) {
  send_header(1, 0);
  send_strength(5);
  bus.wait_ms(30);
  ASSERT_THAT(bus.out.scans, SizeIs(1));
  EXPECT_EQ(bus.out.scans[0]->number_of_valid_detections, 0u);
  EXPECT_EQ(bus.out.scans[0]->integrity, scan_integrity::kIncomplete);
}

TEST_F(ExampleRadar, PauseEndsAnIncompleteCycle) {
  send_header(2, 0);
  send_detection(0, 10.0);
  bus.wait_ms(15);
  EXPECT_THAT(bus.out.scans, IsEmpty());
  bus.wait_ms(10);
  ASSERT_THAT(bus.out.scans, SizeIs(1));
  EXPECT_EQ(bus.out.scans[0]->integrity, scan_integrity::kIncomplete);
  bus.wait_ms(1000);
  EXPECT_THAT(bus.out.scans, SizeIs(1));
}

TEST_F(ExampleRadar, DetectionsWithoutTheirHeaderAreRejectedAndReportedOnce) {
  send_detection(0, 10.0);
  send_detection(1, 10.0);
  EXPECT_THAT(bus.out.scans, IsEmpty());
  EXPECT_THAT(bus.out.faults, ElementsAre("detections without their header"));
  send_header(1, 0);
  send_detection(0, 10.0);
  EXPECT_THAT(bus.out.scans, SizeIs(1));
  EXPECT_THAT(bus.out.faults, SizeIs(1));
}

TEST_F(ExampleRadar, NumbersBeyondTheMappedOnesAreFaults) {
  send_header(2, 0);
  send_place(64, 10.0);
  EXPECT_THAT(bus.out.faults, ElementsAre("number of a detection exceeds the mapped ones"));
  send_header(200, 100);
  EXPECT_THAT(bus.out.faults, testing::Contains("number of detections in the header exceeds the mapped ones"));
}

TEST_F(ExampleRadar, NotANumberIsFlagged) {
  send_header(2, 0);
  for (const int number : {0, 1}) {
    auto payload = bus.payload("DETECTION", {{"NUMBER", number}, {"STATE", 1}, {"RANGE", 10.0}});
    const double rate = number == 0 ? std::numeric_limits<double>::quiet_NaN() : 1e30;
    put_bits(*database.find("DETECTION")->find("RANGE_RATE"), std::bit_cast<std::uint32_t>(static_cast<float>(rate)),
             payload);
    bus.send_bytes("DETECTION", payload);
    send_strength(number);
  }
  ASSERT_THAT(bus.out.scans, SizeIs(1));
  const RadarScan& scan = *bus.out.scans[0];
  ASSERT_EQ(scan.number_of_valid_detections, 2u);
  EXPECT_EQ(scan.range_rate_mps[0], 0.0F);
  EXPECT_EQ(scan.detection_flags[0], detection_flag::kUnusable);
  EXPECT_EQ(scan.detection_flags[1], detection_flag::kUnusable);
}

TEST_F(ExampleRadar, ShortFramesAreFaultsAndLongOnesArePadded) {
  send_header(1, 0);
  auto payload = bus.payload("DETECTION", {{"NUMBER", 1}, {"STATE", 1}, {"RANGE", 10.0}});
  payload.resize(15);
  bus.send_bytes("DETECTION", payload);
  EXPECT_THAT(bus.out.faults, ElementsAre("DETECTION: frame is shorter than 16 bytes"));
  payload.resize(24, 0xCC);
  bus.send_bytes("DETECTION", payload);
  send_strength(1);
  EXPECT_THAT(bus.out.scans, SizeIs(1));
}

TEST_F(ExampleRadar, FramesWithOtherIdsAndRemoteFramesAreIgnored) {
  recording::Frame frame;
  const std::vector<std::uint8_t> payload(16);
  frame.payload = payload;
  for (const std::uint32_t id : {0u, 767u, 770u}) {
    frame.can_id = id;
    decoder.take(frame, {}, bus.out);
  }
  frame.can_id = 768;
  frame.can_extended = true;
  decoder.take(frame, {}, bus.out);
  frame.can_extended = false;
  frame.can_remote = true;
  decoder.take(frame, {}, bus.out);
  bus.wait_ms(1000);
  EXPECT_THAT(bus.out.scans, IsEmpty());
  EXPECT_THAT(bus.out.faults, IsEmpty());
}

TEST_F(ExampleRadar, ScanWithoutMemoryIsLostAlone) {
  bus.out.refuse_memory = true;
  send_header(1, 0);
  send_detection(0, 10.0);
  bus.out.refuse_memory = false;
  send_header(1, 0);
  send_detection(1, 11.0);
  ASSERT_THAT(bus.out.scans, SizeIs(1));
  EXPECT_EQ(bus.out.scans[0]->number_of_valid_detections, 1u);
}

/// A radar with a DBC text and a mapping of the test.
struct OwnRadar {
  OwnRadar(const std::string& dbc, const std::string& mapping)
      : database(dbc::parse_dbc(dbc, "t.dbc")),
        decoder(read_radar_mapping(config::Reader::parse("kind = \"radar\"\ndbc = \"t\"\n" + mapping, "t.toml"),
                                   [this](const std::string&) { return database; })) {
    EXPECT_THAT(database.problems, IsEmpty());
  }
  dbc::Database database;
  TableRadar decoder;
  Bus bus{database, decoder};
};

std::string cartesian_message(int id, const std::string& name) {
  return "BO_ " + std::to_string(id) + " " + name + ": 8 R\n" +
         " SG_ X : 0|16@1- (0.01,0) [0|0] \"m\" X\n SG_ Y : 16|16@1- (0.01,0) [0|0] \"m\" X\n"
         " SG_ VX : 32|12@1- (0.1,0) [0|0] \"m/s\" X\n SG_ VY : 44|12@1- (0.1,0) [0|0] \"m/s\" X\n"
         " SG_ C : 56|4@1+ (1,0) [0|0] \"\" X\n";
}

constexpr const char* kCartesian = R"([detections.signals]
longitudinal = { signal = "X" }
lateral = { signal = "Y" }
velocity_longitudinal = { signal = "VX" }
velocity_lateral = { signal = "VY" }
)";

TEST(TableRadar, RangeRateIsTheVelocityAlongTheLineOfSight) {
  OwnRadar radar(cartesian_message(1, "T"), std::string(R"([cycle]
end = "all_messages"
[[detections]]
[[detections.message]]
name = "T"
)") + kCartesian);
  radar.bus.send("T", {{"X", 30.0}, {"Y", -40.0}, {"VX", -10.0}, {"VY", 5.0}});
  ASSERT_THAT(radar.bus.out.scans, SizeIs(1));
  const RadarScan& scan = *radar.bus.out.scans[0];
  EXPECT_FLOAT_EQ(scan.range_m[0], 50.0F);
  EXPECT_NEAR(scan.azimuth_rad[0], std::atan2(-40.0, 30.0), 1e-6);
  EXPECT_FLOAT_EQ(scan.range_rate_mps[0], -10.0F);  // (30 · −10 + −40 · 5) / 50
  EXPECT_EQ(scan.existence_probability[0], 1.0F);
  EXPECT_EQ(scan.fields, 0u);
  EXPECT_EQ(radar.bus.out.counter_bits, 0u);
}

TEST(TableRadar, OrderOfArrivalAndALastMessage) {
  OwnRadar radar(cartesian_message(1, "T") + "BO_ 2 END: 1 R\n", std::string(R"(id_offset = 32
[cycle]
end = "last_message"
last_message = "END"
[[detections]]
slot_by = "arrival"
slots = 2
[[detections.message]]
name = "T"
)") + kCartesian);
  radar.bus.id_offset = 32;
  radar.bus.send("T", {{"X", 2.0}});
  radar.bus.send("T", {{"X", 1.0}});
  radar.bus.send("T", {{"X", 3.0}});
  radar.bus.send("END", {});
  ASSERT_THAT(radar.bus.out.scans, SizeIs(1));
  const RadarScan& scan = *radar.bus.out.scans[0];
  ASSERT_EQ(scan.number_of_valid_detections, 2u);
  EXPECT_FLOAT_EQ(scan.range_m[0], 2.0F);
  EXPECT_FLOAT_EQ(scan.range_m[1], 1.0F);
  EXPECT_EQ(scan.dropped_detections, 1);
  EXPECT_EQ(scan.integrity, 0);
  EXPECT_THAT(radar.bus.out.faults, ElementsAre("more detections in a cycle than mapped"));
  radar.bus.send("END", {});
  ASSERT_THAT(radar.bus.out.scans, SizeIs(2));
  EXPECT_EQ(radar.bus.out.scans[1]->number_of_valid_detections, 0u);
  EXPECT_EQ(radar.bus.out.scans[1]->dropped_detections, 0);
}

TEST(TableRadar, TimeoutAsTheRegularEndAndARepeatedFrameAsTheIrregularOne) {
  OwnRadar radar(cartesian_message(1, "T_01") + cartesian_message(2, "T_02"), std::string(R"([cycle]
end = "timeout"
timeout_ms = 5
[[detections]]
index = [1, 2]
counter = "C"
[[detections.message]]
name = "T_{:02}"
)") + kCartesian);
  radar.bus.send("T_02", {{"X", 2.0}, {"C", 9}});
  radar.bus.wait_ms(6);
  ASSERT_THAT(radar.bus.out.scans, SizeIs(1));
  EXPECT_EQ(radar.bus.out.scans[0]->integrity, 0);
  EXPECT_EQ(radar.bus.out.scans[0]->cycle_counter, 9u);
  EXPECT_EQ(radar.bus.out.counter_bits, 4u);
  radar.bus.send("T_02", {{"X", 2.0}, {"C", 10}});
  radar.bus.send("T_02", {{"X", 3.0}, {"C", 11}});
  ASSERT_THAT(radar.bus.out.scans, SizeIs(2));
  EXPECT_EQ(radar.bus.out.scans[1]->integrity, scan_integrity::kIncomplete);
  EXPECT_EQ(radar.bus.out.scans[1]->cycle_counter, 10u);
}

TEST(TableRadar, TwoGroupsOfDetectionsInOneScan) {
  OwnRadar radar(cartesian_message(1, "NEAR_0") + cartesian_message(2, "NEAR_1") + cartesian_message(9, "FAR_0"),
                 std::string(R"([cycle]
end = "all_messages"
[[detections]]
index = [0, 1]
[[detections.message]]
name = "NEAR_{}"
)") + kCartesian + R"([[detections]]
index = [0, 0]
[[detections.message]]
names = ["FAR_0"]
)" + kCartesian);
  radar.bus.send("FAR_0", {{"X", 90.0}});
  radar.bus.send("NEAR_1", {{"X", 2.0}});
  radar.bus.send("NEAR_0", {{"X", 1.0}});
  ASSERT_THAT(radar.bus.out.scans, SizeIs(1));
  const RadarScan& scan = *radar.bus.out.scans[0];
  ASSERT_EQ(scan.number_of_valid_detections, 3u);
  EXPECT_FLOAT_EQ(scan.range_m[0], 1.0F);
  EXPECT_FLOAT_EQ(scan.range_m[2], 90.0F);
}

// One message: the switch is the number of the detection, and every detection has its own signals.
TEST(TableRadar, MultiplexedByIndexAndOneLevelDeeper) {
  std::string dbc =
      "BO_ 2147483649 D: 16 R\n SG_ N M : 0|8@1+ (1,0) [0|0] \"\" X\n SG_ SUB m2M : 8|8@1+ (1,0) [0|0] \"\" X\n";
  for (const int n : {0, 1, 2}) {
    const std::string i = std::to_string(n), mux = n == 2 ? "m5" : "m" + i;
    dbc += " SG_ R_" + i + " " + mux + " : 16|16@1+ (0.01,0) [0|0] \"m\" X\n";
    dbc += " SG_ A_" + i + " " + mux + " : 39|16@0- (0.01,0) [0|0] \"deg\" X\n";
    dbc += " SG_ V_" + i + " m" + i + " : 64|64@1- (1,0) [0|0] \"m/s\" X\n";
  }
  dbc += "SG_MUL_VAL_ 2147483649 R_2 SUB 5-6, 9-9;\nSG_MUL_VAL_ 2147483649 A_2 SUB 5-6, 9-9;\n";
  for (const int n : {0, 1, 2}) dbc += "SIG_VALTYPE_ 2147483649 V_" + std::to_string(n) + " : 2;\n";
  OwnRadar radar(dbc, R"([cycle]
end = "all_messages"
[[detections]]
index = [0, 2]
[[detections.message]]
name = "D"
[detections.signals]
range = { signal = "R_{}" }
azimuth = { signal = "A_{}" }
range_rate = { signal = "V_{}" }
)");
  radar.bus.send("D", {{"N", 1}, {"R_1", 11.0}, {"A_1", -1.0}, {"V_1", 0.125}});
  radar.bus.send("D", {{"N", 0}, {"R_0", 10.0}, {"A_0", 1.0}, {"V_0", -0.125}});
  radar.bus.send("D", {{"N", 7}, {"R_0", 99.0}});              // not used
  radar.bus.send("D", {{"N", 2}, {"SUB", 7}, {"R_2", 99.0}});  // not used either
  EXPECT_THAT(radar.bus.out.scans, IsEmpty());
  radar.bus.send("D", {{"N", 2}, {"SUB", 9}, {"R_2", 12.0}, {"A_2", 2.0}, {"V_2", 1e-3}});
  EXPECT_THAT(radar.bus.out.faults, IsEmpty());
  ASSERT_THAT(radar.bus.out.scans, SizeIs(1));
  const RadarScan& scan = *radar.bus.out.scans[0];
  ASSERT_EQ(scan.number_of_valid_detections, 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(scan.range_m[i], 10.0F + static_cast<float>(i)) << i;
  EXPECT_NEAR(scan.azimuth_rad[2], 2.0 * kRadiansPerDegree, 1e-6);
  EXPECT_FLOAT_EQ(scan.range_rate_mps[2], 1e-3F);
}

TEST(TableRadar, ProtectedFramesAreUsedOnlyIfInOrder) {
  OwnRadar radar(cartesian_message(1, "T") +
                     "BO_ 2 H: 8 R\n SG_ CRC : 0|16@1+ (1,0) [0|0] \"\" X\n SG_ NUMBER : 24|8@1+ (1,0) [0|0] \"\" X\n",
                 std::string(R"([cycle]
end = "count"
[header]
message = "H"
counts = ["NUMBER"]
e2e = { profile = "P05", data_id = 0x1234 }
[[detections]]
slot_by = "arrival"
slots = 4
[[detections.message]]
name = "T"
)") + kCartesian);
  e2e::Config config;
  config.profile = e2e::Profile::kP05;
  config.data_id = 0x1234;
  e2e::Protector protector(config);
  const auto header = [&] {
    auto payload = radar.bus.payload("H", {{"NUMBER", 0}});
    EXPECT_TRUE(protector.protect(payload));
    return payload;
  };
  const auto first = header();
  radar.bus.send_bytes("H", first);
  EXPECT_THAT(radar.bus.out.scans, SizeIs(1));
  radar.bus.send_bytes("H", first);
  EXPECT_THAT(radar.bus.out.faults, ElementsAre("H: E2E: repeated"));
  auto damaged = header();
  damaged[7] ^= 1;
  radar.bus.send_bytes("H", damaged);
  EXPECT_THAT(radar.bus.out.faults, ElementsAre("H: E2E: repeated", "H: E2E: wrong CRC"));
  EXPECT_THAT(radar.bus.out.scans, SizeIs(1));
}

}  // namespace
}  // namespace boresight::ingest
