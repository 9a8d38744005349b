// A client, its server and the time between them.
#pragma once

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/ingest_gateway/core/sd_client.hpp"
#include "tests/unit/someip/sd_server.hpp"

namespace boresight::ingest::someip::test {

inline const std::string kSubscribed0 = "subscribed 0 10.0.0.20:30501";

class SdClientTest : public testing::Test {
 protected:
  SdClientTest() { make({{.index = 0, .service = 0x1234, .eventgroup = 0x10, .local_port = 40001}}); }

  void make(std::vector<SdSubscription> subscriptions) {
    client_ = std::make_unique<SdClient>(SdClientConfig{kLocal, kGroup, std::move(subscriptions)}, actions_);
  }
  /// Advances the time and calls tick() exactly at its requested times.
  void pass(std::int64_t duration_ns) {
    const std::int64_t end_ns = now_ns_ + duration_ns;
    for (int guard = 0; due_ns_ <= end_ns; ++guard) {
      ASSERT_LT(guard, 10'000) << "tick() requests calls without end";
      now_ns_ = std::max(now_ns_, due_ns_);
      due_ns_ = client_->tick(now_ns_);
    }
    now_ns_ = end_ns;
  }
  void start() { due_ns_ = client_->start(now_ns_); }
  void multicast(const Bytes& datagram, const Server& server) {
    due_ns_ = client_->take(datagram, server.sd(), true, now_ns_);
  }
  void unicast(const Bytes& datagram, const Server& server) {
    due_ns_ = client_->take(datagram, server.sd(), false, now_ns_);
  }
  void offer() { multicast(server_.offer(), server_); }
  void ack() { unicast(server_.ack(), server_); }
  void become_subscribed() {
    start();
    offer();
    ack();
    ASSERT_THAT(actions_.taken(), testing::ElementsAre(kSubscribed0));
    actions_.sent.clear();
  }
  /// Types and times to live of sent entries, such as "Subscribe 3".
  std::vector<std::string> sent() {
    std::vector<std::string> texts;
    for (const SentEntry& s : actions_.taken_sent()) {
      texts.push_back(s.type == EntryType::kFind        ? "Find"
                      : s.type != EntryType::kSubscribe ? "?"
                      : s.ttl_s == 0                    ? "Stop"
                                                        : "Subscribe");
    }
    return texts;
  }

  RecordedActions actions_;
  std::unique_ptr<SdClient> client_;
  Server server_;
  std::int64_t now_ns_ = 5'000 * kSecond;
  std::int64_t due_ns_ = SdClient::kNever;
};

}  // namespace boresight::ingest::someip::test
