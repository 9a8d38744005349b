// The client's work is bounded for all input: many messages, many peers, changed messages.
#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/ingest_gateway/core/sd_client.hpp"
#include "tests/unit/someip/sd_server.hpp"

namespace boresight::ingest::someip {
namespace {

using test::Bytes;
using test::kMillisecond;
using test::kSecond;
using test::Server;

/// Only counts, so that all allocations are the client's.
class CountedActions : public SdActions {
 public:
  void send(std::span<const std::uint8_t> /*datagram*/, const recording::Endpoint& /*to*/) override { ++calls; }
  void subscribed(std::size_t /*index*/, const recording::Endpoint& /*server*/) override { ++calls; }
  void unsubscribed(std::size_t /*index*/, UnsubscribeReason /*reason*/) override { ++calls; }
  void join_multicast(std::size_t /*index*/, const recording::Endpoint& /*group*/) override { ++joined; }
  void leave_multicast(std::size_t /*index*/, const recording::Endpoint& /*group*/) override { --joined; }
  void fault(Fault /*kind*/, std::string_view /*what*/) override { ++calls; }
  std::size_t calls = 0;
  int joined = 0;
};

class SdStorm : public testing::Test {
 protected:
  SdStorm() { static_cast<void>(client_.start(now_ns_)); }
  void become_subscribed() {
    static_cast<void>(client_.take(server_.offer(), server_.sd(), true, now_ns_));
    static_cast<void>(client_.take(server_.ack(), server_.sd(), false, now_ns_));
    ASSERT_EQ(client_.state(0).phase, SdSubscriptionState::Phase::kSubscribed);
  }

