// Extraction of signals against a reference that reads one bit at a time.
#include <array>
#include <bit>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "interfaces/wire/can_signal.hpp"

namespace boresight::wire {
namespace {

/// DBC bit n of the payload.
bool bit_of(const std::vector<std::uint8_t>& payload, unsigned n) {
  return (payload[n / 8] >> (n % 8) & 1) != 0;
}

/// The bits from the least significant one up, by walking the DBC bit numbers.
std::uint64_t reference_bits(const CanSignal& signal, const std::vector<std::uint8_t>& payload) {
  std::vector<bool> from_msb;
  unsigned at = signal.start_bit;
  for (unsigned i = 0; i < signal.length; ++i) {
    from_msb.push_back(bit_of(payload, at));
    if (signal.order == ByteOrder::kIntel) {
      ++at;
    } else {
      at = at % 8 == 0 ? at + 15 : at - 1;
    }
  }
  if (signal.order == ByteOrder::kIntel) from_msb = {from_msb.rbegin(), from_msb.rend()};
  std::uint64_t value = 0;
  for (const bool bit : from_msb) value = value * 2 + (bit ? 1 : 0);
  return value;
}

bool reference_fits(const CanSignal& signal, std::size_t bytes) {
  if (signal.length == 0 || signal.length > 64) return false;
  unsigned at = signal.start_bit;
  for (unsigned i = 0; i < signal.length; ++i) {
    if (at >= bytes * 8) return false;
    at = signal.order == ByteOrder::kIntel ? at + 1 : (at % 8 == 0 ? at + 15 : at - 1);
  }
  return true;
}

TEST(Extraction, EveryPlaceAndLengthOfAFrameAgreesWithTheBitByBitReference) {
  std::mt19937 random(7);
  std::vector<std::uint8_t> payload(8);
  std::size_t checked = 0;
  for (int round = 0; round < 8; ++round) {
    for (auto& byte : payload) byte = static_cast<std::uint8_t>(random());
    for (const ByteOrder order : {ByteOrder::kMotorola, ByteOrder::kIntel}) {
      for (std::uint16_t start = 0; start < 70; ++start) {
        for (unsigned length = 0; length <= 66; ++length) {
          CanSignal signal{"S", start, static_cast<std::uint8_t>(length), order, false, 1.0, 0.0};
          ASSERT_EQ(fits(signal, payload.size()), reference_fits(signal, payload.size())) << start << "|" << length;
          if (!fits(signal, payload.size())) continue;
          const std::uint64_t expected = reference_bits(signal, payload);
          ASSERT_EQ(extract_bits(signal, payload), expected) << start << "|" << length;
          ASSERT_EQ(static_cast<std::uint64_t>(extract_raw(signal, payload)), expected);
          signal.is_signed = true;
          // Two's complement by arithmetic: a set sign bit weighs −2^(n−1).
          const bool negative = (expected >> (length - 1) & 1) != 0;
          const std::uint64_t weight = negative && length < 64 ? std::uint64_t{1} << length : 0;
          ASSERT_EQ(static_cast<std::uint64_t>(extract_raw(signal, payload)), expected - weight);
          ASSERT_EQ(extract_raw(signal, payload) < 0, negative);
          ++checked;
        }
      }
    }
  }
  EXPECT_GT(checked, 30'000u);
}

TEST(Extraction, LastBitsOfALongFrame) {
  std::vector<std::uint8_t> payload(64, 0);
  payload[63] = 0xA5;
  const CanSignal intel{"S", 504, 8, ByteOrder::kIntel, false, 2.0, 1.0};
  const CanSignal motorola{"S", 511, 8, ByteOrder::kMotorola, true, 1.0, 0.0};
  ASSERT_TRUE(fits(intel, 64));
  ASSERT_TRUE(fits(motorola, 64));
  EXPECT_FALSE(fits(intel, 63));
  EXPECT_FALSE(fits(motorola, 63));
  EXPECT_DOUBLE_EQ(extract(intel, payload), 2.0 * 0xA5 + 1.0);
  EXPECT_DOUBLE_EQ(extract(motorola, payload), 0xA5 - 256.0);
}

TEST(Extraction, UnsignedOf64BitsIsNotNegative) {
  const std::vector<std::uint8_t> payload(8, 0xFF);
  const CanSignal signal{"S", 0, 64, ByteOrder::kIntel, false, 1.0, 0.0};
  EXPECT_DOUBLE_EQ(extract(signal, payload), 18446744073709551615.0);
  const CanSignal with_sign{"S", 0, 64, ByteOrder::kIntel, true, 1.0, 0.0};
  EXPECT_DOUBLE_EQ(extract(with_sign, payload), -1.0);
}

TEST(Extraction, FloatsOfBothSizesAndOrders) {
  // 1.5f = 0x3FC00000, −2.25 = 0xC002000000000000.
  const std::vector<std::uint8_t> big32{0x3F, 0xC0, 0, 0}, little32{0, 0, 0xC0, 0x3F};
  const std::vector<std::uint8_t> big64{0xC0, 0x02, 0, 0, 0, 0, 0, 0}, little64{0, 0, 0, 0, 0, 0, 0x02, 0xC0};
  const CanSignal f32m{"S", 7, 32, ByteOrder::kMotorola, true, 2.0, 1.0, SignalKind::kFloat32};
  const CanSignal f32i{"S", 0, 32, ByteOrder::kIntel, false, 2.0, 1.0, SignalKind::kFloat32};
  const CanSignal f64m{"S", 7, 64, ByteOrder::kMotorola, true, 1.0, 0.0, SignalKind::kFloat64};
  const CanSignal f64i{"S", 0, 64, ByteOrder::kIntel, true, 1.0, 0.0, SignalKind::kFloat64};
  EXPECT_DOUBLE_EQ(extract(f32m, big32), 4.0);
  EXPECT_DOUBLE_EQ(extract(f32i, little32), 4.0);
  EXPECT_DOUBLE_EQ(extract(f64m, big64), -2.25);
  EXPECT_DOUBLE_EQ(extract(f64i, little64), -2.25);
  const std::vector<std::uint8_t> nan{0x7F, 0xC0, 0, 0};
  EXPECT_TRUE(std::isnan(extract(f32m, nan)));
}

}  // namespace
}  // namespace boresight::wire
