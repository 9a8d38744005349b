// Protected data are accepted, corrupted data are rejected: all profiles, lengths and offsets.
#include <algorithm>

#include <gtest/gtest.h>

#include "services/common/e2e/checker.hpp"
#include "services/common/e2e/crc.hpp"
#include "services/common/e2e/protector.hpp"
#include "tests/unit/e2e/support.hpp"

namespace boresight::e2e {
namespace {

using test::all_configs;
using test::Named;
using test::random_bytes;

TEST(Protection, RoundTripOfEveryProfileLengthAndOffset) {
  for (const std::uint32_t offset : {0u, 1u, 8u, 13u}) {
    for (const Named& named : all_configs(offset)) {
      const std::size_t least = offset + header_bytes(named.config.profile);
      Protector protector(named.config);
      Checker checker(named.config);
      bool first = true;
      for (const std::size_t extra : {0u, 1u, 2u, 5u, 6u, 7u, 8u, 9u, 16u, 64u, 255u, 1400u, 4096u, 35336u}) {
        std::vector<std::uint8_t> data = random_bytes(least + extra, static_cast<std::uint32_t>(extra));
        const std::vector<std::uint8_t> plain = data;
        ASSERT_TRUE(protector.protect(data)) << named.name << ", " << extra;
        EXPECT_EQ(checker.check(data), first ? Status::kInitial : Status::kOk) << named.name << ", " << extra;
        EXPECT_TRUE(std::equal(plain.begin(), plain.begin() + offset, data.begin())) << named.name;
        EXPECT_TRUE(std::equal(plain.begin() + static_cast<std::ptrdiff_t>(least), plain.end(),
                               data.begin() + static_cast<std::ptrdiff_t>(least)))
            << named.name << ": payload changed";
        first = false;
      }
    }
  }
}

TEST(Protection, PayloadBesideTheCounterNibbleStays) {
  for (const Named& named : all_configs(2)) {
    const bool nibble_counter = layout(named.config.profile).counter_bytes == 0;
    const bool own_nibble = named.config.data_id_mode != DataIdMode::kNibble;
    if (!nibble_counter || !own_nibble) continue;
    std::vector<std::uint8_t> data(8, 0xB7);
    ASSERT_TRUE(Protector(named.config).protect(data));
    EXPECT_EQ(data[3] & 0xF0, 0xB0) << named.name;
  }
}

TEST(Protection, EverySingleBitFlipIsDetected) {
  for (const std::uint32_t offset : {0u, 8u}) {
    for (const Named& named : all_configs(offset)) {
      const std::size_t least = offset + header_bytes(named.config.profile);
      for (const std::size_t size : {least, least + 1, least + 6, least + 22}) {
        std::vector<std::uint8_t> data = random_bytes(size, static_cast<std::uint32_t>(size));
        Protector protector(named.config);
        for (int message = 0; message < 16; ++message) {
          ASSERT_TRUE(protector.protect(data));
          for (std::size_t bit = 0; bit < 8 * size; ++bit) {
            const auto mask = static_cast<std::uint8_t>(1u << bit % 8);
            data[bit / 8] ^= mask;
            EXPECT_FALSE(is_acceptable(Checker(named.config).check(data)))
                << named.name << ", " << size << " bytes, message " << message << ", bit " << bit;
            data[bit / 8] ^= mask;
          }
        }
      }
    }
  }
}

TEST(Protection, EveryBitFlipOfALongDetectionListIsDetected) {
  Config config;
  config.profile = Profile::kP07;
  config.data_id = 336;
  config.offset_bytes = 8;
  std::vector<std::uint8_t> data = random_bytes(2000, 7);
  ASSERT_TRUE(Protector(config).protect(data));
  for (std::size_t bit = 0; bit < 8 * data.size(); ++bit) {
    const auto mask = static_cast<std::uint8_t>(1u << bit % 8);
    data[bit / 8] ^= mask;
    ASSERT_FALSE(is_acceptable(Checker(config).check(data))) << bit;
    data[bit / 8] ^= mask;
  }
}

TEST(Protection, TruncatedAndPaddedDataAreRejected) {
  for (const Named& named : all_configs(4)) {
    const std::size_t least = 4 + header_bytes(named.config.profile);
    std::vector<std::uint8_t> data = random_bytes(least + 20, 3);
    ASSERT_TRUE(Protector(named.config).protect(data));
    const bool has_length = layout(named.config.profile).length_bytes > 0;
    for (std::size_t size = 0; size < data.size(); ++size) {
      const Status status = Checker(named.config).check(Bytes{data}.first(size));
      if (size < least || has_length) {
        EXPECT_EQ(status, Status::kWrongLength) << named.name << ", " << size;
      }
    }
    data.push_back(0);
    const Status padded = Checker(named.config).check(data);
    EXPECT_EQ(padded, has_length ? Status::kWrongLength : Status::kWrongCrc) << named.name;
  }
}

TEST(Protection, MessageOfAnotherSenderIsRejected) {
  for (const Named& named : all_configs()) {
    Config other = named.config;
    other.data_id ^= 1;
    for (std::uint8_t& id : other.data_id_list) id ^= 0x40;
    std::vector<std::uint8_t> data(32, 0x11);
    ASSERT_TRUE(Protector(other).protect(data));
    const bool sent = layout(named.config.profile).data_id_bytes > 0;
    EXPECT_EQ(Checker(named.config).check(data), sent ? Status::kWrongDataId : Status::kWrongCrc) << named.name;
    // The sent nibble differs, the byte in the CRC does not.
    if (named.config.data_id_mode == DataIdMode::kNibble) {
      other = named.config;
      other.data_id ^= 0x100;
      ASSERT_TRUE(Protector(other).protect(data));
      EXPECT_EQ(Checker(named.config).check(data), Status::kWrongDataId) << named.name;
    }
  }
}

TEST(Protection, NothingIsWrittenWhereTheHeaderHasNoRoom) {
  for (const Named& named : all_configs(8)) {
    const std::size_t least = 8 + header_bytes(named.config.profile);
    Protector protector(named.config);
    const std::uint32_t counter = protector.counter();
    for (std::size_t size = 0; size < least; ++size) {
      std::vector<std::uint8_t> data(size, 0xEE);
      EXPECT_FALSE(protector.protect(data)) << named.name << ", " << size;
      EXPECT_EQ(data, std::vector<std::uint8_t>(size, 0xEE)) << named.name;
    }
    EXPECT_EQ(protector.counter(), counter) << named.name;
  }
}

TEST(Protection, LengthFieldOfSixteenBitsIsNotOverrun) {
  for (const Profile profile : {Profile::kP04, Profile::kP06}) {
    Config config;
    config.profile = profile;
    std::vector<std::uint8_t> data(65536, 0);
    EXPECT_FALSE(Protector(config).protect(data));
    EXPECT_EQ(Checker(config).check(data), Status::kWrongLength);
    data.pop_back();
    EXPECT_TRUE(Protector(config).protect(data));
    EXPECT_EQ(Checker(config).check(data), Status::kInitial);
  }
}

TEST(Protection, OffsetBeyondTheAddressSpaceIsAWrongLength) {
  for (const Named& named : all_configs(0xFFFFFFFF)) {
    std::vector<std::uint8_t> data(40, 0);
    EXPECT_EQ(Checker(named.config).check(data), Status::kWrongLength) << named.name;
    EXPECT_FALSE(Protector(named.config).protect(data)) << named.name;
  }
}

TEST(Protection, WithoutAProfileEverythingPassesUnchanged) {
  std::vector<std::uint8_t> data(3, 0x55);
  Checker checker{Config{}};
  Protector protector{Config{}};
  EXPECT_TRUE(protector.protect(data));
  EXPECT_EQ(data, std::vector<std::uint8_t>(3, 0x55));
  EXPECT_EQ(checker.check(data), Status::kOk);
  EXPECT_EQ(checker.check({}), Status::kOk);
  EXPECT_EQ(checker.statistics().received, 2u);
  EXPECT_EQ(checker.statistics().accepted, 2u);
}

TEST(Protection, RandomBytesPassAboutAsOftenAsTheWidthOfTheCrcAllows) {
  for (const Named& named : all_configs()) {
    Checker checker(named.config);
    std::mt19937 generator(11);
    constexpr int kMessages = 20000;
    int sound = 0;
    for (int i = 0; i < kMessages; ++i) {
      std::vector<std::uint8_t> data = random_bytes(generator() % 40, static_cast<std::uint32_t>(i));
      const Status status = checker.check(data);
      sound += status != Status::kWrongCrc && status != Status::kWrongLength;
    }
    const bool short_crc = layout(named.config.profile).crc_bytes == 1;
    EXPECT_LE(sound, short_crc ? 2 * kMessages / 256 : 3) << named.name;
  }
}

}  // namespace
}  // namespace boresight::e2e