  test::RecordedActions actions_;
  SdClient client_{
      {test::kLocal, test::kGroup, {{.index = 0, .service = 0x1234, .eventgroup = 0x10, .local_port = 40001}}},
      actions_};
  Server server_;
  std::int64_t now_ns_ = 5'000 * kSecond;
};

TEST_F(SdStorm, AStormOfOffersAndRebootsLeadsToTenSubscribesASecond) {
  for (int i = 0; i < 10'000; ++i) {
    now_ns_ += kMillisecond;
    if (i % 3 == 0) server_.restart();
    static_cast<void>(client_.take(server_.offer(), server_.sd(), true, now_ns_));
    if (i % 7 == 0) static_cast<void>(client_.take(server_.offer(0), server_.sd(), true, now_ns_));
  }
  EXPECT_LE(client_.statistics().subscribes_sent, 101u);
  EXPECT_GE(client_.statistics().subscribes_sent, 50u);
  EXPECT_LE(actions_.datagrams, 110u);
  EXPECT_GT(client_.statistics().subscribes_put_off, 1000u);
  // Afterwards, the subscription is back within one offer.
  now_ns_ += kSecond;
  static_cast<void>(client_.take(server_.offer(), server_.sd(), true, now_ns_));
  static_cast<void>(client_.take(server_.ack(), server_.sd(), false, now_ns_));
  EXPECT_EQ(client_.state(0).phase, SdSubscriptionState::Phase::kSubscribed);
}

TEST_F(SdStorm, ManyPeersDoNotDisplaceTheServer) {
  become_subscribed();
  for (std::uint32_t i = 0; i < 5'000; ++i) {
    now_ns_ += 10'000;
    Server stranger{.address = 0x0B000000 + i};
    static_cast<void>(client_.take(stranger.by_multicast({{.service = 0x9999}}), stranger.sd(), true, now_ns_));
  }
  EXPECT_EQ(client_.number_of_peers(), SdClient::kSparePeers + 1);
  actions_.sent.clear();
  now_ns_ += kSecond;
  static_cast<void>(client_.take(server_.offer(), server_.sd(), true, now_ns_));
  ASSERT_EQ(actions_.sent.size(), 1u);
  EXPECT_EQ(actions_.sent[0].session, 2) << "the client's counter is kept, or the server would detect a reboot";
  server_.restart();
  now_ns_ += kSecond;
  static_cast<void>(client_.take(server_.offer(), server_.sd(), true, now_ns_));
  EXPECT_EQ(client_.statistics().reboots, 1u);
}

TEST_F(SdStorm, NothingAllocates) {
  std::vector<Bytes> offers, acks, strangers;
  for (int i = 0; i < 300; ++i) {
    if (i % 50 == 0) server_.restart();
    offers.push_back(server_.offer(i % 20 == 0 ? 0 : 3));
    acks.push_back(i % 9 == 0 ? server_.ack(0) : server_.ack_multicast(0xEF010200 + static_cast<unsigned>(i) % 3, 9));
    strangers.push_back(Server{}.by_multicast({{.service = 0x9999}}));
  }
  CountedActions actions;
  SdClient client({test::kLocal, test::kGroup, {{.index = 0, .service = 0x1234, .eventgroup = 0x10, .local_port = 1}}},
                  actions);
  static_cast<void>(client.start(now_ns_));
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (std::size_t i = 0; i < offers.size(); ++i) {
      now_ns_ += 300 * kMillisecond;
      static_cast<void>(client.take(offers[i], server_.sd(), true, now_ns_));
      static_cast<void>(client.take(acks[i], server_.sd(), false, now_ns_));
      const auto address = 0x0B000000 + static_cast<std::uint32_t>(i);
      static_cast<void>(client.take(strangers[i], test::endpoint(address, 30490), true, now_ns_));
      client.event_received(0, now_ns_);
      if (i == 200) {
        client.link_down();
        static_cast<void>(client.link_up(now_ns_));
      }
    }
    static_cast<void>(client.tick(now_ns_ += 10 * kSecond));
    client.stop(now_ns_);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_GT(client.statistics().acks, 100u);
  EXPECT_GT(actions.calls, 200u);
  EXPECT_EQ(actions.joined, 0) << "every group is left at the end";
}

TEST_F(SdStorm, ChangedMessagesOfOthersDoNotDisturbASubscription) {
  become_subscribed();
  static_cast<void>(actions_.taken());
  std::mt19937 random(11);
  Server stranger{.address = 0x0B000001};
  for (int i = 0; i < 20'000; ++i) {
    now_ns_ += 20 * kMillisecond;
    Bytes bytes = i % 2 == 0 ? stranger.offer(static_cast<std::uint32_t>(random() % 4), 1)
                             : stranger.ack_multicast(0xEF010203, 30600);
    static_cast<void>(client_.take(test::mutated(random, bytes), stranger.sd(), i % 2 == 0, now_ns_));
    if (i % 50 == 0) {
      static_cast<void>(client_.take(server_.offer(), server_.sd(), true, now_ns_));
      static_cast<void>(client_.take(server_.ack(), server_.sd(), false, now_ns_));
    }
  }
  EXPECT_THAT(actions_.taken(), testing::IsEmpty());
  EXPECT_EQ(client_.state(0).phase, SdSubscriptionState::Phase::kSubscribed);
  EXPECT_GT(client_.statistics().malformed_messages, 1000u);
}

TEST_F(SdStorm, ChangedMessagesOfTheServerAreHandled) {
  std::mt19937 random(12);
  for (int i = 0; i < 20'000; ++i) {
    now_ns_ += 20 * kMillisecond;
    const Bytes bytes = i % 2 == 0 ? server_.offer() : server_.ack_multicast(0xEF010203, 30600);
    static_cast<void>(client_.take(test::mutated(random, bytes), server_.sd(), i % 2 == 0, now_ns_));
    ASSERT_GT(client_.tick(now_ns_), now_ns_);
  }
  // A changed offer may name another endpoint without time limit. A StopOffer and a true offer correct it.
  server_.restart();
  now_ns_ += 100 * kSecond;
  static_cast<void>(client_.take(server_.offer(0), server_.sd(), true, now_ns_));
  now_ns_ += kSecond;
  static_cast<void>(client_.take(server_.offer(), server_.sd(), true, now_ns_));
  now_ns_ += kSecond;
  static_cast<void>(client_.tick(now_ns_));
  static_cast<void>(client_.take(server_.ack(), server_.sd(), false, now_ns_));
  EXPECT_EQ(client_.state(0).phase, SdSubscriptionState::Phase::kSubscribed);
  EXPECT_EQ(client_.state(0).server, test::endpoint(test::kServerAddress, 30501));
}

}  // namespace
}  // namespace boresight::ingest::someip
