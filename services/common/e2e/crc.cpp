#include "services/common/e2e/crc.hpp"

#include <array>
#include <cstddef>

namespace boresight::e2e {

namespace {

template <typename Value>
using Table = std::array<Value, 256>;

/// Effect of one byte on a register that is shifted out at its highest bit.
template <typename Value>
constexpr Table<Value> forward_table(Value polynomial) {
  constexpr int kBits = 8 * sizeof(Value);
  Table<Value> table{};
  for (std::size_t byte = 0; byte < table.size(); ++byte) {
    auto value = static_cast<Value>(byte << (kBits - 8));
    for (int bit = 0; bit < 8; ++bit) {
      const bool leaves = (value >> (kBits - 1)) & 1u;
      value = static_cast<Value>(static_cast<Value>(value << 1) ^ (leaves ? polynomial : Value{0}));
    }
    table[byte] = value;
  }
  return table;
}

template <typename Value>
constexpr Value reversed(Value value) {
  Value result = 0;
  for (std::size_t bit = 0; bit < 8 * sizeof(Value); ++bit) {
    result = static_cast<Value>(result << 1 | (value >> bit & 1u));
  }
  return result;
}

constexpr std::size_t kSlices = 8;

/// Slicing by eight (Kounavis and Berry, 2005) for reflected registers: table k holds the effect of a byte that is
/// followed by k more bytes. Eight independent look-ups then process eight bytes, instead of a chain of eight look-ups.
template <typename Value>
constexpr std::array<Table<Value>, kSlices> reflected_slices(Value polynomial) {
  std::array<Table<Value>, kSlices> slices{};
  for (std::size_t byte = 0; byte < 256; ++byte) {
    auto value = static_cast<Value>(byte);
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ (value & 1u ? reversed(polynomial) : Value{0});
    slices[0][byte] = value;
  }
  for (std::size_t k = 1; k < kSlices; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const Value before = slices[k - 1][byte];
      slices[k][byte] = (before >> 8) ^ slices[0][before & 0xFFu];
    }
  }
  return slices;
}

constexpr auto kCrc8 = forward_table<std::uint8_t>(0x1D);
constexpr auto kCrc8H2f = forward_table<std::uint8_t>(0x2F);
constexpr auto kCrc16 = forward_table<std::uint16_t>(0x1021);
constexpr auto kCrc32P4 = reflected_slices<std::uint32_t>(0xF4ACFB13u);
constexpr auto kCrc64 = reflected_slices<std::uint64_t>(0x42F0E1EBA9EA3693u);

/// Shifts give the same result for every byte order of the machine; compilers turn them into one load.
std::uint64_t load_little_endian(const std::uint8_t* p) {
  std::uint64_t value = 0;
  for (int i = 7; i >= 0; --i) value = value << 8 | p[i];
  return value;
}

template <typename Value>
Value update_reflected(const std::array<Table<Value>, kSlices>& slices, Value state, Bytes data) {
  const std::uint8_t* p = data.data();
  std::size_t left = data.size();
  for (; left >= kSlices; left -= kSlices, p += kSlices) {
    const std::uint64_t word = load_little_endian(p) ^ state;
    state = slices[7][word & 0xFF] ^ slices[6][word >> 8 & 0xFF] ^ slices[5][word >> 16 & 0xFF] ^
            slices[4][word >> 24 & 0xFF] ^ slices[3][word >> 32 & 0xFF] ^ slices[2][word >> 40 & 0xFF] ^
            slices[1][word >> 48 & 0xFF] ^ slices[0][word >> 56];
  }
  for (; left > 0; --left, ++p) state = (state >> 8) ^ slices[0][(state ^ *p) & 0xFFu];
  return state;
}

}  // namespace

std::uint8_t update_crc8(std::uint8_t state, Bytes data) {
  for (const std::uint8_t byte : data) state = kCrc8[state ^ byte];
  return state;
}

std::uint8_t update_crc8_h2f(std::uint8_t state, Bytes data) {
  for (const std::uint8_t byte : data) state = kCrc8H2f[state ^ byte];
  return state;
}

std::uint16_t update_crc16(std::uint16_t state, Bytes data) {
  for (const std::uint8_t byte : data) state = static_cast<std::uint16_t>(state << 8 ^ kCrc16[(state >> 8) ^ byte]);
  return state;
}

std::uint32_t update_crc32_p4(std::uint32_t state, Bytes data) {
  return update_reflected(kCrc32P4, state, data);
}

std::uint64_t update_crc64(std::uint64_t state, Bytes data) {
  return update_reflected(kCrc64, state, data);
}

std::uint8_t crc8_sae_j1850(Bytes data) {
  return update_crc8(0xFF, data) ^ 0xFFu;
}

std::uint8_t crc8_h2f(Bytes data) {
  return update_crc8_h2f(0xFF, data) ^ 0xFFu;
}

std::uint16_t crc16_ccitt_false(Bytes data) {
  return update_crc16(0xFFFF, data);
}

std::uint32_t crc32_p4(Bytes data) {
  return ~update_crc32_p4(~0u, data);
}

std::uint64_t crc64_xz(Bytes data) {
  return ~update_crc64(~std::uint64_t{0}, data);
}

}  // namespace boresight::e2e
