// Big-endian bytes at given offsets.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace boresight::simulator::wire {

inline void put_u16(std::span<std::uint8_t> bytes, std::size_t at, std::uint16_t value) {
  bytes[at] = static_cast<std::uint8_t>(value >> 8);
  bytes[at + 1] = static_cast<std::uint8_t>(value);
}
inline void put_u32(std::span<std::uint8_t> bytes, std::size_t at, std::uint32_t value) {
  put_u16(bytes, at, static_cast<std::uint16_t>(value >> 16));
  put_u16(bytes, at + 2, static_cast<std::uint16_t>(value));
}
inline void put_f32(std::span<std::uint8_t> bytes, std::size_t at, float value) {
  put_u32(bytes, at, std::bit_cast<std::uint32_t>(value));
}

/// A Motorola field of `length` bits whose most significant bit is `start_bit` (DBC numbering).
inline void put_bits(std::span<std::uint8_t> bytes, unsigned start_bit, unsigned length, std::uint32_t value) {
  unsigned bit = start_bit;
  for (unsigned i = 0; i < length; ++i) {
    const std::uint8_t mask = static_cast<std::uint8_t>(1u << (bit % 8));
    if ((value >> (length - 1 - i) & 1u) != 0) {
      bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] | mask);
    } else {
      bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] & ~mask);
    }
    bit = bit % 8 == 0 ? bit + 15 : bit - 1;
  }
}

}  // namespace boresight::simulator::wire
