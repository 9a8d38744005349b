// Each CRC against its check value in the catalogue of parametrised CRC algorithms, against the examples of AUTOSAR
// SWS_CRCLibrary (as listed by the public package autosar-e2e), and against a bit-by-bit division.
#include "services/common/e2e/crc.hpp"

#include <gtest/gtest.h>

#include "tests/unit/e2e/support.hpp"

namespace boresight::e2e {
namespace {

using Message = std::vector<std::uint8_t>;

const Message kDigits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};

TEST(Crc, CatalogueCheckValues) {
  EXPECT_EQ(crc8_sae_j1850(kDigits), 0x4B);           // CRC-8/SAE-J1850
  EXPECT_EQ(update_crc8(0, kDigits), 0x37);           // CRC-8/GSM-A, the form of P01 and P11
  EXPECT_EQ(crc8_h2f(kDigits), 0xDF);                 // CRC-8/AUTOSAR
  EXPECT_EQ(crc16_ccitt_false(kDigits), 0x29B1);      // CRC-16/IBM-3740
  EXPECT_EQ(crc32_p4(kDigits), 0x1697D06Au);          // CRC-32/AUTOSAR
  EXPECT_EQ(crc64_xz(kDigits), 0x995DC9BBDF1939FAu);  // CRC-64/XZ
}

TEST(Crc, ExamplesOfTheCrcLibrary) {
  struct Example {
    Message data;
    std::uint8_t crc8, crc8_h2f;
    std::uint16_t crc16;
    std::uint32_t crc32_p4;
    std::uint64_t crc64;
  };
  const std::vector<Example> examples{
      {{0x00, 0x00, 0x00, 0x00}, 0x59, 0x12, 0x84C0, 0x6FB32240, 0xF4A586351E1B9F4B},
      {{0xF2, 0x01, 0x83}, 0x37, 0xC2, 0xD374, 0x4F721A25, 0x319C27668164F1C6},
      {{0x0F, 0xAA, 0x00, 0x55}, 0x79, 0xC6, 0x2023, 0x20662DF8, 0x54C5D0F7667C1575},
      {{0x00, 0xFF, 0x55, 0x11}, 0xB8, 0x77, 0xB8F9, 0x9BD7996E, 0xA63822BE7E0704E6},
      {{0x33, 0x22, 0x55, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF}, 0xCB, 0x11, 0xF53F, 0xA65A343D, 0x701ECEB219A8E5D5},
      {{0x92, 0x6B, 0x55}, 0x8C, 0x33, 0x0745, 0xEE688A78, 0x5FAA96A9B59F3E4E},
      {{0xFF, 0xFF, 0xFF, 0xFF}, 0x74, 0x6C, 0x1D0F, 0xFFFFFFFF, 0xFFFFFFFF00000000},
  };
  for (const Example& example : examples) {
    EXPECT_EQ(crc8_sae_j1850(example.data), example.crc8);
    EXPECT_EQ(crc8_h2f(example.data), example.crc8_h2f);
    EXPECT_EQ(crc16_ccitt_false(example.data), example.crc16);
    EXPECT_EQ(crc32_p4(example.data), example.crc32_p4);
    EXPECT_EQ(crc64_xz(example.data), example.crc64);
  }
}

/// Division bit by bit, highest bit of each byte first.
std::uint64_t divide_forward(std::uint64_t state, std::uint64_t polynomial, int bits, const Message& data) {
  const std::uint64_t top = std::uint64_t{1} << (bits - 1);
  for (const std::uint8_t byte : data) {
    for (int bit = 7; bit >= 0; --bit) {
      const bool leaves = ((state & top) != 0) != ((byte >> bit & 1) != 0);
      state = (state << 1 ^ (leaves ? polynomial : 0)) & (top | (top - 1));
    }
  }
  return state;
}

/// Division bit by bit, lowest bit of each byte first; the polynomial is given reflected.
std::uint64_t divide_reflected(std::uint64_t state, std::uint64_t polynomial, const Message& data) {
  for (const std::uint8_t byte : data) {
    state ^= byte;
    for (int bit = 0; bit < 8; ++bit) state = state >> 1 ^ ((state & 1) != 0 ? polynomial : 0);
  }
  return state;
}

TEST(Crc, TablesAgreeWithDivisionAtEveryLength) {
  for (std::size_t size = 0; size <= 100; ++size) {
    const Message data = test::random_bytes(size, static_cast<std::uint32_t>(size));
    EXPECT_EQ(update_crc8(0xFF, data), divide_forward(0xFF, 0x1D, 8, data)) << size;
    EXPECT_EQ(update_crc8_h2f(0xFF, data), divide_forward(0xFF, 0x2F, 8, data)) << size;
    EXPECT_EQ(update_crc16(0xFFFF, data), divide_forward(0xFFFF, 0x1021, 16, data)) << size;
    EXPECT_EQ(update_crc32_p4(0xFFFFFFFF, data), divide_reflected(0xFFFFFFFF, 0xC8DF352F, data)) << size;
    EXPECT_EQ(update_crc64(~0ull, data), divide_reflected(~0ull, 0xC96C5795D7870F42, data)) << size;
  }
}

TEST(Crc, ContinuesOverPartsAtAnyAlignment) {
  const Message data = test::random_bytes(67, 1);
  const Bytes whole{data};
  for (std::size_t cut = 0; cut <= data.size(); ++cut) {
    const Bytes before = whole.first(cut), after = whole.subspan(cut);
    EXPECT_EQ(update_crc8(update_crc8(3, before), after), update_crc8(3, whole)) << cut;
    EXPECT_EQ(update_crc8_h2f(update_crc8_h2f(3, before), after), update_crc8_h2f(3, whole)) << cut;
    EXPECT_EQ(update_crc16(update_crc16(3, before), after), update_crc16(3, whole)) << cut;
    EXPECT_EQ(update_crc32_p4(update_crc32_p4(3, before), after), update_crc32_p4(3, whole)) << cut;
    EXPECT_EQ(update_crc64(update_crc64(3, before), after), update_crc64(3, whole)) << cut;
  }
}

}  // namespace
}  // namespace boresight::e2e
