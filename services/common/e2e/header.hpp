// Reads and writes the E2E header of a message and computes its CRC; shared by Checker and Protector.
#pragma once

#include <cstdint>
#include <span>

#include "services/common/e2e/crc.hpp"
#include "services/common/e2e/profile.hpp"

namespace boresight::e2e {

/// The fields as sent; fields that the profile does not send are 0.
struct Header {
  std::uint64_t crc = 0;
  std::uint32_t counter = 0;
  std::uint32_t length = 0;   ///< bytes of all protected data
  std::uint32_t data_id = 0;  ///< of P01 and P11 in nibble mode: bits 8 to 11 of the Data ID
};

/// True if the header lies within the data. The functions below require it.
[[nodiscard]] bool has_room(const Config& config, Bytes data);

[[nodiscard]] Header read_header(const Config& config, Bytes data);

/// Writes all fields except the CRC. The other half of a byte with a 4-bit field is not changed.
void write_fields(const Config& config, const Header& header, std::span<std::uint8_t> data);
void write_crc(const Config& config, std::uint64_t crc, std::span<std::uint8_t> data);

/// The expected CRC over all data except the CRC field; `counter` is the data's counter.
[[nodiscard]] std::uint64_t compute_crc(const Config& config, std::uint32_t counter, Bytes data);

/// The expected value of the Data ID field; 0 if the profile sends none.
[[nodiscard]] std::uint32_t sent_data_id(const Config& config);

}  // namespace boresight::e2e
