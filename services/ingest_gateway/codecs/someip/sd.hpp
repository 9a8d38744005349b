// SOME/IP service discovery messages, read without allocation.
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
/// Time to live of what is valid until the next reboot.
inline constexpr std::uint32_t kForever_s = 0xFFFFFF;
inline constexpr std::uint8_t kRebootFlag = 0x80;
inline constexpr std::uint8_t kUnicastFlag = 0x40;
inline constexpr std::uint8_t kUdp = 0x11;

/// A time to live of 0 turns an offer into its withdrawal, a Subscribe into its end and an Ack into a refusal.
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

/// What may be wrong with a message as a whole, or with one of its entries.
enum class SdFault : std::uint8_t {
  kNone,
  // The message is refused.
  kHeader,          ///< not an SD notification of interface version 1
  kTooShort,        ///< fewer than flags and the two lengths
  kEntriesLength,   ///< the entries reach beyond the message, or are not a multiple of 16 bytes
  kOptionsLength,   ///< the options reach beyond the message, or end before it does
  kOptionLength,    ///< an option reaches beyond the options, or lacks its reserved byte
  kTooManyEntries,  ///< more than SdMessage::kMaxEntries
  kTooManyOptions,  ///< more than SdMessage::kMaxOptions
  // The entry is refused.
  kEntryType,         ///< an unknown kind of entry
  kFirstRun,          ///< index and number of the first options run reach beyond the options
  kSecondRun,         ///< the same of the second
  kOptionContent,     ///< an option of the entry has a wrong length for its type, or its strings do not fit
  kOptionUnknown,     ///< an option of the entry is of an unknown type and may not be discarded
  kEndpointConflict,  ///< two different endpoints for the same purpose
  kEndpointAddress,   ///< a unicast endpoint that is none (0.0.0.0, multicast, broadcast, port 0), or the opposite
  kEndpointMissing,   ///< no UDP endpoint of the wanted family
};
/// What is wrong and what is allowed; "" for kNone.
[[nodiscard]] std::string_view describe(SdFault fault);

struct SdOption {
  enum class State : std::uint8_t { kSound, kUnknownType, kWrongContent };
  OptionType type{};  ///< of State::kUnknownType any value
  State state = State::kSound;
  bool discardable = false;
  std::uint8_t protocol = 0;  ///< of endpoints: 0x11 UDP, 0x06 TCP
  std::uint16_t priority = 0, weight = 0;
  recording::Endpoint endpoint;
  std::span<const std::uint8_t> content;  ///< behind the reserved byte
};

struct SdEntry {
  EntryType type{};
  SdFault fault = SdFault::kNone;  ///< not kNone: the entry is to be ignored
  std::uint16_t service = 0;
  std::uint16_t instance = 0;
  std::uint8_t major = 0;
  std::uint32_t ttl_s = 0;
  std::uint32_t minor = 0;       ///< of finds and offers
  std::uint16_t eventgroup = 0;  ///< of subscriptions
  std::uint8_t counter = 0;      ///< of subscriptions: tells equal ones apart
  std::array<std::uint8_t, 2> run_index{};
  std::array<std::uint8_t, 2> run_length{};
};

/// One message with all of its entries and options; about 6 kB. Its spans point into the datagram.
class SdMessage {
 public:
  static constexpr std::size_t kMaxEntries = 64;
  static constexpr std::size_t kMaxOptions = 64;

  /// Reads an SD message. If the result is not kNone, nothing of it is to be used. An entry can be bad on its own:
  /// see SdEntry::fault; the others are sound.
  [[nodiscard]] SdFault read(const Message& message);

  [[nodiscard]] bool reboot_flag() const { return (flags_ & kRebootFlag) != 0; }
  [[nodiscard]] bool unicast_flag() const { return (flags_ & kUnicastFlag) != 0; }
  [[nodiscard]] std::span<const SdEntry> entries() const { return std::span(entries_).first(number_of_entries_); }
  [[nodiscard]] std::span<const SdOption> options() const { return std::span(options_).first(number_of_options_); }
  /// Options of one run (0 or 1) of a sound entry.
  [[nodiscard]] std::span<const SdOption> run(const SdEntry& entry, std::size_t which) const {
    return options().subspan(entry.run_index[which], entry.run_length[which]);
  }

  enum class Family : std::uint8_t { kIpv4, kIpv6 };
  enum class Purpose : std::uint8_t { kUnicast, kMulticast };
  /// The UDP endpoint that a sound entry states; otherwise why there is none: kEndpointMissing, kEndpointConflict or
  /// kEndpointAddress. The same endpoint may be stated twice.
  [[nodiscard]] SdFault endpoint_of(const SdEntry& entry, Family family, Purpose purpose,
                                    recording::Endpoint& endpoint) const;
  /// Where the sender says that it takes SD messages, to be used instead of where the datagram came from;
  /// kEndpointMissing (the usual case) if it does not say.
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
