// The Boresight service through the gateway, in memory: the replay's encoder and discovery server on the other side.
#include "services/ingest_gateway/codecs/boresight_service.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/common/e2e/protector.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "services/common/someip/sd_server.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/replay/core/datagrams.hpp"
#include "services/replay/core/event_encoder.hpp"
#include "services/replay/core/radar_service.hpp"
#include "tests/unit/ingest_gateway/memory_output.hpp"
#include "tests/unit/ingest_gateway/memory_sink.hpp"
#include "tests/unit/ingest_gateway/times.hpp"
#include "tests/unit/replay/document.hpp"

namespace boresight::ingest {
namespace {

constexpr std::int64_t kServiceEpoch_ns = 1'767'225'600'000'000'000;
using Bytes = std::vector<std::uint8_t>;

/// Two radars and the vehicle's motion by SOME/IP on one network.
VehicleConfig service_vehicle() {
  VehicleConfig v;
  const auto source = [](std::uint16_t instance) {
    SourceAddress s;
    s.link = LinkKind::kSomeIp;
    s.interface = "eth0";
    s.address = "192.168.10.2";
    s.port = 41000;
    s.instance = instance;
    return s;
  };
  const auto protection = [](std::uint32_t data_id) {
    E2eConfig e2e;
    e2e.required = true;
    e2e.protection = {.profile = e2e::Profile::kP07, .data_id = data_id, .offset_bytes = 8, .max_delta_counter = 50};
    return e2e;
  };
  v.ego.profile = EgoProfile::kBoresight;
  v.ego.source = source(9);
  v.ego.e2e = protection(0x42530902);
  for (std::uint32_t id = 1; id <= 2; ++id) {
    RadarConfig radar;
    radar.id = id;
    radar.name = "radar" + std::to_string(id);
    radar.profile = RadarProfile::kBoresight;
    radar.source = source(static_cast<std::uint16_t>(id));
    radar.e2e = protection(0x42530001 | id << 8);
    v.radars.push_back(radar);
  }
  return v;
}

class SomeIpGateway : public testing::Test, protected MemorySink {
 protected:
  static constexpr std::uint32_t kServer = 0xC0A80A0D;  // 192.168.10.13
  static recording::Endpoint at(std::uint16_t port) { return {recording::IpAddress::v4(kServer), port}; }
  static recording::Endpoint endpoint_of(std::uint16_t instance) {
    return at(static_cast<std::uint16_t>(30600 + instance));
  }

  SomeIpGateway() {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    given_->fields = scan_field::kElevation | scan_field::kRcs | scan_field::kStds;
    given_->number_of_valid_detections = 800;
    for (std::size_t i = 0; i < 1024; ++i) {
      given_->range_m[i] = 200.0F * uniform(random);
      given_->azimuth_rad[i] = uniform(random) - 0.5F;
      given_->elevation_rad[i] = 0.2F * uniform(random);
      given_->range_rate_mps[i] = -20.0F * uniform(random);
      given_->range_std_m[i] = given_->azimuth_std_rad[i] = given_->elevation_std_rad[i] = 0.1F;
      given_->range_rate_std_mps[i] = given_->existence_probability[i] = 0.1F;
    }
    server_.start(0);
    gateway_.start(0);
  }

  /// Passes the gateway's datagrams to the server, and keeps the answers for the next step().
  void send(const recording::Frame& frame) override {
    ++datagrams_sent;
    server_.receive(now_ns_, frame.payload, {frame.source.address, 30490}, frame.destination.address.is_multicast(),
                    answers_);
  }
  void join(const recording::Endpoint& group, std::string_view interface) override {
    joined.emplace_back(group, interface);
  }

