// The replay's service-discovery server receives any bytes at any time. Answers must be valid and no larger than an
// offer and an acknowledgement for each entry. The number of subscribers is limited, and subscriptions expire in time.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "services/common/someip/sd_server.hpp"
#include "services/replay/core/radar_service.hpp"

namespace {

using namespace boresight;
using namespace boresight::someip;

void require(bool condition) {
  if (!condition) std::abort();
}

const recording::Endpoint kGroup{recording::IpAddress::v4(0xEF425301), 30650};

SdServerConfig configuration(bool multicast) {
  SdServerConfig config;
  config.service = replay::radar_service();
  config.instances = {{1, {recording::IpAddress::v4(0x0A000001), 30601}},
                      {3, {recording::IpAddress::v4(0x0A000001), 30603}}};
  if (multicast) config.event_group = kGroup;
  config.max_subscribers = 3;
  return config;
}

void check_destinations(SdServer& server, std::int64_t now_ns, bool multicast) {
  for (std::uint16_t instance = 1; instance <= 3; ++instance) {
    for (std::uint16_t eventgroup = 1; eventgroup <= 3; ++eventgroup) {
      const auto to = server.destinations(instance, eventgroup, now_ns);
      require(to.size() <= (multicast ? 1u : 3u));
      if (instance == 2 || eventgroup == 3) require(to.empty());
      for (const recording::Endpoint& endpoint : to) {
        require(endpoint.port != 0 && !endpoint.address.is_unspecified());
        require(multicast ? endpoint == kGroup : !endpoint.address.is_multicast());
      }
    }
  }
}

}  // namespace

/// The input is a series of datagrams. Each has a kind (bit 0 multicast, bits 1…3 sender, bit 4 time passes, bit 5 the
/// SD header is added), a length, and its bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* input, std::size_t size) {
  if (size == 0) return 0;
  const bool multicast = (input[0] & 1) != 0;
  SdServer server(configuration(multicast));
  std::int64_t now_ns = 0;
  server.start(now_ns);
  std::vector<SdOutgoing> out;
  SdMessage read;
  std::uint16_t session = 0;
  std::size_t at = 1;
  while (at + 2 < size) {
    const std::uint8_t how = input[at];
    const std::size_t length = std::min<std::size_t>(input[at + 1], size - at - 2);
    const std::uint8_t* const bytes = input + at + 2;
    at += 2 + length;
    std::vector<std::uint8_t> datagram;
    if ((how & 0x20) != 0) {
      // With a valid header the fuzzer gets to the entries sooner.
      ++session;
      datagram = {0xFF,
                  0xFF,
                  0x81,
                  0,
                  0,
                  0,
                  0,
                  static_cast<std::uint8_t>(8 + length),
                  0,
                  0,
                  static_cast<std::uint8_t>(session >> 8),
                  static_cast<std::uint8_t>(session),
                  1,
                  1,
                  2,
                  0};
    }
    datagram.insert(datagram.end(), bytes, bytes + length);
    if ((how & 0x10) != 0) {
      now_ns = std::max(now_ns, std::min(server.next_due_ns(), now_ns + 10'000'000'000));
      server.tick(now_ns, out);
      require(server.next_due_ns() > now_ns);
    }
    const recording::Endpoint from{recording::IpAddress::v4(0x0A000002u + (how >> 1 & 7u)), 30490};
    out.clear();
    static_cast<void>(server.receive(now_ns, datagram, from, (how & 1) != 0, out));
    // A message without entries has 28 bytes and gets no answer.
    require(out.size() <= datagram.size() / 44);
    for (const SdOutgoing& answer : out) {
      require(answer.to == from && answer.message.size() <= 28 + 64 * 16 + 2 * (16 + 12) + 12);
      require(!read_sd(answer.message, read) && read.number_of_entries > 0);
    }
    check_destinations(server, now_ns, multicast);
  }
  // A stopped server has no subscribers.
  server.stop(out);
  for (std::uint16_t instance = 1; instance <= 3; ++instance) require(server.destinations(instance, 1, 0).empty());
  return 0;
}
