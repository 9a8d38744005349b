// The client and the replay's server, which was written against the service's definition and not against the client,
// on a simulated network: any order of starts, failures of each side, lost datagrams.
#include <algorithm>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/e2e/checker.hpp"
#include "services/common/someip/sd_server.hpp"
#include "services/ingest_gateway/codecs/someip/tp.hpp"
#include "services/ingest_gateway/core/sd_client.hpp"
#include "services/replay/core/datagrams.hpp"
#include "services/replay/core/event_encoder.hpp"
#include "services/replay/core/radar_service.hpp"
#include "tests/unit/someip/bytes.hpp"
#include "tests/unit/someip/sd_server.hpp"

namespace boresight::ingest::someip {
namespace {

namespace service = wire::boresight_service;
using recording::Endpoint;
using test::Bytes;
using test::kGroup;
using test::kMillisecond;
using test::kSecond;

constexpr std::uint16_t kRadar = 3;
const Endpoint kClient = test::endpoint(0x0A000002, 30490);
const Endpoint kServer = test::endpoint(0x0A000014, 30490);
const Endpoint kEventsFrom = test::endpoint(0x0A000014, 30509);
const Endpoint kEventsTo = test::endpoint(0x0A000002, 40001);

class Drive : public testing::Test, public SdActions {
 protected:
  Drive() {
    client_ = std::make_unique<SdClient>(SdClientConfig{kClient.address,
                                                        kGroup,
                                                        {{.index = 0,
                                                          .service = service::kServiceId,
                                                          .instance = kRadar,
                                                          .major = service::kMajorVersion,
                                                          .eventgroup = service::kEventgroupDetections,
                                                          .local_port = kEventsTo.port}}},
                                         *this);
  }

  void send(std::span<const std::uint8_t> datagram, const Endpoint& to) override {
    ASSERT_TRUE(to == kGroup || to == kServer);
    to_server_.push_back({Bytes(datagram.begin(), datagram.end()), to == kGroup});
  }
  void subscribed(std::size_t /*index*/, const Endpoint& server) override {
    EXPECT_EQ(server, kEventsFrom);
    is_subscribed_ = true;
  }
  void unsubscribed(std::size_t /*index*/, UnsubscribeReason reason) override {
    is_subscribed_ = false;
    reasons_.push_back(reason);
  }
  void join_multicast(std::size_t /*index*/, const Endpoint& group) override { joined_ = group; }
  void leave_multicast(std::size_t /*index*/, const Endpoint& group) override {
    EXPECT_EQ(joined_, group);
    joined_.reset();
  }
  void fault(Fault /*fault*/, std::string_view what) override { faults_.emplace_back(what); }

  void start_server(std::optional<Endpoint> event_group = {}) {
    boresight::someip::SdServerConfig config;
    config.service = replay::radar_service();
    config.instances = {{kRadar, kEventsFrom}};
    config.event_group = event_group;
    server_ = std::make_unique<boresight::someip::SdServer>(config);
    server_->start(now_ns_);
  }
  void kill_server() { server_.reset(); }
  void start_client() { due_ns_ = client_->start(now_ns_); }

  void pass(std::int64_t duration_ns) {
    for (const std::int64_t end_ns = now_ns_ + duration_ns; now_ns_ < end_ns; now_ns_ += 5 * kMillisecond) step();
  }
  /// Time until `reached`; 20 s if it is not reached.
  std::int64_t time_until(const std::function<bool()>& reached) {
    const std::int64_t begin_ns = now_ns_;
    while (!reached() && now_ns_ < begin_ns + 20 * kSecond) pass(5 * kMillisecond);
    return now_ns_ - begin_ns;
  }
  std::int64_t time_until_subscribed() {
    return time_until([&] { return is_subscribed_ && server_ && server_serves(); });
  }
  bool server_serves() { return !server_->destinations(kRadar, service::kEventgroupDetections, now_ns_).empty(); }

  std::unique_ptr<SdClient> client_;
  std::unique_ptr<boresight::someip::SdServer> server_;
  std::int64_t now_ns_ = 77 * kSecond;
  std::int64_t due_ns_ = SdClient::kNever;
  double loss_ = 0.0;
  bool link_is_up_ = true;
  bool is_subscribed_ = false;
  std::optional<Endpoint> joined_;
  std::vector<UnsubscribeReason> reasons_;
  std::vector<std::string> faults_;

 private:
  struct ToServer {
    Bytes datagram;
    bool by_multicast;
  };
  bool arrives() { return link_is_up_ && std::uniform_real_distribution()(random_) >= loss_; }

  void step() {
    std::vector<boresight::someip::SdOutgoing> from_server;
    if (server_ && server_->next_due_ns() <= now_ns_) server_->tick(now_ns_, from_server);
    for (const ToServer& sent : std::exchange(to_server_, {})) {
      if (!server_ || !arrives()) continue;
      const auto fault = server_->receive(now_ns_, sent.datagram, kClient, sent.by_multicast, from_server);
      EXPECT_EQ(fault.value_or(""), "");
    }
    for (const boresight::someip::SdOutgoing& sent : from_server) {
      if (!arrives()) continue;
      EXPECT_EQ(sent.to.value_or(kClient), kClient);
      due_ns_ = client_->take(sent.message, kServer, !sent.to, now_ns_);
    }
    if (link_is_up_ && due_ns_ <= now_ns_) due_ns_ = client_->tick(now_ns_);
  }

