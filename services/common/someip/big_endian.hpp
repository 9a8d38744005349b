// Big-endian numbers: most significant byte first. The caller has checked the length.
#pragma once

#include <bit>
#include <cstdint>

namespace boresight {

[[nodiscard]] constexpr std::uint16_t read_u16(const std::uint8_t* p) {
  return static_cast<std::uint16_t>(p[0] << 8 | p[1]);
}
[[nodiscard]] constexpr std::uint32_t read_u24(const std::uint8_t* p) {
  return static_cast<std::uint32_t>(p[0]) << 16 | static_cast<std::uint32_t>(p[1]) << 8 | p[2];
}
[[nodiscard]] constexpr std::uint32_t read_u32(const std::uint8_t* p) {
  return static_cast<std::uint32_t>(p[0]) << 24 | read_u24(p + 1);
}
[[nodiscard]] constexpr float read_f32(const std::uint8_t* p) {
  return std::bit_cast<float>(read_u32(p));
}
constexpr void write_u16(std::uint8_t* p, std::uint16_t value) {
  p[0] = static_cast<std::uint8_t>(value >> 8);
  p[1] = static_cast<std::uint8_t>(value);
}
constexpr void write_u24(std::uint8_t* p, std::uint32_t value) {
  p[0] = static_cast<std::uint8_t>(value >> 16);
  p[1] = static_cast<std::uint8_t>(value >> 8);
  p[2] = static_cast<std::uint8_t>(value);
}
constexpr void write_u32(std::uint8_t* p, std::uint32_t value) {
  p[0] = static_cast<std::uint8_t>(value >> 24);
  write_u24(p + 1, value);
}
constexpr void write_f32(std::uint8_t* p, float value) {
  write_u32(p, std::bit_cast<std::uint32_t>(value));
}

}  // namespace boresight
