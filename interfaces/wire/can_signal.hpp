// A signal in a CAN frame, as a DBC file would define it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace boresight::wire {

enum class ByteOrder : std::uint8_t { kMotorola, kIntel };

/// Type of the bits: an integer, or an IEEE 754 number of 32 or 64 bits.
enum class SignalKind : std::uint8_t { kInteger, kFloat32, kFloat64 };

/// physical = raw · factor + offset. `start_bit` as in DBC files: Motorola signals start at their most significant
/// bit, Intel ones at their least significant; bit n is bit n % 8 of byte n / 8.
struct CanSignal {
  std::string_view name;  ///< as in the reference DBC
  std::uint16_t start_bit;
  std::uint8_t length;
  ByteOrder order;
  bool is_signed;
  double factor;
  double offset;
  SignalKind kind = SignalKind::kInteger;
};

/// Whether the signal lies within a payload of that many bytes.
[[nodiscard]] constexpr bool fits(const CanSignal& signal, std::size_t bytes) {
  if (signal.length == 0 || signal.length > 64) return false;
  if (signal.order == ByteOrder::kIntel) return std::size_t{signal.start_bit} + signal.length <= bytes * 8;
  // Motorola bits run down within a byte and continue at bit 7 of the next byte.
  const std::size_t position = (signal.start_bit / 8u) * 8u + (7u - signal.start_bit % 8u);
  return position + signal.length <= bytes * 8;
}

/// The signal's bits, right-aligned, neither sign-extended nor scaled. The caller has checked fits().
[[nodiscard]] constexpr std::uint64_t extract_bits(const CanSignal& signal, std::span<const std::uint8_t> payload) {
  std::uint64_t bits = 0;
  std::size_t byte = signal.start_bit / 8u;
  if (signal.order == ByteOrder::kIntel) {
    unsigned low = signal.start_bit % 8u;  // lowest bit of this byte that belongs to the signal
    for (unsigned done = 0; done < signal.length; ++byte, low = 0) {
      const unsigned taken = std::min(8u - low, signal.length - done);
      bits |= static_cast<std::uint64_t>(unsigned{payload[byte]} >> low & ((1u << taken) - 1u)) << done;
      done += taken;
    }
  } else {
    unsigned available = signal.start_bit % 8u + 1u;  // bits of this byte from the signal's highest one down
    for (unsigned left = signal.length; left > 0; ++byte, available = 8) {
      const unsigned taken = std::min(available, left);
      bits = bits << taken | (unsigned{payload[byte]} >> (available - taken) & ((1u << taken) - 1u));
      left -= taken;
    }
  }
  return bits;
}

/// Raw value, sign-extended; an unsigned signal of 64 bits is returned as its two's complement. The caller has checked
/// fits().
[[nodiscard]] constexpr std::int64_t extract_raw(const CanSignal& signal, std::span<const std::uint8_t> payload) {
  std::uint64_t raw = extract_bits(signal, payload);
  if (signal.is_signed && signal.length < 64 && (raw >> (signal.length - 1u) & 1u) != 0) {
    raw |= ~std::uint64_t{0} << signal.length;
  }
  return static_cast<std::int64_t>(raw);
}

/// Physical value; may be NaN or infinite if the signal is an IEEE number. The caller has checked fits(), and that
/// IEEE numbers have 32 or 64 bits.
[[nodiscard]] constexpr double extract(const CanSignal& signal, std::span<const std::uint8_t> payload) {
  double raw = 0.0;
  if (signal.kind == SignalKind::kFloat32) {
    raw = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(extract_bits(signal, payload))));
  } else if (signal.kind == SignalKind::kFloat64) {
    raw = std::bit_cast<double>(extract_bits(signal, payload));
  } else if (signal.is_signed) {
    raw = static_cast<double>(extract_raw(signal, payload));
  } else {
    raw = static_cast<double>(extract_bits(signal, payload));
  }
  return raw * signal.factor + signal.offset;
}

}  // namespace boresight::wire
