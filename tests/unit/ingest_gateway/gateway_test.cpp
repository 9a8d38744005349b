#include "services/ingest_gateway/core/gateway.hpp"

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/simulator/wire/ars548_encoder.hpp"
#include "services/simulator/wire/toyota_encoder.hpp"
#include "tests/unit/ingest_gateway/memory_sink.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest {
namespace {

constexpr std::int64_t kEpoch = 1'700'000'000'000'000'000;

VehicleConfig vehicle() {
  VehicleConfig v;
  v.ego.source.interface = "can0";
  for (std::uint32_t id : {1u, 2u}) {
    RadarConfig radar;
    radar.id = id;
    radar.profile = RadarProfile::kArs548;
    radar.source = {LinkKind::kUdp, "", "224.0.2.2", 42102, id == 1 ? "10.13.1.113" : "10.13.1.114"};
    v.radars.push_back(radar);
  }
  RadarConfig toyota;
  toyota.id = 3;
  toyota.profile = RadarProfile::kToyota;
  toyota.source = {LinkKind::kCan, "can1", "", 0, ""};
  toyota.latency_s = 0.07;
  v.radars.push_back(toyota);
  return v;
}

constexpr std::uint32_t kGroup = 0xE0000202, kSender1 = 0x0A0D0171, kSender2 = 0x0A0D0172;

class GatewayTest : public testing::Test {
 protected:
  GatewayTest() {
    scan_->number_of_valid_detections = 40;
    simulator::wire::encode_ars548(*scan_, kEpoch, *bytes_);
  }
  void send_list(std::uint32_t sender, std::int64_t received_epoch_ns = kEpoch + 20 * kMillisecond) {
    recording::Frame frame;
    frame.kind = recording::FrameKind::kUdp;
    frame.source.address = recording::IpAddress::v4(sender);
    frame.destination = {recording::IpAddress::v4(kGroup), 42102};
    frame.payload = *bytes_;
    // The epoch clock is far ahead of the monotonic one.
    gateway_.take(frame, {received_epoch_ns - offset_, offset_, TimeSource::kLinkArrival});
  }
  void send_can(std::string_view interface, std::uint32_t id, std::span<const std::uint8_t> payload,
                std::int64_t stamp_ns) {
    recording::Frame frame;
    frame.kind = recording::FrameKind::kCan;
    frame.set_interface(interface);
    frame.can_id = id;
    frame.payload = payload;
    gateway_.take(frame, {stamp_ns, 0, TimeSource::kLinkArrival});
  }
  MemorySink sink_;
  Gateway gateway_{vehicle(), sink_};
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  std::unique_ptr<simulator::wire::Ars548List> bytes_ = std::make_unique<simulator::wire::Ars548List>();
  std::int64_t offset_ = kEpoch - 5'000'000'000;
};

TEST_F(GatewayTest, TheSendersAddressIdentifiesTheRadar) {
  send_list(kSender1);
  EXPECT_EQ(sink_.last_radar, 1u);
  send_list(kSender2);
  EXPECT_EQ(sink_.last_radar, 2u);
  EXPECT_EQ(sink_.scans, 2u);
  EXPECT_EQ(sink_.all_faults(), 0u);
  send_list(0x0A0D01FF);
  EXPECT_EQ(sink_.scans, 2u);
  EXPECT_EQ(sink_.count(Fault::kWireUnknown), 1u) << "an unknown sender on a radar's port";
}

TEST_F(GatewayTest, TheSensorsOwnStampIsMappedToThisClock) {
  send_list(kSender1);
  EXPECT_EQ(sink_.last_time.source, TimeSource::kSensorSynchronised);
  EXPECT_EQ(sink_.last_time.time_ns, kEpoch - offset_);
}

TEST_F(GatewayTest, AnImplausibleStampIsReplacedByTheArrivalAndMarked) {
  send_list(kSender1, kEpoch + 3'000 * kMillisecond);  // 3 s old
  EXPECT_EQ(sink_.last_time.source, TimeSource::kLinkArrival);
  EXPECT_EQ(sink_.last_time.time_ns, kEpoch + 3'000 * kMillisecond - offset_);
  send_list(kSender1, kEpoch - 100 * kMillisecond);  // from the future
  EXPECT_EQ(sink_.last_time.source, TimeSource::kLinkArrival);
}

TEST_F(GatewayTest, ADamagedListIsCountedForItsRadarAndNothingElseIsLost) {
  (*bytes_)[7] = 1;
  send_list(kSender2);
  EXPECT_EQ(sink_.count(Fault::kWireLength), 1u);
  EXPECT_EQ(sink_.last_fault_radar, 2u);
  (*bytes_)[7] = 0;
  simulator::wire::encode_ars548(*scan_, kEpoch, *bytes_);
  send_list(kSender2);
  EXPECT_EQ(sink_.scans, 1u);
}

TEST_F(GatewayTest, EgoSignalsComeFromTheirBusOnly) {
  const auto frames =
      simulator::wire::encode_ego({.speed_mps = 12.0, .yaw_rate_radps = 0.1, .steering_angle_rad = 0.0});
  for (const auto& f : frames) send_can("can1", f.id, f.bytes, 1);
  EXPECT_EQ(sink_.egos, 0u);
  for (const auto& f : frames) send_can("can0", f.id, f.bytes, 7 * kMillisecond);
  EXPECT_EQ(sink_.egos, 1u);
  EXPECT_EQ(sink_.last_time.time_ns, 7 * kMillisecond);
  EXPECT_NEAR(sink_.ego.speed_mps, 12.0F, 0.01F);
  const std::array<std::uint8_t, 8> other{};
  send_can("can0", 0x7FF, other, 1);
  EXPECT_EQ(sink_.all_faults(), 0u) << "buses carry other traffic";
}

TEST_F(GatewayTest, ACycleOfTheCanRadarIsDatedBackByItsLatency) {
  const auto send_cycle = [&](std::int64_t begin_ns, std::size_t without) {
    std::size_t n = 0;
    for (std::uint32_t base : {0x210u, 0x220u}) {
      for (std::uint32_t slot = 0; slot < 16; ++slot, ++n) {
        if (n == without) continue;
        std::array<std::uint8_t, 8> bytes{};
        unsigned sum = ((base + slot) & 0xFF) + ((base + slot) >> 8) + 8;
        bytes[7] = static_cast<std::uint8_t>(sum);
        send_can("can1", base + slot, bytes, begin_ns + static_cast<std::int64_t>(n) * kMillisecond / 4);
      }
    }
  };
  send_cycle(1000 * kMillisecond, 99);
  EXPECT_EQ(sink_.scans, 1u);
  EXPECT_EQ(sink_.last_radar, 3u);
  EXPECT_EQ(sink_.last_time.time_ns, 930 * kMillisecond);
  send_cycle(1050 * kMillisecond, 5);
  EXPECT_EQ(sink_.scans, 1u) << "one frame is missing";
  send_cycle(1100 * kMillisecond, 99);
  EXPECT_EQ(sink_.scans, 3u) << "the incomplete cycle and the next one";
  EXPECT_EQ(sink_.count(Fault::kWireLength), 1u);
  EXPECT_EQ(sink_.last_fault_radar, 3u);
}

TEST_F(GatewayTest, WithoutMemoryTheScanIsDroppedAndTheNextOneComes) {
  sink_.refuse_memory = true;
  send_list(kSender1);
  EXPECT_EQ(sink_.scans, 0u);
  sink_.refuse_memory = false;
  send_list(kSender1);
  EXPECT_EQ(sink_.scans, 1u);
}

TEST_F(GatewayTest, ARemoteFrameCarriesNothing) {
  const auto frames =
      simulator::wire::encode_ego({.speed_mps = 12.0, .yaw_rate_radps = 0.1, .steering_angle_rad = 0.0});
  recording::Frame frame;
  frame.kind = recording::FrameKind::kCan;
  frame.set_interface("can0");
  frame.can_id = frames[2].id;
  frame.can_remote = true;
  frame.payload = frames[2].bytes;
  gateway_.take(frame, {1, 0, TimeSource::kLinkArrival});
  EXPECT_EQ(sink_.egos, 0u);
  EXPECT_EQ(sink_.all_faults(), 0u);
}

TEST_F(GatewayTest, ACycleWithoutMemoryIsDropped) {
  const auto send_cycle = [&](std::int64_t begin_ns) {
    for (std::uint32_t base : {0x210u, 0x220u}) {
      for (std::uint32_t slot = 0; slot < 16; ++slot) {
        std::array<std::uint8_t, 8> bytes{};
        bytes[7] = static_cast<std::uint8_t>(((base + slot) & 0xFF) + ((base + slot) >> 8) + 8);
        send_can("can1", base + slot, bytes, begin_ns + slot);
      }
    }
  };
  sink_.refuse_memory = true;
  send_cycle(1000 * kMillisecond);
  EXPECT_EQ(sink_.scans, 0u);
  sink_.refuse_memory = false;
  send_cycle(1050 * kMillisecond);
  EXPECT_EQ(sink_.scans, 1u);
  EXPECT_EQ(sink_.last_time.time_ns, 980 * kMillisecond) << "of the second cycle, not of the first";
  EXPECT_EQ(sink_.all_faults(), 0u);
}

TEST_F(GatewayTest, AllocatesNothing) {
  const auto frames =
      simulator::wire::encode_ego({.speed_mps = 12.0, .yaw_rate_radps = 0.1, .steering_angle_rad = 0.0});
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (int i = 0; i < 20; ++i) {
      send_list(kSender1);
      for (const auto& f : frames) send_can("can0", f.id, f.bytes, i * 10 * kMillisecond);
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

TEST(RecordingClock, KeepsTheSpacingAndSetsANewOffsetAtAJump) {
  RecordingClock clock;
  bool jumped = false;
  EXPECT_EQ(clock.map(1'000'000'000'000, 50, jumped).received_ns, 50);
  EXPECT_FALSE(jumped);
  EXPECT_EQ(clock.map(1'000'000'100'000, 90'000, jumped).received_ns, 100'050) << "spacing as recorded";
  EXPECT_EQ(clock.map(900'000'000'000, 7'000'000, jumped).received_ns, 7'000'000);
  EXPECT_TRUE(jumped);
  clock.reset();
  EXPECT_EQ(clock.map(5, 8'000'000, jumped).received_ns, 8'000'000);
  EXPECT_FALSE(jumped);
}

}  // namespace
}  // namespace boresight::ingest
