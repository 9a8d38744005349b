// Reading, writing and summing up the E2E header of a message; shared by Checker and Protector.
#pragma once

#include <cstdint>
#include <span>

#include "services/common/e2e/crc.hpp"
#include "services/common/e2e/profile.hpp"

namespace boresight::e2e {

/// The fields as sent; those that the profile does not send are 0.
struct Header {
  std::uint64_t crc = 0;
  std::uint32_t counter = 0;
  std::uint32_t length = 0;   ///< bytes of the whole protected data
  std::uint32_t data_id = 0;  ///< of P01 and P11 in nibble mode: bits 8 to 11 of the Data ID
};

/// True if the header lies within the data. The functions below require it.
[[nodiscard]] bool has_room(const Config& config, Bytes data);

[[nodiscard]] Header read_header(const Config& config, Bytes data);

/// Writes all fields but the CRC; what shares a byte with a nibble stays as it is.
void write_fields(const Config& config, const Header& header, std::span<std::uint8_t> data);
void write_crc(const Config& config, std::uint64_t crc, std::span<std::uint8_t> data);

/// The CRC that the data should carry, over everything but the CRC field; `counter` is the one that the data carry.
[[nodiscard]] std::uint64_t compute_crc(const Config& config, std::uint32_t counter, Bytes data);

/// What the Data ID field should hold; 0 if the profile sends none.
[[nodiscard]] std::uint32_t sent_data_id(const Config& config);

}  // namespace boresight::e2e
