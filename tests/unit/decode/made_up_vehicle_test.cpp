#include "services/boresight/decode/made_up_vehicle.hpp"

#include <gmock/gmock.h>

#include "interfaces/wire/boresight_service.hpp"

namespace boresight::decode {
namespace {

/// Frames from memory.
class Frames : public recording::Reader {
 public:
  void add(const char* address, std::uint16_t port, std::uint16_t destination_port, std::vector<std::uint8_t> payload) {
    recording::Frame frame;
    frame.kind = recording::FrameKind::kUdp;
    frame.source = {*recording::parse_ip(address), port};
    frame.destination.port = destination_port;
    payloads_.push_back(std::move(payload));
    frames_.push_back(frame);
  }
  bool next(recording::Frame& frame) override {
    if (at_ == frames_.size()) return false;
    frame = frames_[at_];
    frame.payload = payloads_[at_++];
    return true;
  }
  recording::Counts counts() const override { return {}; }
  recording::Progress progress() const override { return {}; }

 private:
  std::vector<recording::Frame> frames_;
  std::vector<std::vector<std::uint8_t>> payloads_;
  std::size_t at_ = 0;
};

/// The beginning of a message of the Boresight service, whole or as a segment at an offset.
std::vector<std::uint8_t> event(std::uint16_t id, std::uint8_t instance, int segment_offset = -1) {
  std::vector<std::uint8_t> bytes(100);
  bytes[0] = 0x42;
  bytes[1] = 0x53;
  bytes[2] = static_cast<std::uint8_t>(id >> 8);
  bytes[3] = static_cast<std::uint8_t>(id);
  const std::size_t shift = segment_offset < 0 ? 0 : 4;
  if (segment_offset >= 0) {
    bytes[14] = 0x22;
    bytes[18] = static_cast<std::uint8_t>(segment_offset >> 8);
    bytes[19] = static_cast<std::uint8_t>((segment_offset & 0xF0) | 1);
  }
  bytes[32 + shift] = 0x42;
  bytes[33 + shift] = 0x53;
  bytes[34 + shift] = instance;
  bytes[35 + shift] = static_cast<std::uint8_t>(id);
  return bytes;
}

TEST(MadeUpVehicle, ARadarForEachSenderOfArs548) {
  Frames frames;
  frames.add("10.13.1.114", 42401, 42102, {});
  frames.add("10.13.1.113", 42401, 42102, {});
  frames.add("10.13.1.99", 42401, 5353, {});
  frames.add("10.13.1.114", 42402, 42102, {});
  const VehicleConfig vehicle =
      made_up_vehicle({.profile = RadarProfile::kArs548, .senders = find_senders(frames, RadarProfile::kArs548)});
  ASSERT_EQ(vehicle.radars.size(), 2u);
  EXPECT_EQ(vehicle.radars[0].source.sender, "10.13.1.114");
  EXPECT_EQ(vehicle.radars[1].source.sender, "10.13.1.113");
  EXPECT_EQ(vehicle.radars[1].id, 2u);
  EXPECT_EQ(made_up_vehicle({}).radars.at(0).source.sender, "") << "any, if none is known";
}

TEST(MadeUpVehicle, TheInstancesOfABoresightService) {
  Frames frames;
  frames.add("fd00::1", 30501, 30600, event(0x8001, 7, 16));  // a later segment says nothing
  frames.add("fd00::1", 30501, 30600, event(0x8001, 7, 0));
  frames.add("fd00::2", 30501, 30600, event(0x8001, 3));
  frames.add("fd00::3", 30502, 30600, event(0x8002, 1));
  frames.add("fd00::9", 30501, 30600, {1, 2, 3});
  const VehicleConfig vehicle =
      made_up_vehicle({.profile = RadarProfile::kBoresight, .senders = find_senders(frames, RadarProfile::kBoresight)});
  ASSERT_EQ(vehicle.radars.size(), 2u);
  EXPECT_EQ(vehicle.radars[0].id, 3u);
  EXPECT_EQ(vehicle.radars[1].id, 7u);
  EXPECT_EQ(vehicle.radars[1].source.sender, "fd00::1");
  EXPECT_EQ(vehicle.radars[1].source.sender_port, 30501);
  EXPECT_EQ(vehicle.radars[1].e2e.protection.data_id, wire::boresight_service::data_id(7, 0x8001));
  EXPECT_EQ(vehicle.ego.profile, EgoProfile::kBoresight);
  EXPECT_EQ(vehicle.ego.source.sender, "fd00::3");
}

TEST(MadeUpVehicle, EveryProfileOfVehicleFilesIsThere) {
  for (const auto& [name, profile] : profiles()) {
    if (profile == RadarProfile::kBoresight) continue;
    const VehicleConfig vehicle = made_up_vehicle({.profile = profile, .interface = "can2", .sensor_id = 5});
    ASSERT_EQ(vehicle.radars.size(), 1u) << name;
    EXPECT_EQ(vehicle.radars[0].profile, profile);
    EXPECT_EQ(vehicle.radars[0].source.link, profile == RadarProfile::kArs548 ? LinkKind::kUdp : LinkKind::kCan);
    EXPECT_EQ(vehicle.radars[0].source.interface, "can2");
    EXPECT_EQ(vehicle.radars[0].sensor_id, 5u);
  }
  EXPECT_EQ(profiles().size(), 6u);
}

}  // namespace
}  // namespace boresight::decode
