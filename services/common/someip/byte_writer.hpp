// Big-endian bytes into memory of the caller.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace boresight::someip {

/// Writes one value after the other. A value that does not fit is not written, and overflowed() is true from then on,
/// so that the caller checks only once, at the end.
class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::uint8_t> out) : out_(out) {}

  void u8(std::uint8_t value) {
    if (size_ < out_.size()) out_[size_] = value;
    ++size_;
  }
  void u16(std::uint16_t value) {
    u8(static_cast<std::uint8_t>(value >> 8));
    u8(static_cast<std::uint8_t>(value));
  }
  void u24(std::uint32_t value) {
    u8(static_cast<std::uint8_t>(value >> 16));
    u16(static_cast<std::uint16_t>(value));
  }
  void u32(std::uint32_t value) {
    u16(static_cast<std::uint16_t>(value >> 16));
    u16(static_cast<std::uint16_t>(value));
  }
  void f32(float value) { u32(std::bit_cast<std::uint32_t>(value)); }
  void bytes(std::span<const std::uint8_t> values) {
    for (const std::uint8_t value : values) u8(value);
  }
  void zeros(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) u8(0);
  }

  /// Bytes of all values so far; more than the memory holds if overflowed().
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool overflowed() const { return size_ > out_.size(); }

 private:
  std::span<std::uint8_t> out_;
  std::size_t size_ = 0;
};

}  // namespace boresight::someip
