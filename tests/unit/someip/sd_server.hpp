// A server of service discovery for tests, and a record of the client's actions.
#pragma once

#include <algorithm>
#include <string>

#include "services/ingest_gateway/core/sd_client.hpp"
#include "tests/unit/someip/sd_bytes.hpp"

namespace boresight::ingest::someip::test {

inline constexpr std::int64_t kMillisecond = 1'000'000;
inline constexpr std::int64_t kSecond = 1'000 * kMillisecond;

/// One entry that the client sent, with the datagram's particulars.
struct SentEntry {
  EntryType type;
  std::uint16_t service, instance;
  std::uint8_t major;
  std::uint32_t ttl_s;
  std::uint16_t eventgroup;
  std::uint8_t counter;
  recording::Endpoint local, to;
  std::uint16_t session;
  bool reboot_flag;
};

class RecordedActions : public SdActions {
 public:
  void send(std::span<const std::uint8_t> datagram, const recording::Endpoint& to) override {
    ++datagrams;
    MessageReader reader(datagram);
    Message message;
    if (reader.next(message) != ReadResult::kMessage) throw std::runtime_error("the client sent no message");
    SdMessage sd;
    if (sd.read(message) != SdFault::kNone || !sd.unicast_flag()) throw std::runtime_error("the client sent no SD");
    for (const SdEntry& e : sd.entries()) {
      SentEntry s{e.type,    e.service, e.instance, e.major,         e.ttl_s,         e.eventgroup,
                  e.counter, {},        to,         message.session, sd.reboot_flag()};
      if (e.type == EntryType::kSubscribe) s.local = sd.run(e, 0)[0].endpoint;
      sent.push_back(s);
    }
  }
  void subscribed(std::size_t index, const recording::Endpoint& server) override {
    note("subscribed " + std::to_string(index) + " " + recording::to_text(server.address) + ":" +
         std::to_string(server.port));
  }
  void unsubscribed(std::size_t index, UnsubscribeReason reason) override {
    static constexpr std::array<const char*, 8> kReasons{"StopOffer", "expired", "reboot",    "changed",
                                                         "refused",   "no Ack",  "link down", "stopped"};
    note("unsubscribed " + std::to_string(index) + " " + kReasons[static_cast<std::size_t>(reason)]);
  }
  void join_multicast(std::size_t index, const recording::Endpoint& group) override {
    note("join " + std::to_string(index) + " " + recording::to_text(group.address) + ":" + std::to_string(group.port));
  }
  void leave_multicast(std::size_t index, const recording::Endpoint& group) override {
    note("leave " + std::to_string(index) + " " + recording::to_text(group.address) + ":" + std::to_string(group.port));
  }
  void fault(Fault kind, std::string_view what) override {
    ++faults;
    last_fault = kind;
    fault_texts.emplace_back(what);
  }

  /// Actions since the last call.
  [[nodiscard]] std::vector<std::string> taken() { return std::exchange(notes, {}); }
  [[nodiscard]] std::vector<SentEntry> taken_sent() { return std::exchange(sent, {}); }

  std::size_t datagrams = 0;
  std::size_t faults = 0;
  Fault last_fault{};
  std::vector<std::string> notes, fault_texts;
  std::vector<SentEntry> sent;

 private:
  void note(std::string text) { notes.push_back(std::move(text)); }
};

inline const recording::Endpoint kGroup = endpoint(0xE0F4E0F5, 30490);
inline const recording::IpAddress kLocal = recording::IpAddress::v4(0x0A000002);
inline constexpr std::uint32_t kServerAddress = 0x0A000014;

/// A server that counts its sessions correctly.
struct Server {
  std::uint32_t address = kServerAddress;
  std::uint16_t sd_port = 30490;
  std::uint16_t event_port = 30501;
  std::uint16_t multicast_session = 1, unicast_session = 1;
  std::uint8_t multicast_flags = 0xC0, unicast_flags = 0xC0;

  [[nodiscard]] recording::Endpoint sd() const { return endpoint(address, sd_port); }
  void restart() {
    multicast_session = unicast_session = 1;
    multicast_flags = unicast_flags = 0xC0;
  }
  Bytes by_multicast(std::vector<Entry> entries, std::vector<Bytes> options = {}) {
    Bytes bytes = sd_datagram({multicast_session, multicast_flags, std::move(entries), std::move(options)});
    count(multicast_session, multicast_flags);
    return bytes;
  }
  Bytes by_unicast(std::vector<Entry> entries, std::vector<Bytes> options = {}) {
    Bytes bytes = sd_datagram({unicast_session, unicast_flags, std::move(entries), std::move(options)});
    count(unicast_session, unicast_flags);
    return bytes;
  }
  /// For by_multicast: an offer with its endpoint.
  Bytes offer(std::uint32_t ttl_s = 3, std::uint16_t instance = 1, std::uint8_t major = 2) {
    return by_multicast({{.instance = instance, .major = major, .ttl_s = ttl_s, .number_1 = 1}},
                        {ipv4_option(address, event_port)});
  }
  static Entry ack_entry(std::uint32_t ttl_s = 3, std::uint16_t instance = 1, std::uint8_t counter = 0) {
    return {.type = 0x07, .instance = instance, .ttl_s = ttl_s, .last = counter * 0x10000u + 0x10};
  }
  Bytes ack(std::uint32_t ttl_s = 3, std::uint16_t instance = 1, std::uint8_t counter = 0) {
    return by_unicast({ack_entry(ttl_s, instance, counter)});
  }
  Bytes ack_multicast(std::uint32_t group, std::uint16_t port) {
    Entry entry = ack_entry();
    entry.number_1 = 1;
    return by_unicast({entry}, {ipv4_option(group, port, 0x14)});
  }

 private:
  static void count(std::uint16_t& session, std::uint8_t& flags) {
    if (session++ == 0xFFFF) {
      session = 1;
      flags = 0x40;
    }
  }
};

}  // namespace boresight::ingest::someip::test