  std::mt19937 random_{5};
  std::vector<ToServer> to_server_;
};

TEST_F(Drive, TheServerStartsFirst) {
  start_server();
  pass(10'333 * kMillisecond);
  start_client();
  EXPECT_LE(time_until_subscribed(), 50 * kMillisecond) << "the Find is answered";
}

TEST_F(Drive, TheClientStartsFirst) {
  start_client();
  pass(60 * kSecond);
  start_server();
  EXPECT_LE(time_until_subscribed(), 100 * kMillisecond) << "the first offer is answered";
  pass(60 * kSecond);
  EXPECT_TRUE(reasons_.empty());
  EXPECT_TRUE(faults_.empty());
}

TEST_F(Drive, AKilledServerIsSubscribedAgainWhenItIsBack) {
  start_client();
  start_server();
  time_until_subscribed();
  for (const std::int64_t away_ns : {20 * kMillisecond, 500 * kMillisecond, 2 * kSecond, 30 * kSecond}) {
    pass(5'123 * kMillisecond);
    kill_server();
    pass(away_ns);
    start_server();
    EXPECT_LE(time_until_subscribed(), 300 * kMillisecond) << away_ns;
  }
  EXPECT_EQ(client_->statistics().reboots, 4u);
  EXPECT_THAT(reasons_, testing::ElementsAre(UnsubscribeReason::kServerReboot, UnsubscribeReason::kServerReboot,
                                             UnsubscribeReason::kServerReboot, UnsubscribeReason::kOfferExpired));
}

TEST_F(Drive, AServerWithdrawsItsOffersWhenItStops) {
  start_client();
  start_server();
  time_until_subscribed();
  pass(kSecond);
  std::vector<boresight::someip::SdOutgoing> out;
  server_->stop(out);
  ASSERT_FALSE(out.empty());
  for (const boresight::someip::SdOutgoing& sent : out) {
    due_ns_ = client_->take(sent.message, kServer, !sent.to, now_ns_);
  }
  EXPECT_THAT(reasons_, testing::ElementsAre(UnsubscribeReason::kStopOffer));
}

TEST_F(Drive, TheLinkGoesDownAndComesUp) {
  start_client();
  start_server();
  time_until_subscribed();
  for (const std::int64_t away_ns : {100 * kMillisecond, 10 * kSecond}) {
    pass(5 * kSecond);
    link_is_up_ = false;
    client_->link_down();
    EXPECT_FALSE(is_subscribed_);
    pass(away_ns);
    link_is_up_ = true;
    due_ns_ = client_->link_up(now_ns_);
    EXPECT_LE(time_until_subscribed(), 300 * kMillisecond) << "the Find is answered";
  }
  EXPECT_EQ(client_->statistics().reboots, 0u);
}

TEST_F(Drive, LostDatagramsAreRecovered) {
  loss_ = 0.2;
  start_client();
  start_server();
  int subscribed = 0, steps = 0;
  for (; steps < 60'000; ++steps) {
    pass(5 * kMillisecond);
    subscribed += is_subscribed_ && server_serves() ? 1 : 0;
  }
  EXPECT_GT(subscribed, steps * 95 / 100);
  EXPECT_EQ(client_->statistics().reboots, 0u);
  EXPECT_EQ(client_->statistics().refusals, 0u);
  EXPECT_EQ(server_->statistics().client_reboots, 0u);
}

TEST_F(Drive, JoinsTheGroupTheServerNames) {
  const Endpoint group = test::endpoint(0xEFC00103, 31003);
  start_client();
  start_server(group);
  time_until_subscribed();
  EXPECT_EQ(joined_, group);
  kill_server();
  pass(5 * kSecond);
  EXPECT_EQ(joined_, std::nullopt);
}

TEST_F(Drive, AClientThatStopsEndsItsSubscriptions) {
  start_client();
  start_server();
  time_until_subscribed();
  client_->stop(now_ns_);
  due_ns_ = SdClient::kNever;
  pass(50 * kMillisecond);
  EXPECT_FALSE(server_serves());
}

TEST(ReplayEvents, ArriveCompleteAndProtectedForAnyOrderOfSegments) {
  replay::EventEncoder encoder({service::data_id(kRadar, service::kEventDetectionList), 0});
  e2e::Checker checker({.profile = e2e::Profile::kP07,
                        .data_id = service::data_id(kRadar, service::kEventDetectionList),
                        .offset_bytes = service::kE2eOffsetBytes});
  TpReassembler tp(8, service::kMaxMessageBytes, 100 * kMillisecond);
  const auto scan = std::make_unique<RadarScan>();
  scan->number_of_valid_detections = 1000;
  std::mt19937 random(9);
  std::size_t whole = 0;
  for (int i = 0; i < 50; ++i) {
    const std::span<const std::uint8_t> message = encoder.detection_list(*scan, {1'000'000'000 + i, 1});
    std::vector<Bytes> datagrams;
    replay::for_each_datagram(message, [&](std::span<const std::uint8_t> datagram) {
      datagrams.emplace_back(datagram.begin(), datagram.end());
    });
    ASSERT_GT(datagrams.size(), 30u);
    std::shuffle(datagrams.begin(), datagrams.end(), random);
    for (const Bytes& datagram : datagrams) {
      MessageReader reader(datagram);
      Message segment, complete;
      ASSERT_EQ(reader.next(segment), ReadResult::kMessage);
      if (tp.take(segment, kEventsFrom, i * 50 * kMillisecond, complete) != TpResult::kComplete) continue;
      ++whole;
      EXPECT_THAT(complete.protected_data, testing::ElementsAreArray(message.subspan(8)));
      EXPECT_TRUE(e2e::is_acceptable(checker.check(complete.protected_data)));
    }
  }
  EXPECT_EQ(whole, 50u);
  EXPECT_EQ(tp.statistics().bad_segments + tp.statistics().dropped_incomplete, 0u);
}

}  // namespace
}  // namespace boresight::ingest::someip
