// Invalid configurations are rejected with the field and its allowed values.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/common/e2e/profile.hpp"
#include "tests/unit/e2e/support.hpp"

namespace boresight::e2e {
namespace {

using test::all_configs;
using test::Named;
using testing::HasSubstr;

TEST(ConfigOfE2e, SoundOnesPass) {
  EXPECT_EQ(validate(Config{}), std::nullopt);
  for (const Named& named : all_configs(kMaxOffsetBytes)) EXPECT_EQ(validate(named.config), std::nullopt) << named.name;
}

TEST(ConfigOfE2e, HeaderBytesOfEveryProfile) {
  EXPECT_EQ(header_bytes(Profile::kNone), 0u);
  EXPECT_EQ(header_bytes(Profile::kP01), 2u);
  EXPECT_EQ(header_bytes(Profile::kP02), 2u);
  EXPECT_EQ(header_bytes(Profile::kP04), 12u);
  EXPECT_EQ(header_bytes(Profile::kP05), 3u);
  EXPECT_EQ(header_bytes(Profile::kP06), 5u);
  EXPECT_EQ(header_bytes(Profile::kP07), 20u);
  EXPECT_EQ(header_bytes(Profile::kP11), 2u);
  EXPECT_EQ(header_bytes(Profile::kP22), 2u);
}

TEST(ConfigOfE2e, DataIdOutOfRange) {
  for (const Profile profile : {Profile::kP01, Profile::kP05, Profile::kP06, Profile::kP11}) {
    Config config;
    config.profile = profile;
    config.data_id = 0xFFFF;
    EXPECT_EQ(validate(config), std::nullopt);
    config.data_id = 0x10000;
    ASSERT_TRUE(validate(config));
    EXPECT_EQ(*validate(config), "data_id is 65536, must be 0 to 65535");
  }
  for (const Profile profile : {Profile::kP01, Profile::kP11}) {
    Config config;
    config.profile = profile;
    config.data_id_mode = DataIdMode::kNibble;
    config.data_id = 0x1000;
    ASSERT_TRUE(validate(config));
    EXPECT_EQ(*validate(config), "data_id is 4096, must be 0 to 4095");
  }
}

TEST(ConfigOfE2e, Profile11KnowsTwoModes) {
  Config config;
  config.profile = Profile::kP11;
  for (const DataIdMode mode : {DataIdMode::kAlternating, DataIdMode::kLow}) {
    config.data_id_mode = mode;
    ASSERT_TRUE(validate(config));
    EXPECT_THAT(*validate(config), HasSubstr("data_id_mode"));
  }
  config.profile = Profile::kP06;  // has no modes
  EXPECT_EQ(validate(config), std::nullopt);
}

TEST(ConfigOfE2e, MaxDeltaCounterOutOfRange) {
  for (const Named& named : all_configs()) {
    Config config = named.config;
    config.max_delta_counter = 0;
    ASSERT_TRUE(validate(config)) << named.name;
    EXPECT_THAT(*validate(config), HasSubstr("max_delta_counter is 0, must be 1 to ")) << named.name;
    const std::uint64_t values = layout(config.profile).counter_values;
    config.max_delta_counter = static_cast<std::uint32_t>(values - 1);
    EXPECT_EQ(validate(config), std::nullopt) << named.name;
    if (values > 0xFFFFFFFF) continue;
    config.max_delta_counter = static_cast<std::uint32_t>(values);
    ASSERT_TRUE(validate(config)) << named.name;
  }
}

TEST(ConfigOfE2e, OffsetOutOfRange) {
  for (const Named& named : all_configs(kMaxOffsetBytes + 1)) {
    ASSERT_TRUE(validate(named.config));
    EXPECT_EQ(*validate(named.config), "offset_bytes is 4097, must be 0 to 4096");
  }
}

TEST(ConfigOfE2e, NumbersThatAreNoProfileOrMode) {
  Config config;
  config.profile = static_cast<Profile>(9);
  ASSERT_TRUE(validate(config));
  EXPECT_THAT(*validate(config), HasSubstr("profile is 9"));
  config.profile = Profile::kP01;
  config.data_id_mode = static_cast<DataIdMode>(4);
  ASSERT_TRUE(validate(config));
  EXPECT_THAT(*validate(config), HasSubstr("data_id_mode is 4"));
}

TEST(ConfigOfE2e, EveryStatusHasItsWords) {
  std::vector<std::string_view> words;
  for (int i = 0; i <= static_cast<int>(Status::kWrongDataId); ++i) {
    const std::string_view text = describe(static_cast<Status>(i));
    EXPECT_EQ(std::count(words.begin(), words.end(), text), 0) << text;
    words.push_back(text);
  }
  EXPECT_EQ(describe(Status::kWrongCrc), "wrong CRC");
  EXPECT_TRUE(is_acceptable(Status::kInitial));
  EXPECT_TRUE(is_acceptable(Status::kOk));
  EXPECT_TRUE(is_acceptable(Status::kOkSomeLost));
  for (const Status status :
       {Status::kRepeated, Status::kWrongSequence, Status::kWrongCrc, Status::kWrongLength, Status::kWrongDataId}) {
    EXPECT_FALSE(is_acceptable(status));
  }
}

}  // namespace
}  // namespace boresight::e2e
