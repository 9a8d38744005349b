// SOME/IP service discovery messages that a server reads and writes (PRS_SOMEIPServiceDiscoveryProtocol, "Header
// format", "Entries", "Options").
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "services/common/recording/ip_address.hpp"

namespace boresight::someip {

enum class SdEntryType : std::uint8_t {
  kFindService = 0x00,
  kOfferService = 0x01,
  kSubscribeEventgroup = 0x06,
  kSubscribeEventgroupAck = 0x07,
};

/// A received entry. Only the first usable one of its endpoint options counts.
struct SdEntry {
  std::uint8_t type = 0;
  std::uint16_t service = 0;
  std::uint16_t instance = 0;
  std::uint8_t major = 0;
  std::uint32_t ttl_s = 0;
  std::uint32_t minor = 0;       ///< service entries
  std::uint8_t counter = 0;      ///< eventgroup entries
  std::uint16_t eventgroup = 0;  ///< eventgroup entries
  /// UDP endpoint (options 0x04, 0x06) for events: unicast, port not 0.
  std::optional<recording::Endpoint> endpoint;
};

struct SdMessage {
  static constexpr std::size_t kMaxEntries = 64;
  static constexpr std::size_t kMaxOptions = 64;

  bool reboot = false;
  std::uint16_t session = 0;
  std::array<SdEntry, kMaxEntries> entries{};
  std::size_t number_of_entries = 0;
};

/// Reads one complete SOME/IP message. Returns its fault, or nothing if it is valid. Messages with more than 64 entries
/// or options are rejected.
[[nodiscard]] std::optional<std::string_view> read_sd(std::span<const std::uint8_t> message, SdMessage& out);

/// Collects entries with their options and writes them as a message.
class SdWriter {
 public:
  struct Service {
    std::uint16_t service = 0;
    std::uint16_t instance = 0;
    std::uint8_t major = 0;
    std::uint32_t minor = 0;
  };
  /// TTL 0 withdraws the offer.
  void offer(const Service& service, std::uint32_t ttl_s, const recording::Endpoint& endpoint);
  /// Answer to `subscription`; TTL 0 refuses. `group` is the destination of events sent by multicast.
  void acknowledge(const SdEntry& subscription, std::uint32_t ttl_s, const std::optional<recording::Endpoint>& group);

  [[nodiscard]] bool empty() const { return entries_.empty(); }
  /// The message; keeps the collected entries.
  [[nodiscard]] std::vector<std::uint8_t> finish(std::uint16_t session, bool reboot) const;

 private:
  /// Writes the option if it is new, and returns its index.
  [[nodiscard]] std::uint8_t option(std::uint8_t type_v4, std::uint8_t type_v6, const recording::Endpoint& endpoint);

  std::vector<std::uint8_t> entries_;
  std::vector<std::vector<std::uint8_t>> options_;
};

}  // namespace boresight::someip
