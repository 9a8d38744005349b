#include "services/ingest_gateway/core/sensor_feed.hpp"

#include <gtest/gtest.h>

#include "interfaces/wire/ars548.hpp"
#include "tests/unit/ingest_gateway/memory_sink.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest {
namespace {

class Outbox : public MemorySink {
 public:
  struct Sent {
    recording::Frame frame;
    std::vector<std::uint8_t> bytes;
  };
  void send(const recording::Frame& frame) override {
    sent.push_back({frame, {frame.payload.begin(), frame.payload.end()}});
  }
  std::vector<Sent> sent;
};

RadarConfig radar(std::uint32_t id, RadarProfile profile, bool ego_feed) {
  RadarConfig r;
  r.id = id;
  r.profile = profile;
  r.ego_feed = ego_feed;
  r.source.interface = "can" + std::to_string(id);
  r.source.sender = "10.13.1." + std::to_string(112 + id);
  return r;
}

EgoMotion ego(float speed_mps) {
  EgoMotion motion{};
  motion.fields = ego_field::kSpeed | ego_field::kYawRate;
  motion.speed_mps = speed_mps;
  motion.yaw_rate_radps = 0.1F;
  return motion;
}

TEST(SensorFeed, IsSentOnlyToConfiguredSensorsAtTheirRate) {
  VehicleConfig vehicle;
  vehicle.radars = {radar(1, RadarProfile::kArs548, true), radar(2, RadarProfile::kArs548, false),
                    radar(3, RadarProfile::kArs408, true), radar(4, RadarProfile::kArs408, false),
                    radar(5, RadarProfile::kToyota, true)};
  vehicle.radars[2].sensor_id = 2;
  SensorFeed feed(vehicle);
  Outbox out;
  feed.start(out);
  EXPECT_TRUE(out.sent.empty()) << "no configuration requested";
  for (int i = 0; i < 100; ++i) feed.send(ego(10.0F), i * 5 * kMillisecond, out);
  std::size_t udp = 0, can = 0;
  for (const auto& s : out.sent) {
    if (s.frame.kind == recording::FrameKind::kUdp) {
      ++udp;
      EXPECT_EQ(recording::to_text(s.frame.destination.address), "10.13.1.113");
      EXPECT_EQ(s.frame.destination.port, wire::ars548::kSensorPort);
    } else {
      ++can;
      EXPECT_EQ(s.frame.interface_name(), "can3");
      EXPECT_TRUE(s.frame.can_id == 0x320 || s.frame.can_id == 0x321) << "sensor 2 of its bus";
    }
  }
  EXPECT_EQ(can, 2u * 25u) << "50 Hz from an input of 200 Hz";
  EXPECT_GE(udp, 3u * 25u);
  out.sent.clear();
  feed.send(ego(10.0F), -1000 * kMillisecond, out);
  EXPECT_FALSE(out.sent.empty()) << "still sends after the clock went back";
}

TEST(SensorFeed, AnArs408IsConfiguredOnceIfRequested) {
  VehicleConfig vehicle;
  vehicle.radars = {radar(1, RadarProfile::kArs408, false), radar(2, RadarProfile::kArs408, false)};
  vehicle.radars[0].output = Ars408Output::kClusters;
  SensorFeed feed(vehicle);
  Outbox out;
  feed.start(out);
  ASSERT_EQ(out.sent.size(), 1u);
  EXPECT_EQ(out.sent[0].frame.can_id, 0x200u);
  EXPECT_EQ(out.sent[0].frame.interface_name(), "can1");
  EXPECT_EQ(out.sent[0].bytes, (std::vector<std::uint8_t>{0xF8, 0, 0, 0, 0x10, 0x9C, 0, 0}));
  feed.send(ego(10.0F), 0, out);
  EXPECT_EQ(out.sent.size(), 1u);
}

}  // namespace
}  // namespace boresight::ingest
