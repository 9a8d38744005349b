// Published messages, as asserted by the public packages autosar-e2e for Python (P01 to P07) and autosar-e2e for Rust
// (P05, P11, P22); most use the default configuration of the protocol examples of AUTOSAR PRS_E2EProtocol.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/e2e/checker.hpp"
#include "services/common/e2e/protector.hpp"

namespace boresight::e2e {
namespace {

/// Bytes written as hexadecimal digits; blanks are ignored.
std::vector<std::uint8_t> bytes_of(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  std::string digits;
  for (const char c : text) {
    if (c != ' ') digits += c;
    if (digits.size() == 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(digits, nullptr, 16)));
      digits.clear();
    }
  }
  return bytes;
}

/// The messages of a sender that starts with `config` and protects zeros, one after the other.
void expect_messages(const Config& config, const std::vector<std::string>& messages) {
  ASSERT_EQ(validate(config), std::nullopt);
  Protector protector(config);
  Checker checker(config);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const std::vector<std::uint8_t> expected = bytes_of(messages[i]);
    std::vector<std::uint8_t> data(expected.size(), 0);
    ASSERT_TRUE(protector.protect(data));
    EXPECT_EQ(data, expected) << "message " << i;
    EXPECT_EQ(checker.check(expected), i == 0 ? Status::kInitial : Status::kOk) << "message " << i;
  }
}

Config with_id(Profile profile, std::uint32_t id, std::uint32_t offset_bytes = 0) {
  Config config;
  config.profile = profile;
  config.data_id = id;
  config.offset_bytes = offset_bytes;
  return config;
}

Config with_mode(Profile profile, DataIdMode mode, std::uint32_t id = 0x123, std::uint32_t offset_bytes = 0) {
  Config config = with_id(profile, id, offset_bytes);
  config.data_id_mode = mode;
  return config;
}

/// The list 1, 2, … 16 of the protocol's example of profile 22.
Config with_list(Profile profile, std::uint32_t offset_bytes = 0) {
  Config config = with_id(profile, 0, offset_bytes);
  for (std::size_t i = 0; i < 16; ++i) config.data_id_list[i] = static_cast<std::uint8_t>(i + 1);
  return config;
}

TEST(Vectors, Profile1InEveryMode) {
  expect_messages(with_mode(Profile::kP01, DataIdMode::kBoth), {"cc00 0000 0000 0000", "9101 0000 0000 0000"});
  expect_messages(with_mode(Profile::kP01, DataIdMode::kAlternating), {"ce00 0000 0000 0000", "0201 0000 0000 0000"});
  expect_messages(with_mode(Profile::kP01, DataIdMode::kLow), {"ce00 0000 0000 0000", "9301 0000 0000 0000"});
  expect_messages(with_mode(Profile::kP01, DataIdMode::kNibble), {"2a10 0000 0000 0000", "7711 0000 0000 0000"});
}

TEST(Vectors, Profile2) {
  Config zeros = with_id(Profile::kP02, 0);
  expect_messages(zeros, {"4501 0000 0000 0000"});

  // Payload 02 03 … 07, list 0, 1, … 15: the messages of counters 1 and 2.
  Config counting = zeros;
  for (std::size_t i = 0; i < 16; ++i) counting.data_id_list[i] = static_cast<std::uint8_t>(i);
  Protector protector(counting);
  for (const char* expected : {"6101 0203 0405 0607", "bc02 0203 0405 0607"}) {
    std::vector<std::uint8_t> data = bytes_of("0000 0203 0405 0607");
    ASSERT_TRUE(protector.protect(data));
    EXPECT_EQ(data, bytes_of(expected));
  }
}

TEST(Vectors, Profile4) {
  expect_messages(with_id(Profile::kP04, 0x0A0B0C0D),
                  {"0010 0000 0a0b0c0d 862b0556 00000000", "0010 0001 0a0b0c0d a58e6807 00000000"});
  expect_messages(with_id(Profile::kP04, 0x0A0B0C0D, 8), {"00000000 00000000 0018 0000 0a0b0c0d 69d7502e 00000000",
                                                          "00000000 00000000 0018 0001 0a0b0c0d 4a723d7f 00000000"});
}

TEST(Vectors, Profile5) {
  expect_messages(with_id(Profile::kP05, 0x1234), {"1cca 00 0000000000", "cf8d 01 0000000000"});
  expect_messages(with_id(Profile::kP05, 0x1234, 8),
                  {"00000000 00000000 2891 00 0000000000", "00000000 00000000 fbd6 01 0000000000"});
}

TEST(Vectors, Profile6) {
  expect_messages(with_id(Profile::kP06, 0x1234), {"b155 0008 00 000000", "f4f5 0008 01 000000"});
  expect_messages(with_id(Profile::kP06, 0x1234, 8),
                  {"00000000 00000000 4eb7 0010 00 000000", "00000000 00000000 0b17 0010 01 000000"});
}

TEST(Vectors, Profile7) {
  expect_messages(with_id(Profile::kP07, 0x0A0B0C0D), {"1fb2e737fcedbcd9 00000018 00000000 0a0b0c0d 00000000",
                                                       "7bde7268b8e9bc27 00000018 00000001 0a0b0c0d 00000000"});
  expect_messages(with_id(Profile::kP07, 0x0A0B0C0D, 8),
                  {"0000000000000000 17f7c817323865a8 00000020 00000000 0a0b0c0d 00000000",
                   "0000000000000000 739b5d48763c6556 00000020 00000001 0a0b0c0d 00000000"});
}

TEST(Vectors, Profile11) {
  expect_messages(with_mode(Profile::kP11, DataIdMode::kBoth), {"cc00 0000 0000 0000", "9101 0000 0000 0000"});
  expect_messages(with_mode(Profile::kP11, DataIdMode::kNibble), {"2a10 0000 0000 0000", "7711 0000 0000 0000"});
  expect_messages(with_mode(Profile::kP11, DataIdMode::kNibble, 0x123, 8), {"0000 0000 0000 0000 7d10 0000 0000 0000"});
}

TEST(Vectors, Profile22ThroughAllCounters) {
  expect_messages(with_list(Profile::kP22),
                  {"1b01 0000 0000 0000", "9802 0000 0000 0000", "3103 0000 0000 0000", "0d04 0000 0000 0000",
                   "1805 0000 0000 0000", "9b06 0000 0000 0000", "6507 0000 0000 0000", "0808 0000 0000 0000",
                   "1d09 0000 0000 0000", "9e0a 0000 0000 0000", "370b 0000 0000 0000", "0b0c 0000 0000 0000",
                   "1e0d 0000 0000 0000", "9d0e 0000 0000 0000", "cd0f 0000 0000 0000", "0e00 0000 0000 0000"});
  expect_messages(with_list(Profile::kP22, 8), {"0000 0000 0000 0000 1401 0000 0000 0000"});
}

}  // namespace
}  // namespace boresight::e2e
