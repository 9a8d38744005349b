// End-to-end (E2E) protection profiles 1, 2, 4, 5, 6, 7, 11 and 22 of AUTOSAR (PRS_E2EProtocol): configuration,
// results of a check, and layout of each profile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace boresight::e2e {

enum class Profile : std::uint8_t { kNone, kP01, kP02, kP04, kP05, kP06, kP07, kP11, kP22 };

/// Which part of the 16-bit Data ID the CRC of P01 and P11 covers; P11 has kBoth and kNibble only.
enum class DataIdMode : std::uint8_t {
  kBoth,         ///< both bytes
  kAlternating,  ///< low byte at even counters, high byte at odd ones
  kLow,          ///< low byte
  kNibble        ///< low byte; the low nibble of the high byte is sent beside the counter
};

struct Config {
  Profile profile = Profile::kNone;
  std::uint32_t data_id = 0;                    ///< P01, P04, P05, P06, P07, P11
  std::array<std::uint8_t, 16> data_id_list{};  ///< P02, P22: one for each counter
  DataIdMode data_id_mode = DataIdMode::kBoth;  ///< P01, P11
  std::uint32_t offset_bytes = 0;               ///< of the E2E header in the protected data
  std::uint32_t max_delta_counter = 1;          ///< largest step of the counter that is still acceptable
};

/// Result of the check of one message. The order is length, CRC, Data ID, counter, because each of these can only be
/// trusted if the previous ones are correct.
enum class Status : std::uint8_t {
  kInitial,        ///< correct, and the first message: no counter to compare with
  kOk,             ///< correct, counter increased by one
  kOkSomeLost,     ///< correct, counter increased by more than one, within max_delta_counter
  kRepeated,       ///< correct, but with the same counter
  kWrongSequence,  ///< correct, but the counter jumped by more than max_delta_counter, or has an invalid value
  kWrongCrc,
  kWrongLength,  ///< too short for the header, or different from its length field
  kWrongDataId   ///< CRC right, but meant for another receiver
};

/// True where the content may be used: kInitial, kOk, kOkSomeLost.
[[nodiscard]] constexpr bool is_acceptable(Status status) {
  return status == Status::kInitial || status == Status::kOk || status == Status::kOkSomeLost;
}

/// As text for logs: "wrong CRC".
[[nodiscard]] std::string_view describe(Status status);

/// Offsets of a profile's fields in bytes from the start of its header. A width of 0 is a field that is not sent,
/// except for the counter, which is then the low nibble of its byte.
struct Layout {
  std::uint8_t header_bytes = 0;
  std::uint8_t crc_at = 0, crc_bytes = 0;
  std::uint8_t counter_at = 0, counter_bytes = 0;
  std::uint8_t length_at = 0, length_bytes = 0;
  std::uint8_t data_id_at = 0, data_id_bytes = 0;
  std::uint64_t counter_values = 1;  ///< the counter wraps to 0 after this many
  std::uint32_t first_counter = 0;   ///< of a sender that has just started
};

/// PRS_E2EProtocol, "Header layout" of each profile. All fields are big endian except the CRC of P05. P02 and P22
/// increase the counter before protection, so that a sender's first counter is 1. The recommended maximum length of the
/// protected data is 30 to 32 bytes for the 8-bit CRCs (P01, P02, P11), 4 KB for P04 to P06, 4 MB for P07. It is not
/// enforced, because sensors exceed it; error detection is weaker for longer data.
[[nodiscard]] constexpr Layout layout(Profile profile) {
  constexpr std::uint64_t kWide = std::uint64_t{1} << 32;
  switch (profile) {
    case Profile::kNone:
      break;
    case Profile::kP01:
    case Profile::kP11:
      return {.header_bytes = 2, .crc_bytes = 1, .counter_at = 1, .counter_values = 15};
    case Profile::kP02:
    case Profile::kP22:
      return {.header_bytes = 2, .crc_bytes = 1, .counter_at = 1, .counter_values = 16, .first_counter = 1};
    case Profile::kP04:
      return {.header_bytes = 12,
              .crc_at = 8,
              .crc_bytes = 4,
              .counter_at = 2,
              .counter_bytes = 2,
              .length_at = 0,
              .length_bytes = 2,
              .data_id_at = 4,
              .data_id_bytes = 4,
              .counter_values = 1u << 16};
    case Profile::kP05:
      return {.header_bytes = 3, .crc_bytes = 2, .counter_at = 2, .counter_bytes = 1, .counter_values = 256};
    case Profile::kP06:
      return {.header_bytes = 5,
              .crc_bytes = 2,
              .counter_at = 4,
              .counter_bytes = 1,
              .length_at = 2,
              .length_bytes = 2,
              .counter_values = 256};
    case Profile::kP07:
      return {.header_bytes = 20,
              .crc_bytes = 8,
              .counter_at = 12,
              .counter_bytes = 4,
              .length_at = 8,
              .length_bytes = 4,
              .data_id_at = 16,
              .data_id_bytes = 4,
              .counter_values = kWide};
  }
  return {};
}

/// Bytes of the profile's header; 0 for kNone.
[[nodiscard]] constexpr std::size_t header_bytes(Profile profile) {
  return layout(profile).header_bytes;
}

/// The greatest offset_bytes: the longest message of the profiles with a 16-bit length field (PRS_E2EProtocol).
inline constexpr std::uint32_t kMaxOffsetBytes = 4096;

/// The error of a configuration with field and allowed range; nothing if it is valid. With an invalid one, Checker and
/// Protector stay within bounds, but their results have no meaning.
[[nodiscard]] std::optional<std::string> validate(const Config& config);

}  // namespace boresight::e2e
