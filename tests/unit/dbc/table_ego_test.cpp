// Ego signals by table: the shipped example with wheel pulses and E2E, and speeds with and without a sign.
#include "services/ingest_gateway/codecs/table_ego.hpp"

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

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
const std::filesystem::path kEgoExamples = std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/mappings";

/// The shipped example of ego signals.
class ExampleEgo : public testing::Test {
 protected:
  ExampleEgo() {
    e2e::Config config;
    config.profile = e2e::Profile::kP11;
    config.data_id = 0x1A2;
    config.data_id_mode = e2e::DataIdMode::kNibble;
    protector.emplace(config);
  }
  /// Rear wheel pulses by the distances since the start; gear 3 is forward.
  void send_wheels(double left_m, double right_m, int gear = 3) {
    const auto pulses = [](double metres) { return std::floor(metres / 0.0205); };
    auto payload = bus.payload("WHEELS", {{"PULSES_REAR_LEFT", std::fmod(pulses(left_m), 1000.0)},
                                          {"PULSES_REAR_RIGHT", std::fmod(pulses(right_m), 1000.0)},
                                          {"GEAR", gear}});
    EXPECT_TRUE(protector->protect(payload));
    bus.send_bytes("WHEELS", payload);
  }
  /// Drives straight at this speed, with a frame every 20 ms.
  void drive(double speed_mps, int frames) {
    for (int i = 0; i < frames; ++i) {
      send_wheels(distance_m, distance_m);
      bus.now_ns += 20'000'000 - 100'000;
      distance_m += speed_mps * 0.02;
    }
  }
  [[nodiscard]] std::vector<double> speeds() const {
    std::vector<double> found;
    for (const Recorder::Ego& ego : bus.out.egos) {
      if (ego.reading.speed_mps) found.push_back(*ego.reading.speed_mps);
    }
    return found;
  }

  dbc::Database database = [] {
    std::ifstream stream(kEgoExamples / "example_radar.dbc");
    return dbc::parse_dbc(std::string{std::istreambuf_iterator<char>(stream), {}}, "example_radar.dbc");
  }();
  TableEgo decoder{read_ego_mapping(kEgoExamples / "example_ego.toml")};
  Bus bus{database, decoder};
  std::optional<e2e::Protector> protector;
  double distance_m = 0.0;
};

TEST_F(ExampleEgo, PulsesMakeASpeedAcrossTheirWrap) {
  drive(30.0, 200);  // 120 m are six wraps
  EXPECT_THAT(bus.out.faults, IsEmpty());
  ASSERT_THAT(speeds(), SizeIs(testing::Ge(190u)));
  // Two pulses more or less in 100 ms.
  EXPECT_THAT(speeds(), Each(testing::DoubleNear(30.0, 0.9)));
  double sum = 0.0;
  for (const double speed : speeds()) sum += speed;
  EXPECT_NEAR(sum / static_cast<double>(speeds().size()), 30.0, 0.05);
}

TEST_F(ExampleEgo, SpeedFromPulsesIsThatOfTheMiddleOfItsWindow) {
  double speed_mps = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double time_s = 0.02 * i;
    speed_mps = 2.0 * time_s;
    distance_m = time_s * time_s;
    send_wheels(distance_m, distance_m);
    bus.now_ns += 20'000'000 - 100'000;
  }
  EXPECT_GT(speed_mps, 11.0);
  std::size_t compared = 0;
  for (const Recorder::Ego& ego : bus.out.egos) {
    if (!ego.reading.speed_mps) continue;
    const double time_s = static_cast<double>(ego.stamp_ns - 1'000'000'000) * 1e-9;
    EXPECT_NEAR(*ego.reading.speed_mps, 2.0 * time_s, 0.45) << time_s;
    ++compared;
  }
  EXPECT_GT(compared, 280u);
}

TEST_F(ExampleEgo, PauseOrJumpOfTheCountersStartsAgain) {
  drive(10.0, 20);
  const std::size_t before = speeds().size();
  bus.now_ns += 600'000'000;  // a counter could have wrapped at 70 m/s
  distance_m += 6.0;
  drive(10.0, 1);
  EXPECT_THAT(speeds(), SizeIs(before));
  EXPECT_THAT(bus.out.faults, IsEmpty());
  drive(10.0, 20);
  const std::size_t middle = speeds().size();
  EXPECT_GT(middle, before + 10);
  distance_m += 8.0;  // in 20 ms
  drive(10.0, 1);
  EXPECT_THAT(speeds(), SizeIs(middle));
  EXPECT_THAT(bus.out.faults, ElementsAre("wheel pulses exceed the greatest plausible speed"));
  drive(10.0, 20);
  EXPECT_THAT(speeds(), Each(testing::DoubleNear(10.0, 0.9)));
}

TEST_F(ExampleEgo, StandstillIsASpeedOfZero) {
  drive(0.0, 20);
  ASSERT_THAT(speeds(), SizeIs(testing::Ge(10u)));
  EXPECT_THAT(speeds(), Each(0.0));
}

