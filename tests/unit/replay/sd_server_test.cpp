#include "services/common/someip/sd_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/replay/core/radar_service.hpp"
#include "tests/unit/replay/document.hpp"

namespace boresight::replay {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;
using Bytes = std::vector<std::uint8_t>;
using recording::Endpoint;
using recording::IpAddress;
using someip::SdOutgoing;
using someip::SdServer;
using someip::SdServerConfig;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond_ns = 1'000 * kMs;
constexpr std::uint16_t kDetections = 1, kEgo = 2;

Endpoint endpoint(std::uint8_t last, std::uint16_t port) {
  return {IpAddress::v4(0xC0A80A00u | last), port};
}
const Endpoint kServerEvents = endpoint(13, 30603);
const Endpoint kClientSd = endpoint(2, 30490);
const Endpoint kClientEvents = endpoint(2, 41000);
const Endpoint kGroup{IpAddress::v4(0xEF425301), 30650};

void put(Bytes& bytes, std::uint64_t value, int count) {
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// A client's entries and options, written without the code under test.
struct Client {
  Bytes entries, options;
  std::uint8_t number_of_options = 0;

  Client& option_v4(std::uint8_t type, std::uint32_t address, std::uint8_t protocol, std::uint16_t port) {
    put(options, 9, 2);
    put(options, type, 1);
    put(options, 0, 1);
    put(options, address, 4);
    put(options, 0, 1);
    put(options, protocol, 1);
    put(options, port, 2);
    ++number_of_options;
    return *this;
  }
  Client& at(const Endpoint& where) { return option_v4(0x04, where.address.to_v4(), 17, where.port); }
  /// Refers to the option added last, if there is any.
  Client& subscribe(std::uint16_t eventgroup, std::uint32_t ttl, std::uint16_t instance = 3, std::uint8_t major = 1,
                    std::uint16_t counter = 0, std::uint16_t service = 0x4253) {
    put(entries, 0x06, 1);
    put(entries, number_of_options == 0 ? 0 : number_of_options - 1u, 1);
    put(entries, 0, 1);
    put(entries, number_of_options == 0 ? 0x00 : 0x10, 1);
    put(entries, service, 2);
    put(entries, instance, 2);
    put(entries, major, 1);
    put(entries, ttl, 3);
    put(entries, counter, 2);
    put(entries, eventgroup, 2);
    return *this;
  }
  Client& find(std::uint16_t instance, std::uint8_t major = 0xFF, std::uint32_t minor = 0xFFFFFFFF,
               std::uint16_t service = 0x4253) {
    put(entries, 0, 4);
    put(entries, service, 2);
    put(entries, instance, 2);
    put(entries, major, 1);
    put(entries, 0xFFFFFF, 3);
    put(entries, minor, 4);
    return *this;
  }
  [[nodiscard]] Bytes message(std::uint16_t session, bool reboot = true) const {
    Bytes m;
    put(m, 0xFFFF8100, 4);
    put(m, 8 + 4 + 4 + entries.size() + 4 + options.size(), 4);
    put(m, session, 4);
    put(m, 0x01010200, 4);
    put(m, reboot ? 0xC0000000 : 0x40000000, 4);
    put(m, entries.size(), 4);
    m.insert(m.end(), entries.begin(), entries.end());
    put(m, options.size(), 4);
    m.insert(m.end(), options.begin(), options.end());
    return m;
  }
};

std::uint32_t ttl_of(const Bytes& m, std::size_t entry = 0) {
  const std::size_t at = 24 + 16 * entry + 9;
  return static_cast<std::uint32_t>(m[at] << 16 | m[at + 1] << 8 | m[at + 2]);
}
std::uint16_t session_of(const Bytes& m) {
  return static_cast<std::uint16_t>(m[10] << 8 | m[11]);
}
std::size_t entries_of(const Bytes& m) {
  return (m[22] << 8 | m[23]) / 16u;
}

class SdServerTest : public ::testing::Test {
 protected:
  static SdServerConfig configuration(bool multicast) {
    SdServerConfig config;
    config.service = radar_service();
    config.instances = {{3, kServerEvents}};
    if (multicast) config.event_group = kGroup;
    config.max_subscribers = 8;
    return config;
  }
  void make(const SdServerConfig& config) {
    server.emplace(config);
    server->start(0);
    tick(50 * kMs);
    out.clear();
  }
  void SetUp() override { make(configuration(false)); }

  void tick(std::int64_t now) { server->tick(now, out); }
  /// The answer, which must be one message at the most.
  Bytes receive(const Bytes& message, std::int64_t now = 100 * kMs, bool multicast = false,
                const Endpoint& from = kClientSd) {
    out.clear();
    problem = server->receive(now, message, from, multicast, out);
    EXPECT_LE(out.size(), 1u);
    if (out.empty()) return {};
    EXPECT_EQ(out[0].to, from);
    return out[0].message;
  }
  std::vector<Endpoint> destinations(std::int64_t now = 100 * kMs, std::uint16_t eventgroup = kDetections) {
    const auto span = server->destinations(3, eventgroup, now);
    return {span.begin(), span.end()};
  }
  std::optional<SdServer> server;
  std::vector<SdOutgoing> out;
  std::optional<std::string_view> problem;
};

TEST_F(SdServerTest, OffersAtFirstOftenThenEachCycle) {
  server.emplace(configuration(false));
  EXPECT_GT(server->next_due_ns(), 1'000'000 * kSecond_ns);
  server->start(kSecond_ns);
  std::vector<std::int64_t> at_ms;
  for (std::int64_t now = kSecond_ns; now < 6 * kSecond_ns; now += 10 * kMs) {
    const std::size_t before = out.size();
    const bool due = server->next_due_ns() <= now;
    server->tick(now, out);
    EXPECT_EQ(due, out.size() > before) << now;
    if (out.size() > before) at_ms.push_back((now - kSecond_ns) / kMs);
  }
  EXPECT_THAT(at_ms, ElementsAre(50, 250, 650, 1450, 2450, 3450, 4450));
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_FALSE(out[i].to.has_value());
    EXPECT_EQ(session_of(out[i].message), i + 1);
    EXPECT_EQ(out[i].message[16], 0xC0);
  }
  EXPECT_THAT(out[0].message, ElementsAreArray(document_example("offer")));
}

TEST_F(SdServerTest, MissedCyclesAreSkipped) {
  tick(60 * kSecond_ns);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_GT(server->next_due_ns(), 60 * kSecond_ns);
  tick(60 * kSecond_ns);
  EXPECT_EQ(out.size(), 1u);
}

TEST_F(SdServerTest, OffersSeveralInstancesWithTheirEndpointsInOneMessage) {
  SdServerConfig config;
  config.service = radar_service();
  IpAddress v6;
  v6.bytes = {0xFD, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  config.instances = {{1, endpoint(13, 30601)}, {2, {v6, 30602}}};
  server.emplace(config);
  server->start(0);
  tick(kSecond_ns);
  ASSERT_EQ(out.size(), 1u);
  const Bytes& m = out[0].message;
  ASSERT_EQ(m.size(), 16u + 4 + 4 + 32 + 4 + 12 + 24);
  EXPECT_EQ(m[24 + 16 + 1], 1) << "the second entry's first option is the second one";
  EXPECT_EQ(m[24 + 16 + 7], 2);
  EXPECT_THAT(Bytes(m.end() - 24, m.end()),
              ElementsAre(0, 0x15, 6, 0, 0xFD, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 17, 0x77, 0x8A));
}

TEST_F(SdServerTest, ClearsTheRebootFlagOfOffersWhenTheirSessionWraps) {
  for (std::int64_t i = 1; i < 0x10002; ++i) {
    out.clear();
    tick(i * 2 * kSecond_ns);
    ASSERT_EQ(out.size(), 1u);
    const bool first_round = i + 1 <= 0xFFFF;
    ASSERT_EQ(out[0].message[16], first_round ? 0xC0 : 0x40) << i;
    ASSERT_EQ(session_of(out[0].message), first_round ? i + 1 : i + 1 - 0xFFFF);
  }
  // Unicast has a separate counter.
  const Bytes ack = receive(Client().at(kClientEvents).subscribe(kDetections, 3).message(1), 0x30000 * kSecond_ns);
  ASSERT_FALSE(ack.empty());
  EXPECT_EQ(session_of(ack), 1);
  EXPECT_EQ(ack[16], 0xC0);
}

TEST_F(SdServerTest, AcknowledgesTheDocumentsSubscription) {
  make(configuration(true));
  const Bytes ack = receive(document_example("subscribe"));
  EXPECT_THAT(ack, ElementsAreArray(document_example("acknowledge")));
  EXPECT_THAT(destinations(), ElementsAre(kGroup));
  EXPECT_THAT(destinations(100 * kMs, kEgo), IsEmpty());
  // A second subscriber does not double the events.
  receive(Client().at(endpoint(4, 5)).subscribe(kDetections, 3).message(1), 100 * kMs, false, endpoint(4, 30490));
  EXPECT_THAT(destinations(), ElementsAre(kGroup));
}

TEST_F(SdServerTest, WithoutAGroupTheEventsGoToEachSubscriberOnce) {
  Bytes ack = receive(document_example("subscribe"));
  ASSERT_EQ(ack.size(), 16u + 4 + 4 + 16 + 4);
  EXPECT_EQ(ack[24 + 3], 0) << "no option";
  EXPECT_EQ(ttl_of(ack), 3u);
  const Endpoint other = endpoint(4, 41000);
  ack = receive(Client().at(other).subscribe(kDetections, 3).subscribe(kEgo, 3).message(1), 100 * kMs, false,
                endpoint(4, 30490));
  EXPECT_EQ(entries_of(ack), 2u);
  EXPECT_EQ(session_of(ack), 1) << "a counter for each peer";
  EXPECT_THAT(destinations(), ElementsAre(kClientEvents, other));
  EXPECT_THAT(destinations(100 * kMs, kEgo), ElementsAre(other));
  // The same endpoint with another counter is a separate subscription, but gets no second copy.
  EXPECT_EQ(ttl_of(receive(Client().at(kClientEvents).subscribe(kDetections, 3, 3, 1, 1).message(2))), 3u);
  EXPECT_THAT(destinations(), ElementsAre(kClientEvents, other));
  EXPECT_EQ(session_of(receive(Client().at(kClientEvents).subscribe(kDetections, 3).message(3))), 3);
}

TEST_F(SdServerTest, RefusesWhatItDoesNotServe) {
  const auto refused = [&](Client client) {
    const Bytes nack = receive(client.message(1, false));
    return !nack.empty() && nack[24] == 0x07 && ttl_of(nack) == 0 && nack[24 + 3] == 0 && destinations().empty();
  };
  make(configuration(true));
  EXPECT_TRUE(refused(Client().at(kClientEvents).subscribe(3, 3))) << "eventgroup";
  EXPECT_TRUE(refused(Client().at(kClientEvents).subscribe(kDetections, 3, 3, 2))) << "major version";
  EXPECT_TRUE(refused(Client().at(kClientEvents).subscribe(kDetections, 3, 4))) << "instance";
  EXPECT_TRUE(refused(Client().at(kClientEvents).subscribe(kDetections, 3, 3, 1, 0, 0x4254))) << "service";
  EXPECT_TRUE(refused(Client().subscribe(kDetections, 3))) << "no endpoint";
  EXPECT_TRUE(refused(Client().option_v4(0x04, 0xC0A80A02, 6, 41000).subscribe(kDetections, 3))) << "TCP";
  EXPECT_TRUE(refused(Client().option_v4(0x04, 0xEF000001, 17, 41000).subscribe(kDetections, 3))) << "a group";
  EXPECT_TRUE(refused(Client().option_v4(0x04, 0, 17, 41000).subscribe(kDetections, 3))) << "no address";
  EXPECT_TRUE(refused(Client().option_v4(0x04, 0xC0A80A02, 17, 0).subscribe(kDetections, 3))) << "no port";
  EXPECT_TRUE(refused(Client().option_v4(0x24, 0xC0A80A02, 17, 4).subscribe(kDetections, 3))) << "other option";
  EXPECT_EQ(server->statistics().refused, 10u);
  EXPECT_EQ(server->statistics().acknowledged, 0u);
}

TEST_F(SdServerTest, RefusesSubscribersBeyondTheLimit) {
  for (std::uint16_t i = 0; i < 8; ++i) {
    const Bytes ack = receive(Client()
                                  .at(endpoint(2, static_cast<std::uint16_t>(50000 + i)))
                                  .subscribe(kDetections, 3)
                                  .message(static_cast<std::uint16_t>(i + 1)));
    EXPECT_EQ(ttl_of(ack), 3u);
  }
  EXPECT_EQ(ttl_of(receive(Client().at(kClientEvents).subscribe(kDetections, 3).message(9))), 0u);
  EXPECT_EQ(ttl_of(receive(Client().at(kClientEvents).subscribe(kEgo, 3).message(10))), 3u) << "there is room there";
  EXPECT_EQ(ttl_of(receive(Client().at(endpoint(2, 50003)).subscribe(kDetections, 3).message(11))), 3u) << "renewal";
  EXPECT_EQ(destinations().size(), 8u);
}

TEST_F(SdServerTest, SubscriptionsEndWithTheirTimeUnlessRenewed) {
  const Client client = Client().at(kClientEvents).subscribe(kDetections, 2);
  receive(client.message(1), kSecond_ns);
  EXPECT_EQ(destinations(3 * kSecond_ns - 1).size(), 1u);
  EXPECT_THAT(destinations(3 * kSecond_ns), IsEmpty());
  receive(client.message(2), 2 * kSecond_ns);
  EXPECT_EQ(destinations(4 * kSecond_ns - 1).size(), 1u);
  tick(4 * kSecond_ns);
  EXPECT_THAT(destinations(3 * kSecond_ns), IsEmpty()) << "once ended, it is gone";
  EXPECT_EQ(server->statistics().expired, 1u);
  receive(Client().at(kClientEvents).subscribe(kDetections, 0xFFFFFF).message(3), 5 * kSecond_ns);
  EXPECT_EQ(destinations(20'000'000 * kSecond_ns).size(), 1u) << "without time limit";
}

TEST_F(SdServerTest, AClientCanEndItsSubscription) {
  receive(Client().at(kClientEvents).subscribe(kDetections, 3).subscribe(kEgo, 3).message(1));
  EXPECT_TRUE(receive(Client().at(kClientEvents).subscribe(kDetections, 0).message(2)).empty()) << "not answered";
  EXPECT_THAT(destinations(), IsEmpty());
  EXPECT_EQ(destinations(100 * kMs, kEgo).size(), 1u);
  // Stop and subscribe in one message, as clients do after a reboot.
  const Bytes ack = receive(Client().at(kClientEvents).subscribe(kEgo, 0).subscribe(kEgo, 3).message(3));
  EXPECT_EQ(entries_of(ack), 1u);
  EXPECT_EQ(destinations(100 * kMs, kEgo).size(), 1u);
  // No other subscription.
  receive(Client().at(kClientEvents).subscribe(kEgo, 0).message(1), 100 * kMs, false, endpoint(9, 30490));
  EXPECT_EQ(destinations(100 * kMs, kEgo).size(), 1u);
}

TEST_F(SdServerTest, SubscriptionsOfOneEndpointAreDistinguishedByClientAndCounter) {
  const Bytes ack = receive(Client().at(kClientEvents).subscribe(kDetections, 3, 3, 1, 5).message(1));
  EXPECT_EQ(ack[24 + 13], 5) << "the counter comes back";
  receive(Client().at(kClientEvents).subscribe(kDetections, 3).message(2));
  receive(Client().at(kClientEvents).subscribe(kDetections, 3).message(1), 100 * kMs, false, endpoint(9, 30490));
  EXPECT_THAT(destinations(), ElementsAre(kClientEvents));
  receive(Client().at(kClientEvents).subscribe(kDetections, 0).message(3));
  EXPECT_THAT(destinations(), ElementsAre(kClientEvents)) << "its other subscription, and that of the other client";
  receive(Client().at(kClientEvents).subscribe(kDetections, 0, 3, 1, 5).message(4));
  EXPECT_THAT(destinations(), ElementsAre(kClientEvents)) << "that of the other client";
  receive(Client().at(kClientEvents).subscribe(kDetections, 0).message(2), 100 * kMs, false, endpoint(9, 30490));
  EXPECT_THAT(destinations(), IsEmpty());
}

TEST_F(SdServerTest, ForgetsWhatARebootedClientHadSubscribed) {
  const Endpoint other_sd = endpoint(4, 30490);
  receive(Client().at(kClientEvents).subscribe(kDetections, 3).message(5));
  receive(Client().at(endpoint(4, 41000)).subscribe(kDetections, 3).message(5), 100 * kMs, false, other_sd);
  // Multicast sessions are counted separately: a 1 there is no reboot.
  receive(Client().find(9).message(1), 100 * kMs, true);
  EXPECT_EQ(destinations().size(), 2u);
  receive(Client().at(kClientEvents).subscribe(kEgo, 3).message(6), 100 * kMs);
  EXPECT_EQ(destinations().size(), 2u);
  receive(Client().at(kClientEvents).subscribe(kEgo, 3).message(6), 100 * kMs);
  EXPECT_THAT(destinations(), ElementsAre(endpoint(4, 41000))) << "session did not grow";
  EXPECT_EQ(destinations(100 * kMs, kEgo).size(), 1u) << "the subscription of the same message counts";
  EXPECT_EQ(server->statistics().client_reboots, 1u);
  // After a wrap (flag cleared) sessions may decrease; a flag that is set again is a reboot.
  receive(Client().find(9).message(7, false));
  receive(Client().find(9).message(1, false));
  EXPECT_EQ(server->statistics().client_reboots, 1u);
  receive(Client().find(9).message(2, true));
  EXPECT_EQ(server->statistics().client_reboots, 2u);
  EXPECT_THAT(destinations(100 * kMs, kEgo), IsEmpty());
}

TEST_F(SdServerTest, AnswersFindService) {
  const auto found = [&](const Client& client) { return !receive(client.message(1, false), 100 * kMs, true).empty(); };
  EXPECT_TRUE(found(Client().find(0xFFFF)));
  EXPECT_TRUE(found(Client().find(3, 1, 0)));
  EXPECT_FALSE(found(Client().find(4)));
  EXPECT_FALSE(found(Client().find(3, 2)));
  EXPECT_FALSE(found(Client().find(3, 1, 1)));
  EXPECT_FALSE(found(Client().find(3, 0xFF, 0xFFFFFFFF, 0x1234)));
  const Bytes offer = receive(Client().find(0xFFFF).find(3).find(3).message(2), 100 * kMs, true);
  EXPECT_EQ(entries_of(offer), 1u) << "once for any number of entries";
  EXPECT_EQ(offer[24], 0x01);
  EXPECT_EQ(ttl_of(offer), 3u);
}

TEST_F(SdServerTest, SendsNothingBeforeItsFirstOfferAndAfterItsLast) {
  server.emplace(configuration(false));
  EXPECT_TRUE(receive(Client().find(3).message(1), 0).empty());
  server->start(0);
  EXPECT_TRUE(receive(Client().find(3).message(2), 10 * kMs).empty());
  out.clear();
  server->stop(out);
  EXPECT_THAT(out, IsEmpty()) << "nothing was offered, so nothing is withdrawn";

  server->start(0);
  tick(50 * kMs);
  receive(Client().at(kClientEvents).subscribe(kDetections, 3).message(3));
  out.clear();
  server->stop(out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_FALSE(out[0].to.has_value());
  EXPECT_EQ(out[0].message[24], 0x01);
  EXPECT_EQ(ttl_of(out[0].message), 0u);
  EXPECT_THAT(destinations(), IsEmpty());
  EXPECT_GT(server->next_due_ns(), 1'000'000 * kSecond_ns);
  EXPECT_TRUE(receive(Client().find(3).message(4)).empty());
}

TEST_F(SdServerTest, IgnoresSubscriptionsByMulticast) {
  EXPECT_TRUE(receive(document_example("subscribe"), 100 * kMs, true).empty());
  EXPECT_THAT(destinations(), IsEmpty());
}

TEST_F(SdServerTest, ReadsAllMessagesOfADatagram) {
  Bytes both = Client().at(kClientEvents).subscribe(kDetections, 3).message(1);
  const Bytes second = Client().at(kClientEvents).subscribe(kEgo, 3).message(2);
  both.insert(both.end(), second.begin(), second.end());
  out.clear();
  EXPECT_FALSE(server->receive(100 * kMs, both, kClientSd, false, out).has_value());
  EXPECT_EQ(out.size(), 2u);
  EXPECT_EQ(destinations().size(), 1u);
  EXPECT_EQ(destinations(100 * kMs, kEgo).size(), 1u);
}

TEST_F(SdServerTest, DamagedMessagesAreRejectedWithoutEffect) {
  const Bytes good = Client().at(kClientEvents).subscribe(kDetections, 3).message(1);
  for (std::size_t length = 1; length < good.size(); ++length) {
    Bytes cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_TRUE(receive(cut).empty());
    EXPECT_TRUE(problem.has_value()) << length;
    if (length < 8) continue;
    // The same with a length field that agrees.
    cut[7] = static_cast<std::uint8_t>(length - 8);
    EXPECT_TRUE(receive(cut).empty());
    EXPECT_TRUE(problem.has_value()) << length;
  }
  const auto with = [&](std::size_t at, std::uint8_t value) {
    Bytes changed = good;
    changed[at] = value;
    receive(changed);
    return problem.has_value();
  };
  EXPECT_TRUE(with(0, 0xFE)) << "service";
  EXPECT_TRUE(with(11, 0)) << "session 0";
  EXPECT_TRUE(with(12, 2)) << "protocol version";
  EXPECT_TRUE(with(13, 2)) << "interface version";
  EXPECT_TRUE(with(14, 0)) << "message type";
  EXPECT_TRUE(with(15, 1)) << "return code";
  EXPECT_TRUE(with(23, 15)) << "length of entries";
  EXPECT_TRUE(with(20, 0xFF)) << "length of entries";
  EXPECT_TRUE(with(24 + 1, 1)) << "option index";
  EXPECT_TRUE(with(24 + 3, 0x20)) << "number of options";
  EXPECT_TRUE(with(24 + 3, 0x1F)) << "number of options of the second run";
  EXPECT_TRUE(with(43, 11)) << "length of options";
  EXPECT_TRUE(with(45, 10)) << "length of an option";
  EXPECT_THAT(destinations(), IsEmpty());
  Client many;
  for (int i = 0; i < 65; ++i) many.find(3);
  EXPECT_TRUE(receive(many.message(1)).empty());
  EXPECT_TRUE(problem.has_value());
  EXPECT_FALSE(receive(good).empty()) << "the valid one is still accepted";
}

TEST_F(SdServerTest, KeepsALimitedNumberOfPeers) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Endpoint from{IpAddress::v4(0x0A000000u + i), 30490};
    EXPECT_EQ(session_of(receive(Client().find(3).message(1), 100 * kMs + i, true, from)), 1);
  }
  const Endpoint last{IpAddress::v4(0x0A000000u + 999), 30490};
  EXPECT_EQ(session_of(receive(Client().find(3).message(2), kSecond_ns, true, last)), 2) << "the latest are remembered";
  const Endpoint first{IpAddress::v4(0x0A000000u), 30490};
  EXPECT_EQ(session_of(receive(Client().find(3).message(2), kSecond_ns, true, first)), 1) << "the first is forgotten";
}

TEST_F(SdServerTest, ReportsNewSubscribersButNotRenewals) {
  receive(Client().at(kClientEvents).subscribe(kDetections, 3).subscribe(kEgo, 3).message(1));
  ASSERT_EQ(server->new_subscribers().size(), 2u);
  EXPECT_EQ(server->new_subscribers()[0].instance, 3);
  EXPECT_EQ(server->new_subscribers()[0].eventgroup, kDetections);
  EXPECT_EQ(server->new_subscribers()[0].endpoint, kClientEvents);
  EXPECT_EQ(server->new_subscribers()[1].eventgroup, kEgo);
  receive(Client().at(kClientEvents).subscribe(kDetections, 3).message(2));
  EXPECT_TRUE(server->new_subscribers().empty()) << "a renewal";
  receive(Client().subscribe(kDetections, 3).message(3));
  EXPECT_TRUE(server->new_subscribers().empty()) << "refused";
}

}  // namespace
}  // namespace boresight::replay