  void deliver(std::span<const std::uint8_t> payload, const recording::Endpoint& from, const recording::Endpoint& to) {
    recording::Frame frame;
    frame.kind = recording::FrameKind::kUdp;
    frame.source = from;
    frame.destination = to;
    frame.payload = payload;
    gateway_.take(frame, {now_ns_, kServiceEpoch_ns, TimeSource::kLinkArrival});
  }
  /// Advances the time in steps of 10 ms, with service discovery.
  void pass(std::int64_t duration_ns) {
    for (const std::int64_t end = now_ns_ + duration_ns; now_ns_ < end;) {
      now_ns_ += 10 * kMillisecond;
      if (server_runs_) server_.tick(now_ns_, answers_);
      std::vector<boresight::someip::SdOutgoing> batch;
      std::swap(batch, answers_);
      for (const boresight::someip::SdOutgoing& out : batch) {
        deliver(out.message, at(30490), out.to.value_or(recording::Endpoint{kGroup, 30490}));
      }
      gateway_.tick(now_ns_);
    }
  }
  /// Sends one event of an instance to its subscribers.
  template <typename Message>
  void publish(std::uint16_t instance, std::uint16_t eventgroup, const Message& message) {
    for (const recording::Endpoint& to : server_.destinations(instance, eventgroup, now_ns_)) {
      replay::for_each_datagram(
          message, [&](std::span<const std::uint8_t> datagram) { deliver(datagram, endpoint_of(instance), to); });
    }
  }
  void publish_list(std::uint16_t instance) {
    given_->cycle_counter += 1;
    publish(instance, 1,
            encoders_[instance].detection_list(*given_, {kServiceEpoch_ns + now_ns_ - 5 * kMillisecond, 1}));
  }

  static inline const recording::IpAddress kGroup = recording::IpAddress::v4(0xE0F4E0F5);
  std::int64_t now_ns_ = 0;
  std::unique_ptr<RadarScan> given_ = std::make_unique<RadarScan>();
  boresight::someip::SdServer server_{{.service = replay::radar_service(),
                                       .instances = {{1, endpoint_of(1)}, {2, endpoint_of(2)}, {9, endpoint_of(9)}},
                                       .event_group = {}}};
  std::array<replay::EventEncoder, 10> encoders_ = make_encoders();
  std::vector<boresight::someip::SdOutgoing> answers_;
  bool server_runs_ = true;
  std::size_t datagrams_sent = 0;
  std::vector<std::pair<recording::Endpoint, std::string>> joined;
  Gateway gateway_{service_vehicle(), *this};

