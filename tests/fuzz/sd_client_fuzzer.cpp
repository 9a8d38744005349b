// A service-discovery client receives any bytes at any time. It must never request a call in the past or send more than
// allowed. It must join and leave groups in pairs, and report the begin and end of subscriptions in turn.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "services/ingest_gateway/core/sd_client.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace boresight;
using namespace boresight::ingest::someip;

constexpr std::size_t kSubscriptions = 3;

class CheckedActions : public SdActions {
 public:
  void send(std::span<const std::uint8_t> datagram, const recording::Endpoint& /*to*/) override {
    MessageReader reader(datagram);
    Message message;
    if (reader.next(message) != ReadResult::kMessage || message.session == 0) std::abort();
    if (sent_.read(message) != SdFault::kNone || sent_.entries().empty()) std::abort();
    for (const SdEntry& entry : sent_.entries()) {
      if (entry.fault != SdFault::kNone) std::abort();
      if (entry.type == EntryType::kSubscribe && entry.ttl_s != 0) ++subscribes;
    }
  }
  void subscribed(std::size_t index, const recording::Endpoint& server) override {
    if (subscribed_.at(index) || server.port == 0 || server.address.is_unspecified()) std::abort();
    subscribed_[index] = true;
  }
  void unsubscribed(std::size_t index, UnsubscribeReason /*reason*/) override {
    if (!subscribed_.at(index)) std::abort();
    subscribed_[index] = false;
  }
  void join_multicast(std::size_t index, const recording::Endpoint& group) override {
    if (joined_.at(index) || !group.address.is_multicast()) std::abort();
    joined_[index] = group;
  }
  void leave_multicast(std::size_t index, const recording::Endpoint& group) override {
    if (joined_.at(index) != group) std::abort();
    joined_[index].reset();
  }
  void fault(Fault /*fault*/, std::string_view what) override {
    if (what.empty()) std::abort();
  }
  [[nodiscard]] bool is_at_rest() const {
    return std::none_of(subscribed_.begin(), subscribed_.end(), [](bool on) { return on; }) &&
           std::none_of(joined_.begin(), joined_.end(), [](const auto& group) { return group.has_value(); });
  }
  std::size_t subscribes = 0;

 private:
  SdMessage sent_;
  std::array<bool, kSubscriptions> subscribed_{};
  std::array<std::optional<recording::Endpoint>, kSubscriptions> joined_;
};

/// Bytes after the action: length of the SD payload, then the payload. Session and header are made valid, since almost
/// every input would be rejected without this.
std::span<const std::uint8_t> sd_datagram(std::span<const std::uint8_t> payload, std::uint8_t session) {
  static std::array<std::uint8_t, kHeaderBytes + 255> bytes;
  Message header;
  header.service = kSdService;
  header.method = kSdMethod;
  header.session = session;
  header.protocol_version = header.interface_version = 1;
  write_header(header, payload.size(), std::span(bytes).first<kHeaderBytes>());
  std::copy(payload.begin(), payload.end(), bytes.begin() + kHeaderBytes);
  return std::span(bytes).first(kHeaderBytes + payload.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  CheckedActions actions;
  SdClient client({recording::IpAddress::v4(0x0A000002),
                   {recording::IpAddress::v4(0xE0000001), kSdPort},
                   {{.index = 0, .service = 0x1234, .eventgroup = 0x10, .local_port = 1},
                    {.index = 1, .service = 0x1234, .instance = 1, .major = 1, .eventgroup = 0x10, .local_port = 2},
                    {.index = 2, .service = 0x0001, .eventgroup = 0x0001, .ttl_s = kForever_s, .local_port = 3}}},
                  actions);
  std::int64_t now_ns = 1'000'000'000;
  const std::int64_t begin_ns = now_ns;
  const fuzz::NoAllocation guard;
  std::int64_t due_ns = client.start(now_ns);
  while (size >= 5) {
    const std::uint8_t action = data[0];
    now_ns += static_cast<std::int64_t>(data[1]) * 20'000'000;
    const recording::Endpoint sender{recording::IpAddress::v4(0x0A000010 + data[2] % 64), kSdPort};
    const std::uint8_t session = data[3];
    const std::size_t length = std::min<std::size_t>(data[4], size - 5);
    const std::uint8_t* const payload = data + 5;
    data += 5 + length;
    size -= 5 + length;
    if (action < 200) {
      due_ns = client.take(sd_datagram({payload, length}, session), sender, (action & 1) != 0, now_ns);
    } else if (action < 210) {
      due_ns = client.take({payload, length}, sender, true, now_ns);
    } else if (action < 230) {
      client.event_received(action % kSubscriptions, now_ns);
      continue;
    } else if (action < 240) {
      client.link_down();
      if (!actions.is_at_rest()) std::abort();
      due_ns = client.link_up(now_ns);
    } else {
      due_ns = client.tick(now_ns);
    }
    if (due_ns <= now_ns) std::abort();
  }
  const auto elapsed_s = static_cast<std::size_t>((now_ns - begin_ns) / 1'000'000'000);
  if (actions.subscribes > kSubscriptions * 10 * (elapsed_s + 1) + kSubscriptions) std::abort();
  if (client.number_of_peers() > SdClient::kSparePeers + kSubscriptions) std::abort();
  client.stop(now_ns);
  if (!actions.is_at_rest()) std::abort();
  return 0;
}
