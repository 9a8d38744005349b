// Numbers and text as little-endian bytes, within bounds.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace boresight::state {

/// Appends to a buffer of fixed size. What does not fit is not written, and `fits()` turns false.
class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::uint8_t> into) : into_(into) {}
  void u8(std::uint8_t value) { put(value, 1); }
  void u16(std::uint16_t value) { put(value, 2); }
  void u32(std::uint32_t value) { put(value, 4); }
  void u64(std::uint64_t value) { put(value, 8); }
  void f32(float value) { put(std::bit_cast<std::uint32_t>(value), 4); }
  void f64(double value) { put(std::bit_cast<std::uint64_t>(value), 8); }
  void text(std::string_view value) {
    for (const char c : value) put(static_cast<std::uint8_t>(c), 1);
  }
  /// Replaces four bytes that were written before.
  void replace_u32(std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4 && at + i < size_; ++i) into_[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  [[nodiscard]] bool fits() const { return fits_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<const std::uint8_t> written() const { return into_.first(size_); }

 private:
  void put(std::uint64_t value, std::size_t count) {
    if (into_.size() - size_ < count) {
      fits_ = false;
      return;
    }
    for (std::size_t i = 0; i < count; ++i) into_[size_++] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  std::span<std::uint8_t> into_;
  std::size_t size_ = 0;
  bool fits_ = true;
};

/// Reads what ByteWriter wrote. Behind the end it reads zeros, and `fits()` turns false.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint8_t u8() { return static_cast<std::uint8_t>(get(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(get(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(get(4)); }
  std::uint64_t u64() { return get(8); }
  float f32() { return std::bit_cast<float>(static_cast<std::uint32_t>(get(4))); }
  double f64() { return std::bit_cast<double>(get(8)); }
  [[nodiscard]] bool fits() const { return fits_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::uint64_t get(std::size_t count) {
    if (left() < count) {
      fits_ = false;
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value |= static_cast<std::uint64_t>(bytes_[at_++]) << (8 * i);
    return value;
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool fits_ = true;
};

}  // namespace boresight::state
