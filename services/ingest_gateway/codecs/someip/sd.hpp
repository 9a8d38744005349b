// Reads SOME/IP service discovery messages without allocation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "services/common/recording/ip_address.hpp"
#include "services/common/someip/message.hpp"

namespace boresight::ingest::someip {

using namespace boresight::someip;
using boresight::someip::describe;

inline constexpr std::uint16_t kSdService = 0xFFFF;
inline constexpr std::uint16_t kSdMethod = 0x8100;
inline constexpr std::uint16_t kSdPort = 30490;
inline constexpr std::uint16_t kAnyInstance = 0xFFFF;
inline constexpr std::uint8_t kAnyMajor = 0xFF;
inline constexpr std::uint32_t kAnyMinor = 0xFFFFFFFF;
/// Time to live of entries that are valid until the next reboot.
inline constexpr std::uint32_t kForever_s = 0xFFFFFF;
inline constexpr std::uint8_t kRebootFlag = 0x80;
inline constexpr std::uint8_t kUnicastFlag = 0x40;
inline constexpr std::uint8_t kUdp = 0x11;

/// With a time to live of 0, an offer is its withdrawal, a Subscribe is its end, and an Ack is a refusal.
enum class EntryType : std::uint8_t { kFind = 0x00, kOffer = 0x01, kSubscribe = 0x06, kSubscribeAck = 0x07 };

enum class OptionType : std::uint8_t {
  kConfiguration = 0x01,
  kLoadBalancing = 0x02,
  kIpv4Endpoint = 0x04,
  kIpv6Endpoint = 0x06,
  kIpv4Multicast = 0x14,
  kIpv6Multicast = 0x16,
  kIpv4SdEndpoint = 0x24,
  kIpv6SdEndpoint = 0x26,
};

/// Faults of a message, or of one of its entries.
enum class SdFault : std::uint8_t {
  kNone,
  // The message is rejected.
  kHeader,          ///< not an SD notification of interface version 1
  kTooShort,        ///< fewer than flags and the two lengths
  kEntriesLength,   ///< the entries reach beyond the message, or are not a multiple of 16 bytes
  kOptionsLength,   ///< the options reach beyond the message, or end before its end
  kOptionLength,    ///< an option reaches beyond the options, or lacks its reserved byte
  kTooManyEntries,  ///< more than SdMessage::kMaxEntries
  kTooManyOptions,  ///< more than SdMessage::kMaxOptions
  // The entry is rejected.
  kEntryType,         ///< an unknown kind of entry
  kFirstRun,          ///< index and number of the first options run reach beyond the options
  kSecondRun,         ///< the same for the second run
  kOptionContent,     ///< an option of the entry has a wrong length for its type, or its strings do not fit
  kOptionUnknown,     ///< an option of the entry is of an unknown type and may not be discarded
  kEndpointConflict,  ///< two different endpoints for the same purpose
  kEndpointAddress,   ///< no unicast address (0.0.0.0, multicast, broadcast, port 0), or no multicast address
  kEndpointMissing,   ///< no UDP endpoint of the required family
};
/// Description with the allowed value; "" for kNone.
[[nodiscard]] std::string_view describe(SdFault fault);

struct SdOption {
  enum class State : std::uint8_t { kSound, kUnknownType, kWrongContent };
  OptionType type{};  ///< any value with State::kUnknownType
  State state = State::kSound;
  bool discardable = false;
  std::uint8_t protocol = 0;  ///< of endpoints: 0x11 UDP, 0x06 TCP
  std::uint16_t priority = 0, weight = 0;
  recording::Endpoint endpoint;
  std::span<const std::uint8_t> content;  ///< after the reserved byte
};

struct SdEntry {
  EntryType type{};
  SdFault fault = SdFault::kNone;  ///< if not kNone: ignore the entry
  std::uint16_t service = 0;
  std::uint16_t instance = 0;
  std::uint8_t major = 0;
  std::uint32_t ttl_s = 0;
  std::uint32_t minor = 0;       ///< of finds and offers
  std::uint16_t eventgroup = 0;  ///< of subscriptions
  std::uint8_t counter = 0;      ///< of subscriptions: distinguishes equal ones
  std::array<std::uint8_t, 2> run_index{};
  std::array<std::uint8_t, 2> run_length{};
};

/// One message with all its entries and options; about 6 kB. Its spans point into the datagram.
class SdMessage {
 public:
  static constexpr std::size_t kMaxEntries = 64;
  static constexpr std::size_t kMaxOptions = 64;

  /// Reads an SD message. If the result is not kNone, the message must not be used. A single entry may be invalid, see
  /// SdEntry::fault; the others are then valid.
  [[nodiscard]] SdFault read(const Message& message);

  [[nodiscard]] bool reboot_flag() const { return (flags_ & kRebootFlag) != 0; }
  [[nodiscard]] bool unicast_flag() const { return (flags_ & kUnicastFlag) != 0; }
  [[nodiscard]] std::span<const SdEntry> entries() const { return std::span(entries_).first(number_of_entries_); }
  [[nodiscard]] std::span<const SdOption> options() const { return std::span(options_).first(number_of_options_); }
  /// Options of one run (0 or 1) of a valid entry.
  [[nodiscard]] std::span<const SdOption> run(const SdEntry& entry, std::size_t which) const {
    return options().subspan(entry.run_index[which], entry.run_length[which]);
  }

  enum class Family : std::uint8_t { kIpv4, kIpv6 };
  enum class Purpose : std::uint8_t { kUnicast, kMulticast };
  /// The UDP endpoint of a valid entry; otherwise the reason: kEndpointMissing, kEndpointConflict or kEndpointAddress.
  /// The same endpoint may be stated twice.
  [[nodiscard]] SdFault endpoint_of(const SdEntry& entry, Family family, Purpose purpose,
                                    recording::Endpoint& endpoint) const;
  /// The sender's stated endpoint for SD messages, which replaces the source of the datagram; kEndpointMissing (the
  /// usual case) if not stated.
  [[nodiscard]] SdFault sd_endpoint(Family family, recording::Endpoint& endpoint) const;

 private:
  [[nodiscard]] SdFault read_options(std::span<const std::uint8_t> bytes);
  void read_entry(const std::uint8_t* bytes, SdEntry& entry) const;
  [[nodiscard]] SdFault judge_runs(const SdEntry& entry) const;

  std::uint8_t flags_ = 0;
  std::size_t number_of_entries_ = 0;
  std::size_t number_of_options_ = 0;
  std::array<SdEntry, kMaxEntries> entries_;
  std::array<SdOption, kMaxOptions> options_;
};

}  // namespace boresight::ingest::someip