 private:
  static replay::DataIds ids(unsigned instance) { return {0x42530001u | instance << 8, 0x42530002u | instance << 8}; }
  static std::array<replay::EventEncoder, 10> make_encoders() {
    return {replay::EventEncoder(ids(0)), replay::EventEncoder(ids(1)), replay::EventEncoder(ids(2)),
            replay::EventEncoder(ids(3)), replay::EventEncoder(ids(4)), replay::EventEncoder(ids(5)),
            replay::EventEncoder(ids(6)), replay::EventEncoder(ids(7)), replay::EventEncoder(ids(8)),
            replay::EventEncoder(ids(9))};
  }
};

TEST_F(SomeIpGateway, ListsInSegmentsArriveBitForBitWithTheSensorsTime) {
  pass(1000 * kMillisecond);
  for (std::uint32_t i = 0; i < 40; ++i) {
    publish_list(1 + i % 2);
    pass(20 * kMillisecond);
    ASSERT_EQ(scans, i + 1);
    EXPECT_EQ(last_radar, 1 + i % 2);
    EXPECT_EQ(last_time.source, TimeSource::kSensorSynchronised);
    EXPECT_EQ(last_time.time_ns, now_ns_ - 25 * kMillisecond);
    ASSERT_EQ(scan->number_of_valid_detections, 800u);
    for (std::size_t k = 0; k < 800; ++k) {
      ASSERT_EQ(scan->range_m[k], given_->range_m[k]);
      ASSERT_EQ(scan->azimuth_rad[k], given_->azimuth_rad[k]);
      ASSERT_EQ(scan->range_rate_mps[k], given_->range_rate_mps[k]);
    }
    EXPECT_EQ(scan->cycle_counter, i + 1);
  }
  EXPECT_EQ(all_faults(), 0u);
  EXPECT_EQ(source_statistics[1].e2e_lost + source_statistics[1].e2e_wrong, 0u);
}

TEST_F(SomeIpGateway, EgoMotionArrives) {
  pass(1000 * kMillisecond);
  EgoMotion given{};
  given.fields = ego_field::kSpeed | ego_field::kYawRate | ego_field::kReverse;
  given.speed_mps = -3.5F;
  given.yaw_rate_radps = 0.25F;
  publish(9, 2, encoders_[9].ego_motion(given, {kServiceEpoch_ns + now_ns_ - kMillisecond, 1}));
  ASSERT_EQ(egos, 1u);
  EXPECT_EQ(ego.speed_mps, -3.5F);
  EXPECT_EQ(ego.yaw_rate_radps, 0.25F);
  EXPECT_TRUE(ego.has(ego_field::kSpeed | ego_field::kYawRate | ego_field::kReverse));
  EXPECT_FALSE(ego.has(ego_field::kSteeringAngle));
  EXPECT_EQ(last_time.time_ns, now_ns_ - kMillisecond);
}

TEST_F(SomeIpGateway, AListThatFailsItsCheckIsDroppedAndCountedForItsRadar) {
  pass(1000 * kMillisecond);
  publish_list(1);
  const auto message = encoders_[1].detection_list(*given_, {kServiceEpoch_ns, 1});
  Bytes damaged(message.begin(), message.end());
  damaged[500] ^= 4;
  publish(1, 1, damaged);
  EXPECT_EQ(scans, 1u);
  EXPECT_EQ(count(Fault::kWireValue), 1u);
  EXPECT_EQ(last_fault_radar, 1u);
  EXPECT_EQ(source_statistics[1].e2e_wrong, 1u);
  publish_list(1);
  EXPECT_EQ(scans, 2u) << "the next one is valid";
  EXPECT_EQ(source_statistics[1].e2e_lost, 1u) << "the damaged one counts as lost";
  given_->number_of_valid_detections = 10;  // unsegmented, as repeated segments are detected before the check
  const auto again = encoders_[1].detection_list(*given_, {kServiceEpoch_ns, 1});
  const Bytes repeated(again.begin(), again.end());
  publish(1, 1, repeated);
  publish(1, 1, repeated);
  EXPECT_EQ(scans, 3u);
  EXPECT_EQ(source_statistics[1].e2e_repeated, 1u);
  EXPECT_EQ(source_statistics[2].e2e_wrong, 0u);
}

/// A project may protect the service's messages by a shorter profile with another header offset.
class OtherProfiles : public testing::TestWithParam<e2e::Config> {};

TEST_P(OtherProfiles, AreCheckedAndTheBodyIsFound) {
  VehicleConfig v = service_vehicle();
  v.radars.resize(1);
  v.radars[0].e2e.protection = GetParam();
  v.radars[0].source.sender = "192.168.10.13";
  v.radars[0].source.sender_port = 30601;
  MemorySink sink;
  Gateway gateway(v, sink);
  const Bytes example = replay::document_example("detection list");
  e2e::Protector protector(GetParam());
  const auto send = [&](bool damaged) {
    Bytes message(example.begin(), example.begin() + 16);
    message.resize(8 + GetParam().offset_bytes + e2e::header_bytes(GetParam().profile));
    message.insert(message.end(), example.begin() + 36, example.end());
    message[7] = static_cast<std::uint8_t>(message.size() - 8);
    ASSERT_TRUE(protector.protect(std::span(message).subspan(8)));
    if (damaged) message.back() ^= 1;
    recording::Frame frame;
    frame.kind = recording::FrameKind::kUdp;
    frame.source = {recording::IpAddress::v4(0xC0A80A0D), 30601};
    frame.destination = {recording::IpAddress::v4(0xC0A80A02), 41000};
    frame.payload = message;
    gateway.take(frame, {5'000'000'000, 1'767'225'595'260'000'000, TimeSource::kLinkArrival});
  };
  send(false);
  ASSERT_EQ(sink.scans, 1u);
  EXPECT_EQ(sink.scan->number_of_valid_detections, 2u);
  EXPECT_EQ(sink.scan->range_m[1], 120.0F);
  send(true);
  EXPECT_EQ(sink.scans, 1u);
  EXPECT_EQ(sink.source_statistics[1].e2e_wrong, 1u);
  send(false);
  EXPECT_EQ(sink.scans, 2u);
  EXPECT_EQ(sink.source_statistics[1].e2e_lost, 1u);
}

INSTANTIATE_TEST_SUITE_P(
    All, OtherProfiles,
    testing::Values(e2e::Config{.profile = e2e::Profile::kP04, .data_id = 7, .offset_bytes = 8, .max_delta_counter = 9},
                    e2e::Config{.profile = e2e::Profile::kP06, .data_id = 7, .offset_bytes = 8, .max_delta_counter = 9},
                    e2e::Config{
                        .profile = e2e::Profile::kP07, .data_id = 7, .offset_bytes = 20, .max_delta_counter = 9}));

TEST_F(SomeIpGateway, ALostSegmentLosesOnlyItsMessage) {
  pass(1000 * kMillisecond);
  std::size_t n = 0;
  const auto message = encoders_[1].detection_list(*given_, {kServiceEpoch_ns, 1});
  replay::for_each_datagram(message, [&](std::span<const std::uint8_t> datagram) {
    if (n++ != 7) deliver(datagram, endpoint_of(1), {recording::IpAddress::v4(0xC0A80A02), 41000});
  });
  EXPECT_EQ(scans, 0u);
  publish_list(1);
  publish_list(2);
  EXPECT_EQ(scans, 2u);
  pass(200 * kMillisecond);
  EXPECT_EQ(count(Fault::kWireLength), 1u) << "reported once";
}

TEST_F(SomeIpGateway, EventsOfUnknownSendersAreRejected) {
  pass(1000 * kMillisecond);
  const auto message = encoders_[1].detection_list(*given_, {kServiceEpoch_ns, 1});
  std::size_t segments = 0;
  replay::for_each_datagram(message, [&](std::span<const std::uint8_t> datagram) {
    deliver(datagram, at(30999), {recording::IpAddress::v4(0xC0A80A02), 41000});
    ++segments;
  });
  EXPECT_EQ(scans, 0u);
  EXPECT_EQ(count(Fault::kWireUnknown), segments) << "not reassembled";
}

TEST_F(SomeIpGateway, ASilentServerIsReportedAndFoundAgain) {
  pass(1000 * kMillisecond);
  publish_list(1);
  EXPECT_EQ(scans, 1u);
  server_runs_ = false;
  pass(4000 * kMillisecond);
  EXPECT_EQ(count(Fault::kLink), 3u) << "each of the three subscriptions reports the expired offer";
  server_runs_ = true;
  server_ = boresight::someip::SdServer({.service = replay::radar_service(),
                                         .instances = {{1, endpoint_of(1)}, {2, endpoint_of(2)}, {9, endpoint_of(9)}},
                                         .event_group = {}});
  server_.start(now_ns_);
  pass(100 * kMillisecond);
  publish_list(1);
  EXPECT_EQ(scans, 2u) << "within its first offer";
}

TEST_F(SomeIpGateway, AMulticastGroupIsJoinedOnTheInterfaceOfTheVehicleFile) {
  const recording::Endpoint group{recording::IpAddress::v4(0xEF425301), 30650};
  server_ = boresight::someip::SdServer(
      {.service = replay::radar_service(), .instances = {{1, endpoint_of(1)}}, .event_group = group});
  server_.start(now_ns_);
  pass(500 * kMillisecond);
  ASSERT_EQ(joined.size(), 1u);
  EXPECT_EQ(joined[0].first, group);
  EXPECT_EQ(joined[0].second, "eth0");
  publish_list(1);
  EXPECT_EQ(scans, 1u);
}

TEST_F(SomeIpGateway, AllocatesNothing) {
  pass(1000 * kMillisecond);
  publish_list(1);
  // Encoded before, since the encoder may allocate.
  std::vector<Bytes> datagrams;
  for (int i = 0; i < 5; ++i) {
    const auto message = encoders_[1].detection_list(*given_, {kServiceEpoch_ns, 1});
    replay::for_each_datagram(message, [&](std::span<const std::uint8_t> datagram) {
      datagrams.emplace_back(datagram.begin(), datagram.end());
    });
  }
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (const Bytes& datagram : datagrams) {
      deliver(datagram, endpoint_of(1), {recording::IpAddress::v4(0xC0A80A02), 41000});
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_EQ(scans, 6u);
}

}  // namespace
}  // namespace boresight::ingest
