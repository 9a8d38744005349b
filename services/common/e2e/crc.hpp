// The cyclic redundancy checks of AUTOSAR end-to-end protection (AUTOSAR SWS_CRCLibrary), table driven.
#pragma once

#include <cstdint>
#include <span>

namespace boresight::e2e {

using Bytes = std::span<const std::uint8_t>;

// Each update_ continues a register over more bytes, so that a message can be checked around its own CRC field. The
// register is raw: the start value is the caller's, and no final XOR is applied.
[[nodiscard]] std::uint8_t update_crc8(std::uint8_t state, Bytes data);        ///< polynomial 0x1D
[[nodiscard]] std::uint8_t update_crc8_h2f(std::uint8_t state, Bytes data);    ///< polynomial 0x2F
[[nodiscard]] std::uint16_t update_crc16(std::uint16_t state, Bytes data);     ///< polynomial 0x1021
[[nodiscard]] std::uint32_t update_crc32_p4(std::uint32_t state, Bytes data);  ///< polynomial 0xF4ACFB13, reflected
[[nodiscard]] std::uint64_t update_crc64(std::uint64_t state, Bytes data);     ///< 0x42F0E1EBA9EA3693, reflected

// Whole messages, by the names of the catalogue of parametrised CRC algorithms.
[[nodiscard]] std::uint8_t crc8_sae_j1850(Bytes data);      ///< start 0xFF, final XOR 0xFF
[[nodiscard]] std::uint8_t crc8_h2f(Bytes data);            ///< CRC-8/AUTOSAR: start 0xFF, final XOR 0xFF
[[nodiscard]] std::uint16_t crc16_ccitt_false(Bytes data);  ///< CRC-16/IBM-3740: start 0xFFFF, no final XOR
[[nodiscard]] std::uint32_t crc32_p4(Bytes data);           ///< CRC-32/AUTOSAR: start and final XOR all ones
[[nodiscard]] std::uint64_t crc64_xz(Bytes data);           ///< CRC-64/XZ: start and final XOR all ones

}  // namespace boresight::e2e
