// A signal in a CAN frame, as a DBC file would define it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace boresight::wire {

enum class ByteOrder : std::uint8_t { kMotorola, kIntel };

/// physical = raw · factor + offset. `start_bit` as in DBC files: Motorola signals start at their most significant
/// bit, Intel ones at their least significant; bit n is bit n % 8 of byte n / 8.
struct CanSignal {
  std::string_view name;  ///< as in the reference DBC
  std::uint8_t start_bit;
  std::uint8_t length;
  ByteOrder order;
  bool is_signed;
  double factor;
  double offset;
};

/// Whether the signal lies within a payload of that many bytes.
[[nodiscard]] constexpr bool fits(const CanSignal& signal, std::size_t bytes) {
  if (signal.length == 0 || signal.length > 63) return false;
  if (signal.order == ByteOrder::kIntel) return signal.start_bit + signal.length <= bytes * 8;
  // Motorola bits run down within a byte and on at bit 7 of the next one.
  const std::size_t position = (signal.start_bit / 8u) * 8u + (7u - signal.start_bit % 8u);
  return position + signal.length <= bytes * 8;
}

/// Raw value, sign-extended. The caller has checked fits().
[[nodiscard]] constexpr std::int64_t extract_raw(const CanSignal& signal, std::span<const std::uint8_t> payload) {
  std::uint64_t raw = 0;
  if (signal.order == ByteOrder::kIntel) {
    for (unsigned i = 0; i < signal.length; ++i) {
      const unsigned bit = signal.start_bit + i;
      raw |= static_cast<std::uint64_t>(payload[bit / 8] >> (bit % 8) & 1u) << i;
    }
  } else {
    const unsigned position = (signal.start_bit / 8u) * 8u + (7u - signal.start_bit % 8u);
    for (unsigned i = position; i < position + signal.length; ++i) {
      raw = raw << 1 | (payload[i / 8] >> (7 - i % 8) & 1u);
    }
  }
  if (signal.is_signed && (raw >> (signal.length - 1) & 1u) != 0) raw |= ~std::uint64_t{0} << signal.length;
  return static_cast<std::int64_t>(raw);
}

/// Physical value. The caller has checked fits().
[[nodiscard]] constexpr double extract(const CanSignal& signal, std::span<const std::uint8_t> payload) {
  return static_cast<double>(extract_raw(signal, payload)) * signal.factor + signal.offset;
}

}  // namespace boresight::wire
