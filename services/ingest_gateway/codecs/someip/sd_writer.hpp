// Writes a client's messages of service discovery: Find, Subscribe and StopSubscribe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "services/common/recording/ip_address.hpp"
#include "services/common/someip/message.hpp"
#include "services/ingest_gateway/codecs/someip/sd.hpp"

namespace boresight::ingest::someip {

using namespace boresight::someip;

/// The subscription of an entry.
struct EventgroupId {
  std::uint16_t service = 0;
  std::uint16_t instance = 0;
  std::uint8_t major = 0;
  std::uint16_t eventgroup = 0;
  std::uint8_t counter = 0;  ///< 0 … 15
  friend constexpr bool operator==(const EventgroupId&, const EventgroupId&) = default;
};

/// Collects the entries of one message in a fixed buffer; they keep their order. Entries with the same endpoint share
/// its option. Adding returns false, and adds nothing, when the message is full.
class SdWriter {
 public:
  static constexpr std::size_t kMaxEntries = 32;
  static constexpr std::size_t kMaxOptions = 8;

  void clear() { number_of_entries_ = number_of_options_ = 0; }
  [[nodiscard]] bool is_empty() const { return number_of_entries_ == 0; }

  /// Any minor version, valid until the next reboot.
  [[nodiscard]] bool find(std::uint16_t service, std::uint16_t instance, std::uint8_t major);
  /// `local`: destination of the events, by UDP.
  [[nodiscard]] bool subscribe(const EventgroupId& id, std::uint32_t ttl_s, const recording::Endpoint& local);
  [[nodiscard]] bool stop_subscribe(const EventgroupId& id, const recording::Endpoint& local);

  /// The message as a datagram, with the unicast flag set; valid until the next call of any function.
  [[nodiscard]] std::span<const std::uint8_t> finish(std::uint16_t session, bool reboot_flag);

 private:
  static constexpr std::size_t kEntryBytes = 16;
  static constexpr std::size_t kMaxOptionBytes = 24;
  [[nodiscard]] bool add_option(const recording::Endpoint& endpoint, std::uint8_t& index);

  std::array<std::array<std::uint8_t, kEntryBytes>, kMaxEntries> entries_{};
  std::array<recording::Endpoint, kMaxOptions> options_{};
  std::size_t number_of_entries_ = 0;
  std::size_t number_of_options_ = 0;
  std::array<std::uint8_t, kHeaderBytes + 12 + kMaxEntries * kEntryBytes + kMaxOptions * kMaxOptionBytes> datagram_{};
};

}  // namespace boresight::ingest::someip
