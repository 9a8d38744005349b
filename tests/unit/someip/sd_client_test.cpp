// The client with a server that starts, stops, vanishes, refuses and comes back.
#include "services/ingest_gateway/core/sd_client.hpp"

#include <gtest/gtest.h>

#include "tests/unit/someip/sd_client_fixture.hpp"

namespace boresight::ingest::someip {
namespace {

using test::Bytes;
using test::endpoint;
using test::kGroup;
using test::kMillisecond;
using test::kSecond;
using test::kSubscribed0;
using test::SentEntry;
using test::Server;
using testing::ElementsAre;
using testing::IsEmpty;

class SdClientLife : public test::SdClientTest {};

TEST_F(SdClientLife, FindsFourTimesThenWaits) {
  start();
  std::vector<std::int64_t> at_ms;
  const std::int64_t begin_ns = now_ns_;
  for (std::size_t seen = 0; now_ns_ < begin_ns + 60 * kSecond; pass(10 * kMillisecond)) {
    for (; seen < actions_.sent.size(); ++seen) at_ms.push_back((now_ns_ - begin_ns) / kMillisecond);
  }
  EXPECT_THAT(at_ms, ElementsAre(0, 200, 600, 1400));
  EXPECT_EQ(due_ns_, SdClient::kNever);
  std::uint16_t session = 1;
  for (const SentEntry& find : actions_.sent) {
    EXPECT_EQ(find.type, EntryType::kFind);
    EXPECT_EQ(find.service, 0x1234);
    EXPECT_EQ(find.instance, kAnyInstance);
    EXPECT_EQ(find.major, kAnyMajor);
    EXPECT_EQ(find.ttl_s, kForever_s);
    EXPECT_EQ(find.to, kGroup);
    EXPECT_EQ(find.session, session++);
    EXPECT_TRUE(find.reboot_flag);
  }
}

TEST_F(SdClientLife, SubscribesAtTheOffersSenderWithTheOfferedInstanceAndVersion) {
  start();
  actions_.sent.clear();
  offer();
  ASSERT_EQ(actions_.sent.size(), 1u);
  const SentEntry& s = actions_.sent[0];
  EXPECT_EQ(s.type, EntryType::kSubscribe);
  EXPECT_EQ(s.service, 0x1234);
  EXPECT_EQ(s.instance, 1);
  EXPECT_EQ(s.major, 2);
  EXPECT_EQ(s.ttl_s, 3u);
  EXPECT_EQ(s.eventgroup, 0x10);
  EXPECT_EQ(s.local, endpoint(0x0A000002, 40001));
  EXPECT_EQ(s.to, endpoint(test::kServerAddress, 30490));
  EXPECT_EQ(s.session, 1);
  EXPECT_TRUE(s.reboot_flag);
  EXPECT_THAT(actions_.taken(), IsEmpty()) << "not subscribed before the Ack";
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
  EXPECT_EQ(client_->state(0).phase, SdSubscriptionState::Phase::kSubscribed);
  pass(10 * kSecond);
  EXPECT_EQ(std::count_if(actions_.sent.begin(), actions_.sent.end(),
                          [](const SentEntry& e) { return e.type == EntryType::kFind; }),
            4)
      << "none while the server is known; four after it was lost";
}

TEST_F(SdClientLife, TheServersEndpointIsThatOfTheOptionNotOfTheHeader) {
  start();
  multicast(server_.by_multicast({{.number_1 = 1}}, {test::ipv4_option(0x0A0000C8, 777)}), server_);
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre("subscribed 0 10.0.0.200:777"));
}

TEST_F(SdClientLife, SubscribesAtTheSdEndpointOption) {
  start();
  actions_.sent.clear();
  multicast(server_.by_multicast({{.number_1 = 1}}, {test::ipv4_option(test::kServerAddress, 30501),
                                                     test::ipv4_option(0x0A000015, 30491, 0x24)}),
            server_);
  ASSERT_EQ(actions_.sent.size(), 1u);
  EXPECT_EQ(actions_.sent[0].to, endpoint(0x0A000015, 30491));
}

TEST_F(SdClientLife, RenewsAfterEveryOfferAndStaysSubscribed) {
  become_subscribed();
  for (int i = 0; i < 20; ++i) {
    pass(kSecond);
    offer();
    EXPECT_THAT(sent(), ElementsAre("Subscribe"));
    ack();
  }
  EXPECT_THAT(actions_.taken(), IsEmpty());
  EXPECT_EQ(actions_.faults, 0u);
  EXPECT_EQ(client_->statistics().acks, 21u);
  EXPECT_EQ(client_->statistics().offers, 21u);
}

TEST_F(SdClientLife, RenewsByTimerWhenTheServerOffersRarely) {
  start();
  multicast(server_.offer(kForever_s), server_);
  ack();
  actions_.sent.clear();
  for (int i = 0; i < 10; ++i) {
    pass(1500 * kMillisecond);
    EXPECT_THAT(sent(), ElementsAre("Subscribe"));
    ack();
  }
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
}

TEST_F(SdClientLife, AnOfferExpiresAndTheServerIsSoughtAgain) {
  become_subscribed();
  pass(2999 * kMillisecond);
  EXPECT_THAT(actions_.taken(), IsEmpty());
  actions_.sent.clear();
  pass(2 * kMillisecond);
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 expired"));
  EXPECT_THAT(sent(), ElementsAre("Find"));
  EXPECT_EQ(client_->statistics().expired_offers, 1u);
  offer();
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
}

TEST_F(SdClientLife, StopOfferEndsAtOnce) {
  become_subscribed();
  pass(2 * kSecond);  // beyond the Finds of the start
  actions_.sent.clear();
  multicast(server_.offer(0), server_);
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 StopOffer"));
  pass(10 * kSecond);
  EXPECT_THAT(sent(), IsEmpty());
  offer();
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
}

TEST_F(SdClientLife, ARestartedServerIsSubscribedAgainAtItsFirstOffer) {
  become_subscribed();
  for (int i = 0; i < 2; ++i) {
    pass(kSecond);
    offer();
    ack();
  }
  pass(kSecond);
  actions_.sent.clear();
  server_.restart();
  offer();
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 reboot"));
  EXPECT_THAT(sent(), ElementsAre("Stop", "Subscribe"));
  // The unicast counter has restarted as well, which is no second reboot.
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
  pass(kSecond);
  offer();
  ack();
  EXPECT_THAT(sent(), ElementsAre("Subscribe"));
  EXPECT_EQ(client_->statistics().reboots, 1u);
}

TEST_F(SdClientLife, RebootIsDetectedWhenTheFlagReturns) {
  server_.multicast_session = 0xFFFE;
  become_subscribed();
  for (int i = 0; i < 3; ++i) {
    pass(kSecond);
    offer();  // 0xFFFF, then 1 with the flag cleared: no reboot
    ack();
  }
  EXPECT_EQ(server_.multicast_flags, 0x40);
  EXPECT_EQ(client_->statistics().reboots, 0u);
  EXPECT_THAT(actions_.taken(), IsEmpty());
  server_.restart();
  server_.multicast_session = 1000;
  pass(kSecond);
  offer();
  EXPECT_EQ(client_->statistics().reboots, 1u);
}

TEST_F(SdClientLife, SessionsAreCountedSeparatelyForMulticastAndUnicast) {
  server_.multicast_session = 5000;
  become_subscribed();
  for (int i = 0; i < 20; ++i) {
    pass(kSecond);
    offer();
    ack();
  }
  EXPECT_EQ(client_->statistics().reboots, 0u);
  // A reboot detected by a unicast message.
  pass(100 * kMillisecond);
  server_.unicast_session = 1;
  actions_.sent.clear();
  ack();
  EXPECT_EQ(client_->statistics().reboots, 1u);
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 reboot"));
  EXPECT_THAT(sent(), ElementsAre("Stop", "Subscribe"));
}

TEST_F(SdClientLife, ARebootOfAnotherServerIsIgnored) {
  become_subscribed();
  Server other{.address = 0x0A000063};
  for (int i = 0; i < 3; ++i) {
    pass(kMillisecond * 20);
    multicast(other.by_multicast({{.service = 0x9999}}), other);
    other.restart();
  }
  EXPECT_EQ(client_->statistics().reboots, 2u);
  EXPECT_THAT(actions_.taken(), IsEmpty());
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(SdClientLife, TheNetworksCopyOfADatagramIsNoReboot) {
  become_subscribed();
  pass(kSecond);
  const Bytes datagram = server_.offer();
  multicast(datagram, server_);
  multicast(datagram, server_);
  EXPECT_EQ(client_->statistics().reboots, 0u);
  pass(50 * kMillisecond);
  multicast(datagram, server_);
  EXPECT_EQ(client_->statistics().reboots, 1u);
}

TEST_F(SdClientLife, ARebootedServerWithAnUnlimitedOfferMustOfferAgain) {
  start();
  multicast(server_.offer(kForever_s), server_);
  ack();
  static_cast<void>(actions_.taken());
  pass(kSecond);
  server_.restart();
  multicast(server_.by_multicast({{.service = 0x9999}}), server_);
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 reboot"));
  pass(6 * kSecond);
  EXPECT_EQ(client_->state(0).phase, SdSubscriptionState::Phase::kSeeking);
}

TEST_F(SdClientLife, ARefusalIsAFaultAndWaitsLongerEachTime) {
  start();
  offer();
  std::vector<std::int64_t> waits_ms;
  for (int i = 0; i < 8; ++i) {
    actions_.sent.clear();
    unicast(server_.ack(0), server_);
    EXPECT_EQ(actions_.last_fault, Fault::kLink);
    const std::int64_t refused_ns = now_ns_;
    while (actions_.sent.empty() && now_ns_ < refused_ns + 100 * kSecond) {
      multicast(server_.offer(), server_);
      pass(100 * kMillisecond);
    }
    waits_ms.push_back((now_ns_ - refused_ns) / kMillisecond);
  }
  EXPECT_THAT(waits_ms, ElementsAre(1000, 2000, 4000, 8000, 16000, 32000, 32000, 32000));
  EXPECT_EQ(client_->statistics().refusals, 8u);
  EXPECT_EQ(actions_.faults, 8u);
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
  // A refused renewal ends the subscription; a server that stops and starts is subscribed without a wait.
  unicast(server_.ack(0), server_);
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 refused"));
  multicast(server_.offer(0), server_);
  pass(200 * kMillisecond);
  actions_.sent.clear();
  offer();
  EXPECT_THAT(sent(), ElementsAre("Subscribe"));
}

TEST_F(SdClientLife, ARestartedServerIsAskedAtOnceAfterItsRefusal) {
  start();
  multicast(server_.offer(kForever_s), server_);
  for (int i = 0; i < 4; ++i) {
    unicast(server_.ack(0), server_);
    pass(kSecond * (1 << i));
  }
  unicast(server_.ack(0), server_);
  pass(2 * kSecond);
  actions_.sent.clear();
  server_.restart();
  offer();
  EXPECT_THAT(sent(), ElementsAre("Stop", "Subscribe"));
}

TEST_F(SdClientLife, EventsBeforeTheRebootDoNotCountAsAnAck) {
  become_subscribed();
  pass(20 * kMillisecond);
  server_.restart();
  server_.multicast_session = 1;
  // Within 100 ms of the last Subscribe: the next one has to wait, and arriving events belong to the old subscription.
  offer();
  client_->event_received(0, now_ns_);
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 reboot"));
  pass(100 * kMillisecond);
  client_->event_received(0, now_ns_);
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
}

TEST_F(SdClientLife, JoinsTheGroupOfTheAckAndLeavesItWithTheSubscription) {
  start();
  offer();
  unicast(server_.ack_multicast(0xEF010203, 30600), server_);
  EXPECT_THAT(actions_.taken(), ElementsAre("join 0 239.1.2.3:30600", kSubscribed0));
  unicast(server_.ack_multicast(0xEF010203, 30600), server_);
  EXPECT_THAT(actions_.taken(), IsEmpty());
  pass(kSecond);
  unicast(server_.ack_multicast(0xEF010204, 30600), server_);
  EXPECT_THAT(actions_.taken(), ElementsAre("leave 0 239.1.2.3:30600", "join 0 239.1.2.4:30600"));
  multicast(server_.offer(0), server_);
  EXPECT_THAT(actions_.taken(), ElementsAre("leave 0 239.1.2.4:30600", "unsubscribed 0 StopOffer"));
}

TEST_F(SdClientLife, AcksWithChangingGroupsChangeTheGroupOnceASecond) {
  start();
  offer();
  for (int i = 0; i < 25; ++i) {
    const auto last = static_cast<std::uint32_t>(i % 2);
    unicast(i % 3 == 2 ? server_.ack() : server_.ack_multicast(0xEF010203 + last, 30600), server_);
    now_ns_ += 100 * kMillisecond;
  }
  const std::vector<std::string> taken = actions_.taken();
  const auto joins = std::count_if(taken.begin(), taken.end(), [](const auto& t) { return t.starts_with("join"); });
  const auto leaves = std::count_if(taken.begin(), taken.end(), [](const auto& t) { return t.starts_with("leave"); });
  EXPECT_GE(joins, 2);
  EXPECT_LE(joins + leaves, 2 * 3);
  EXPECT_GT(actions_.faults, 10u);
  EXPECT_EQ(client_->state(0).phase, SdSubscriptionState::Phase::kSubscribed);
}

TEST_F(SdClientLife, AnAckWithAnInvalidGroupIsAFault) {
  start();
  offer();
  unicast(server_.ack_multicast(0x0A000001, 30600), server_);
  EXPECT_THAT(actions_.taken(), IsEmpty());
  EXPECT_EQ(actions_.last_fault, Fault::kWireValue);
  EXPECT_EQ(client_->statistics().malformed_entries, 1u);
}

TEST_F(SdClientLife, EventsCountAsAnAckThatAnotherProgramReceived) {
  start();
  client_->event_received(0, now_ns_);
  EXPECT_THAT(actions_.taken(), IsEmpty()) << "no offer yet";
  offer();
  client_->event_received(7, now_ns_);
  EXPECT_THAT(actions_.taken(), IsEmpty()) << "of another subscription";
  client_->event_received(0, now_ns_);
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
  for (int i = 0; i < 100; ++i) {
    pass(100 * kMillisecond);
    client_->event_received(0, now_ns_);
    if (i % 10 == 0) offer();
  }
  EXPECT_THAT(actions_.taken(), IsEmpty());
  EXPECT_EQ(actions_.faults, 0u);
  EXPECT_EQ(client_->statistics().acknowledged_by_events, 1u);
}

TEST_F(SdClientLife, MissingAckAndEventsAreAFaultAndSubscribeAgain) {
  become_subscribed();
  for (int i = 0; i < 3; ++i) {
    pass(900 * kMillisecond);
    offer();
  }
  EXPECT_THAT(actions_.taken(), IsEmpty());
  actions_.sent.clear();
  pass(400 * kMillisecond);
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 no Ack"));
  EXPECT_EQ(actions_.faults, 1u);
  EXPECT_THAT(sent(), ElementsAre("Stop", "Subscribe"));
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
}

TEST_F(SdClientLife, AServerWithoutAckIsReportedOnceAndSubscribedRepeatedly) {
  start();
  for (int i = 0; i < 30; ++i) {
    offer();
    pass(kSecond);
  }
  EXPECT_EQ(actions_.faults, 1u);
  EXPECT_EQ(client_->statistics().subscribes_sent, 30u);
  EXPECT_THAT(actions_.taken(), IsEmpty());
}

TEST_F(SdClientLife, AfterTheLinkReturnsItSeeksAndSubscribesAgain) {
  become_subscribed();
  client_->link_down();
  due_ns_ = SdClient::kNever;
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 link down"));
  multicast(server_.offer(), server_);
  EXPECT_EQ(client_->tick(now_ns_), SdClient::kNever);
  EXPECT_THAT(sent(), IsEmpty());
  now_ns_ += kSecond;
  due_ns_ = client_->link_up(now_ns_);
  EXPECT_THAT(sent(), ElementsAre("Find"));
  offer();
  EXPECT_THAT(sent(), ElementsAre("Stop", "Subscribe"));
  ack();
  EXPECT_THAT(actions_.taken(), ElementsAre(kSubscribed0));
  EXPECT_EQ(client_->statistics().reboots, 0u);
}

TEST_F(SdClientLife, StopWithdraws) {
  become_subscribed();
  client_->stop(now_ns_);
  EXPECT_THAT(sent(), ElementsAre("Stop"));
  EXPECT_THAT(actions_.taken(), ElementsAre("unsubscribed 0 stopped"));
  offer();
  EXPECT_EQ(client_->tick(now_ns_ + 10 * kSecond), SdClient::kNever);
  EXPECT_THAT(sent(), IsEmpty());
}

}  // namespace
}  // namespace boresight::ingest::someip
