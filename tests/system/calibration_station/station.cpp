#include "tests/system/calibration_station/station.hpp"

#include <array>
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/system/harness/child.hpp"

namespace boresight::calibration_station {

namespace {

namespace sd = ingest::someip;
using runtime::UdpSocket;

const recording::IpAddress kHere = recording::parse_ip(network::kServerAddress).value();
const Endpoint kDiscoveryGroup{recording::parse_ip("224.244.224.245").value(), 30490};
const Endpoint kEcuDiscovery{recording::parse_ip(network::kEcuAddress).value(), 30490};

std::unique_ptr<UdpSocket> bound_to_port(const network::TwoHosts& hosts, std::uint16_t port) {
  std::unique_ptr<UdpSocket> socket;
  hosts.as(network::Host::kSensors, [&] {
    socket = std::make_unique<UdpSocket>(UdpSocket::bound_to({kHere, port}, network::kServerInterface, 1));
  });
  return socket;
}

std::optional<Answer> received(const UdpSocket& socket, double seconds) {
  std::array<std::uint8_t, 2048> buffer;
  std::optional<Answer> answer;
  static_cast<void>(harness::eventually(seconds, [&] {
    Endpoint from;
    if (const auto datagram = socket.receive(buffer, from)) answer = Answer{{datagram->begin(), datagram->end()}};
    return answer.has_value();
  }));
  return answer;
}

}  // namespace

Finder::Finder(const network::TwoHosts& hosts) : unicast_(bound_to_port(hosts, kDiscoveryGroup.port)) {
  hosts.as(network::Host::kSensors, [&] {
    multicast_ = std::make_unique<UdpSocket>(UdpSocket::member_of(kDiscoveryGroup, network::kServerInterface));
  });
}

void Finder::find() {
  writer_.clear();
  ASSERT_TRUE(writer_.find(service::kServiceId, sd::kAnyInstance, service::kMajorVersion));
  ASSERT_TRUE(unicast_->send(kDiscoveryGroup, writer_.finish(++multicast_session_, true)));
}

void Finder::subscribe(std::uint16_t eventgroup, std::uint16_t port, std::uint32_t ttl_s) {
  writer_.clear();
  const sd::EventgroupId id{service::kServiceId, service::kDefaultInstance, service::kMajorVersion, eventgroup, 0};
  ASSERT_TRUE(writer_.subscribe(id, ttl_s, {kHere, port}));
  ASSERT_TRUE(unicast_->send(kEcuDiscovery, writer_.finish(++unicast_session_, true)));
}

void Finder::read(const UdpSocket& socket, bool by_multicast) {
  std::array<std::uint8_t, 2048> buffer;
  sd::SdMessage message;
  Endpoint from;
  while (const auto datagram = socket.receive(buffer, from)) {
    if (from.address == kHere) continue;
    someip::MessageReader reader(*datagram);
    someip::Message one;
    while (reader.next(one) == someip::ReadResult::kMessage) {
      EXPECT_EQ(message.read(one), sd::SdFault::kNone);
      for (const sd::SdEntry& entry : message.entries()) {
        EXPECT_EQ(entry.fault, sd::SdFault::kNone);
        Heard heard{entry.type, entry.service, entry.instance, entry.ttl_s, std::nullopt, by_multicast};
        Endpoint endpoint;
        const auto found =
            message.endpoint_of(entry, sd::SdMessage::Family::kIpv4, sd::SdMessage::Purpose::kUnicast, endpoint);
        if (found == sd::SdFault::kNone) heard.endpoint = endpoint;
        heard_.push_back(heard);
      }
    }
  }
}

const std::vector<Heard>& Finder::heard() {
  read(*unicast_, false);
  read(*multicast_, true);
  return heard_;
}

std::optional<Heard> Finder::wait_for(sd::EntryType type, double seconds, bool stop) {
  std::optional<Heard> found;
  static_cast<void>(harness::eventually(seconds, [&] {
    for (const Heard& one : heard()) {
      if (!found && one.type == type && (one.ttl_s == 0) == stop) found = one;
    }
    return found.has_value();
  }));
  return found;
}

Station::Station(const network::TwoHosts& hosts, std::uint16_t client, const Endpoint& ecu)
    : client_(client), ecu_(ecu), socket_(bound_to_port(hosts, 0)) {}

void Station::send(const Bytes& datagram) {
  ASSERT_TRUE(socket_->send(ecu_, datagram));
}

std::optional<Answer> Station::receive(double seconds) {
  return received(*socket_, seconds);
}

Answer Station::ask(service::Method method, const Bytes& payload) {
  const std::uint16_t session = next_session();
  const Bytes request = alignment::station::test::message(
      {.method = static_cast<std::uint16_t>(method), .client = client_, .session = session}, payload);
  for (int attempt = 0; attempt < 6; ++attempt) {
    send(request);
    while (const auto answer = receive(0.5)) {
      const bool is_mine = answer->bytes.size() >= 16 && std::equal(&request[0], &request[4], &answer->bytes[0]) &&
                           std::equal(&request[8], &request[12], &answer->bytes[8]);
      if (is_mine) return *answer;
    }
  }
  ADD_FAILURE() << "no answer to method " << static_cast<int>(method);
  return {Bytes(16 + 1024)};
}

EventPort::EventPort(const network::TwoHosts& hosts, std::uint16_t port) : socket_(bound_to_port(hosts, port)) {}

std::optional<Answer> EventPort::next(double seconds) {
  return received(*socket_, seconds);
}

}  // namespace boresight::calibration_station
