// SOME/IP service discovery messages: what a server reads and writes (PRS_SOMEIPServiceDiscoveryProtocol, "Header
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

/// An entry as it came. Of the endpoint options it refers to, only the first usable one counts.
struct SdEntry {
  std::uint8_t type = 0;
  std::uint16_t service = 0;
  std::uint16_t instance = 0;
  std::uint8_t major = 0;
  std::uint32_t ttl_s = 0;
  std::uint32_t minor = 0;       ///< service entries
  std::uint8_t counter = 0;      ///< eventgroup entries
  std::uint16_t eventgroup = 0;  ///< eventgroup entries
  /// UDP endpoint (options 0x04, 0x06) that events can be sent to: unicast, port not 0.
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

/// Reads one whole SOME/IP message. Says what is wrong with it, nothing if it is sound. Messages of more than 64
/// entries or options are refused whole.
[[nodiscard]] std::optional<std::string_view> read_sd(std::span<const std::uint8_t> message, SdMessage& out);

/// Collects entries with their options and makes a message of them.
class SdWriter {
 public:
  struct Service {
    std::uint16_t service = 0;
    std::uint16_t instance = 0;
    std::uint8_t major = 0;
    std::uint32_t minor = 0;
  };
  /// TTL 0 takes the offer back.
  void offer(const Service& service, std::uint32_t ttl_s, const recording::Endpoint& endpoint);
  /// Answer to `subscription`; TTL 0 refuses. `group` is where the events will go, if by multicast.
  void acknowledge(const SdEntry& subscription, std::uint32_t ttl_s, const std::optional<recording::Endpoint>& group);

  [[nodiscard]] bool empty() const { return entries_.empty(); }
  /// The message; what was collected stays.
  [[nodiscard]] std::vector<std::uint8_t> finish(std::uint16_t session, bool reboot) const;

 private:
  /// Writes the option unless it is there, and returns its index.
  [[nodiscard]] std::uint8_t option(std::uint8_t type_v4, std::uint8_t type_v6, const recording::Endpoint& endpoint);

  std::vector<std::uint8_t> entries_;
  std::vector<std::vector<std::uint8_t>> options_;
};

}  // namespace boresight::someip