TEST_F(ExampleEgo, GearGivesTheDirection) {
  send_wheels(0.0, 0.0, 1);
  send_wheels(0.0, 0.0, 3);
  ASSERT_THAT(bus.out.egos, SizeIs(2));
  EXPECT_EQ(bus.out.egos[0].reading.reverse, true);
  EXPECT_EQ(bus.out.egos[1].reading.reverse, false);
  EXPECT_FALSE(bus.out.egos[0].reading.speed_mps);
}

TEST_F(ExampleEgo, DamagedFrameIsRejected) {
  auto payload = bus.payload("WHEELS", {{"GEAR", 1}});
  ASSERT_TRUE(protector->protect(payload));
  payload[6] ^= 0x10;
  bus.send_bytes("WHEELS", payload);
  EXPECT_THAT(bus.out.egos, IsEmpty());
  EXPECT_THAT(bus.out.faults, ElementsAre("WHEELS: E2E: wrong CRC"));
}

TEST_F(ExampleEgo, OneFrameCarriesSeveralQuantities) {
  bus.send("DYNAMICS", {{"YAW_RATE", -12.5}, {"STEERING_WHEEL", 90.0}});
  ASSERT_THAT(bus.out.egos, SizeIs(1));
  const EgoReading& reading = bus.out.egos[0].reading;
  EXPECT_NEAR(reading.yaw_rate_radps.value(), -12.5 * kRadiansPerDegree, 1e-9);
  EXPECT_NEAR(reading.steering_angle_rad.value(), 90.0 * kRadiansPerDegree, 1e-9);
  EXPECT_FALSE(reading.speed_mps || reading.reverse);
  bus.send("DYNAMICS", {{"YAW_RATE", 200.0}, {"STEERING_WHEEL", -5.0}});
  EXPECT_THAT(bus.out.faults, ElementsAre("yaw rate is outside its plausible range"));
  ASSERT_THAT(bus.out.egos, SizeIs(2));
  EXPECT_FALSE(bus.out.egos[1].reading.yaw_rate_radps);
  EXPECT_NEAR(bus.out.egos[1].reading.steering_angle_rad.value(), -5.0 * kRadiansPerDegree, 1e-9);
}

struct OwnEgo {
  explicit OwnEgo(const std::string& mapping)
      : decoder(read_ego_mapping(config::Reader::parse("kind = \"ego\"\ndbc = \"t\"\n" + mapping, "t.toml"),
                                 [this](const std::string&) { return database; })) {}
  dbc::Database database = dbc::parse_dbc(R"(BO_ 1 W: 16 C
 SG_ FL : 0|32@1- (1,0) [0|0] "km/h" X
 SG_ FR : 32|16@1+ (0.01,-67.67) [0|0] "km/h" X
 SG_ RAW : 64|16@1- (0.5,0) [0|0] "" X
SIG_VALTYPE_ 1 FL : 1;
)",
                                          "t.dbc");
  TableEgo decoder;
  Bus bus{database, decoder};
};

TEST(TableEgo, MeanOfWheelsInTheUnitOfTheFile) {
  OwnEgo ego("[speed]\nmessage = \"W\"\nsignals = [\"FL\", \"FR\"]\n");
  ego.bus.send("W", {{"FL", 36.0}, {"FR", 72.0}});
  ASSERT_THAT(ego.bus.out.egos, SizeIs(1));
  EXPECT_NEAR(ego.bus.out.egos[0].reading.speed_mps.value(), 15.0, 1e-6);
  EXPECT_FALSE(ego.bus.out.egos[0].reading.speed_is_signed);
}

TEST(TableEgo, SignedSpeedWithFactorOffsetAndSum) {
  OwnEgo ego(
      "[speed]\nmessage = \"W\"\nsignals = [\"RAW\", \"RAW\"]\ncombine = \"sum\"\nunit = \"mph\"\nfactor = -1\noffset "
      "= "
      "0.5\nsigned = true\n");
  ego.bus.send("W", {{"RAW", 10.0}});
  ASSERT_THAT(ego.bus.out.egos, SizeIs(1));
  EXPECT_NEAR(ego.bus.out.egos[0].reading.speed_mps.value(), 2.0 * (-10.0 + 0.5) * 0.44704, 1e-9);
  EXPECT_TRUE(ego.bus.out.egos[0].reading.speed_is_signed);
}

TEST(TableEgo, ImplausibleValueOrNaNIsAFault) {
  OwnEgo ego("[speed]\nmessage = \"W\"\nsignals = [\"FL\"]\nplausible_mps = [-1, 60]\n");
  for (const double speed :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 220.0, -10.0}) {
    ego.bus.send("W", {{"FL", speed}});
  }
  EXPECT_THAT(ego.bus.out.egos, IsEmpty());
  EXPECT_THAT(ego.bus.out.faults, SizeIs(4));
  EXPECT_THAT(ego.bus.out.faults, Each("speed is outside its plausible range"));
}

}  // namespace
}  // namespace boresight::ingest
