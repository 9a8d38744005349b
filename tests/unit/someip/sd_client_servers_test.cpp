// Several servers, subscriptions and programs at the same time; invalid messages.
#include <gtest/gtest.h>

#include "services/ingest_gateway/core/sd_client.hpp"
#include "tests/unit/someip/sd_client_fixture.hpp"

namespace boresight::ingest::someip {
namespace {

using recording::Endpoint;
using test::Bytes;
using test::kGroup;
using test::kMillisecond;
using test::kSecond;
using test::kSubscribed0;
using test::Server;
using testing::ElementsAre;
using testing::IsEmpty;

class SdClientServers : public test::SdClientTest {};

TEST_F(SdClientServers, OffersWithoutAUsableEndpointAreFaults) {
  start();
  actions_.sent.clear();
  std::size_t faults = 0;
  for (const Bytes& option :
       {test::ipv4_option(0, 30501), test::ipv4_option(0xE0000001, 30501), test::ipv4_option(test::kServerAddress, 0),
        test::ipv4_option(test::kServerAddress, 30501, 0x04, 0x06), Bytes{}}) {
    multicast(server_.by_multicast({{.number_1 = static_cast<std::uint8_t>(option.empty() ? 0 : 1)}},
                                   option.empty() ? std::vector<Bytes>{} : std::vector<Bytes>{option}),
              server_);
    EXPECT_EQ(actions_.faults, ++faults);
    EXPECT_EQ(actions_.last_fault, Fault::kWireValue);
  }
  EXPECT_THAT(sent(), IsEmpty());
  // The same from a service without a subscription is no fault.
  multicast(server_.by_multicast({{.service = 0x9999, .number_1 = 1}}, {test::ipv4_option(0, 30501)}), server_);
  EXPECT_EQ(actions_.faults, faults);
}

TEST_F(SdClientServers, TheFirstOfTwoInstancesIsUsedAndKept) {
  Server second{.address = 0x0A000015};
  start();
  actions_.sent.clear();
  offer();
  multicast(second.offer(3, 2), second);
  EXPECT_THAT(sent(), ElementsAre("Subscribe"));
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
  // The same instance at another address is ignored while the first one is present.
  multicast(second.offer(3, 1), second);
  multicast(second.offer(0, 1), second);
  EXPECT_EQ(client_->statistics().offers_by_others, 2u);
  EXPECT_EQ(client_->state(0).phase, SdSubscriptionState::Phase::kSubscribed);
  multicast(server_.offer(0), server_);
  pass(kSecond);
  multicast(second.offer(3, 2), second);
  unicast(second.ack(3, 2), second);
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 StopOffer", "subscribed 0 10.0.0.21:30501"));
}

TEST_F(SdClientServers, AServerThatDoesNotAnswerIsReplacedByAnother) {
  Server ghost{.address = 0x0A000063};
  start();
  multicast(ghost.offer(kForever_s), ghost);
  offer();
  EXPECT_EQ(client_->state(0).peer, ghost.sd()) << "its time to answer has not passed";
  pass(kSecond);
  multicast(server_.offer(0), server_);
  EXPECT_EQ(client_->state(0).peer, ghost.sd()) << "a StopOffer of another server is ignored";
  offer();
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
  // The opposite case: an answer keeps the server until its next answer is due.
  multicast(ghost.offer(kForever_s), ghost);
  pass(2 * kSecond);
  multicast(ghost.offer(kForever_s), ghost);
  EXPECT_EQ(client_->state(0).peer, server_.sd());
}

TEST_F(SdClientServers, AServerOfTwoEventgroupsIsAliveByOneOfThem) {
  make({{.index = 0, .service = 0x1234, .eventgroup = 0x10, .local_port = 40001},
        {.index = 1, .service = 0x1234, .eventgroup = 0x11, .local_port = 40001}});
  Server other{.address = 0x0A000063};
  start();
  offer();
  ack();
  pass(kSecond);  // the second eventgroup is never acknowledged
  multicast(other.offer(), other);
  EXPECT_EQ(client_->state(0).peer, server_.sd());
  EXPECT_EQ(client_->state(1).peer, server_.sd());
}

TEST_F(SdClientServers, AServerThatMovedIsFollowed) {
  become_subscribed();
  server_.event_port = 31000;
  pass(kSecond);
  offer();
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 changed"));
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre("subscribed 0 10.0.0.20:31000"));
}

TEST_F(SdClientServers, AnotherMajorVersionIsAFault) {
  make({{.index = 0, .service = 0x1234, .major = 1, .eventgroup = 0x10, .local_port = 40001}});
  start();
  actions_.sent.clear();
  offer();
  EXPECT_THAT(sent(), IsEmpty());
  EXPECT_EQ(actions_.last_fault, Fault::kVersionMismatch);
}

TEST_F(SdClientServers, AcksToOthersAreIgnored) {
  Server stranger{.address = 0x0A000099};
  start();
  offer();
  unicast(stranger.ack(), stranger);
  unicast(server_.ack(3, 2), server_);
  unicast(server_.ack(3, 1, 1), server_);
  EXPECT_THAT(actions_.taken(), IsEmpty());
  EXPECT_EQ(client_->statistics().foreign_entries, 3u);
  EXPECT_EQ(actions_.faults, 0u);
}

TEST_F(SdClientServers, SeveralSubscriptionsShareMessagesAndAreDistinguished) {
  make({{.index = 10, .service = 0x1234, .instance = 1, .eventgroup = 0x10, .local_port = 40001},
        {.index = 11, .service = 0x1234, .instance = 1, .eventgroup = 0x10, .local_port = 40002},
        {.index = 12, .service = 0x1234, .instance = 2, .eventgroup = 0x10, .local_port = 40003}});
  start();
  EXPECT_THAT(sent(), ElementsAre("Find", "Find")) << "instance 1 once";
  EXPECT_EQ(actions_.datagrams, 1u);
  multicast(server_.by_multicast({{.instance = 1, .number_1 = 1}, {.instance = 2, .number_1 = 1}},
                                 {test::ipv4_option(test::kServerAddress, 30501)}),
            server_);
  EXPECT_EQ(actions_.datagrams, 2u);
  ASSERT_EQ(actions_.sent.size(), 3u);
  EXPECT_EQ(actions_.sent[0].counter, 0);
  EXPECT_EQ(actions_.sent[1].counter, 1);
  EXPECT_EQ(actions_.sent[1].local.port, 40002);
  EXPECT_EQ(actions_.sent[2].counter, 0);
  EXPECT_EQ(actions_.sent[2].instance, 2);
  unicast(server_.ack(3, 1, 1), server_);
  EXPECT_THAT(actions_.taken(), ElementsAre("subscribed 11 10.0.0.20:30501"));
  unicast(server_.ack(3, 2, 0), server_);
  EXPECT_THAT(actions_.taken(), ElementsAre("subscribed 12 10.0.0.20:30501"));
}

TEST_F(SdClientServers, MoreSubscriptionsThanAMessageHoldsGoInSeveral) {
  std::vector<SdSubscription> many;
  for (std::uint16_t i = 0; i < 50; ++i) {
    many.push_back({.index = i,
                    .service = static_cast<std::uint16_t>(0x1000 + i),
                    .eventgroup = 0x10,
                    .local_port = static_cast<std::uint16_t>(40000 + i)});
  }
  make(std::move(many));
  start();
  EXPECT_EQ(sent(), std::vector<std::string>(50, "Find"));
  EXPECT_EQ(actions_.datagrams, 2u);
  std::vector<test::Entry> entries;
  for (std::uint16_t i = 0; i < 50; ++i) {
    entries.push_back({.service = static_cast<std::uint16_t>(0x1000 + i), .number_1 = 1});
  }
  multicast(server_.by_multicast(entries, {test::ipv4_option(test::kServerAddress, 30501)}), server_);
  EXPECT_EQ(sent(), std::vector<std::string>(50, "Subscribe"));
  // All are withdrawn and subscribed again; a StopSubscribe and its Subscribe may be in different messages.
  pass(kSecond);
  server_.restart();
  multicast(server_.by_multicast(entries, {test::ipv4_option(test::kServerAddress, 30501)}), server_);
  const std::vector<std::string> again = sent();
  EXPECT_EQ(std::count(again.begin(), again.end(), "Stop"), 50);
  EXPECT_EQ(std::count(again.begin(), again.end(), "Subscribe"), 50);
}

TEST_F(SdClientServers, OwnSessionsCountPerPeerAndWrapWithTheFlagCleared) {
  become_subscribed();
  std::uint16_t expected = 2;
  bool flag = true;
  for (int i = 0; i < 66'000; ++i) {
    now_ns_ += 200 * kMillisecond;
    offer();
    ack();
    ASSERT_EQ(actions_.sent.size(), 1u);
    ASSERT_EQ(actions_.sent[0].session, expected) << i;
    ASSERT_EQ(actions_.sent[0].reboot_flag, flag);
    if (expected++ == 0xFFFF) {
      expected = 1;
      flag = false;
    }
    actions_.sent.clear();
  }
  EXPECT_FALSE(flag);
  EXPECT_THAT(actions_.taken(), IsEmpty());
  EXPECT_EQ(client_->statistics().reboots, 0u);
}

TEST_F(SdClientServers, ProgramsOnThisHostThatShareThePortDoNotLookLikeReboots) {
  // A server on this host: Finds of the client and of another program have the same address and port, but different
  // sessions.
  server_.address = test::kLocal.to_v4();
  start();
  offer();
  ack();
  static_cast<void>(actions_.taken());
  Server other = server_;
  for (int i = 0; i < 5; ++i) {
    pass(500 * kMillisecond);
    other.restart();
    multicast(other.by_multicast({{.type = 0x00}}), other);
    pass(500 * kMillisecond);
    offer();
    ack();
  }
  EXPECT_EQ(client_->statistics().reboots, 0u);
  EXPECT_THAT(actions_.taken(), IsEmpty());
}

TEST_F(SdClientServers, WorksOverIpv6) {
  std::array<std::uint8_t, 16> bytes{0xFD};
  bytes[15] = 2;
  const auto local = recording::IpAddress::v6(bytes);
  bytes[15] = 0x20;
  const auto server = recording::IpAddress::v6(bytes);
  SdClient client({local, kGroup, {{.index = 0, .service = 0x1234, .eventgroup = 0x10, .local_port = 40001}}},
                  actions_);
  static_cast<void>(client.start(now_ns_));
  actions_.sent.clear();
  const Bytes offer = server_.by_multicast({{.number_1 = 1}}, {test::ipv6_option(server, 30501)});
  static_cast<void>(client.take(offer, {server, 30490}, true, now_ns_));
  ASSERT_EQ(actions_.sent.size(), 1u);
  EXPECT_EQ(actions_.sent[0].local, (Endpoint{local, 40001}));
  EXPECT_EQ(actions_.sent[0].to, (Endpoint{server, 30490}));
  static_cast<void>(client.take(server_.ack(), {server, 30490}, false, now_ns_));
  EXPECT_THAT(actions_.taken(), ElementsAre("subscribed 0 fd00::20:30501"));
}

TEST_F(SdClientServers, MalformedMessagesAreFaultsAndChangeNothing) {
  become_subscribed();
  Bytes bad = server_.offer(0);
  bad[23] = 0x20;  // length of the entries
  multicast(bad, server_);
  EXPECT_EQ(actions_.faults, 1u);
  EXPECT_EQ(actions_.last_fault, Fault::kWireLength);
  Bytes cut = server_.offer(0);
  cut.pop_back();
  multicast(cut, server_);
  EXPECT_EQ(actions_.faults, 2u);
  EXPECT_EQ(client_->statistics().malformed_messages, 2u);
  // Several invalid entries: reported once, all counted; the valid one is used.
  multicast(server_.by_multicast({{.index_1 = 9, .number_1 = 1}, {.index_1 = 9, .number_1 = 1}, {.ttl_s = 0}}),
            server_);
  EXPECT_EQ(actions_.faults, 3u);
  EXPECT_EQ(client_->statistics().malformed_entries, 2u);
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 StopOffer"));
  // Messages of other services on the port are no fault.
  multicast(test::message({}, Bytes(10)), server_);
  EXPECT_EQ(actions_.faults, 3u);
}

TEST_F(SdClientServers, SessionZeroIsAFaultButTheOfferCounts) {
  start();
  actions_.sent.clear();
  server_.multicast_session = 0;
  offer();
  EXPECT_EQ(actions_.faults, 1u);
  EXPECT_THAT(sent(), ElementsAre("Subscribe"));
}

}  // namespace
}  // namespace boresight::ingest::someip
