// Writes CAN signals bit by bit: the inverse of the decoders, implemented differently.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "interfaces/wire/can_signal.hpp"

namespace boresight::ingest {

/// Motorola: from the most significant bit down within a byte, then from bit 7 of the next byte.
inline void put_raw(std::span<std::uint8_t> payload, const wire::CanSignal& signal, std::uint64_t raw) {
  unsigned byte = signal.start_bit / 8u, bit = signal.start_bit % 8u;
  for (unsigned i = 0; i < signal.length; ++i) {
    const bool one = (raw >> (signal.length - 1u - i) & 1u) != 0;
    payload[byte] = static_cast<std::uint8_t>(one ? payload[byte] | 1u << bit : payload[byte] & ~(1u << bit));
    if (bit == 0) {
      ++byte;
      bit = 7;
    } else {
      --bit;
    }
  }
}

/// The code nearest to a physical value.
inline void put(std::span<std::uint8_t> payload, const wire::CanSignal& signal, double value) {
  put_raw(payload, signal, static_cast<std::uint64_t>(std::llround((value - signal.offset) / signal.factor)));
}

}  // namespace boresight::ingest
