#include "services/health/dds/authentication.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace boresight::dds {
namespace {

namespace fs = std::filesystem;

const CommandKey kKey(32, 0x0B);
const Challenge kChallenge{1, 2, 3};

TEST(Authentication, AgreesWithAnIndependentImplementation) {
  // python3: hmac.new(bytes([11] * 32), bytes([1, 2, 3] + [0] * 13) + (7).to_bytes(8, 'big') + (0x5D0278).to_bytes(4,
  // 'big'),
  //                   'sha256').hexdigest()
  const Authentication made = authentication_of(kKey, kChallenge, 7, 0x5D0278);
  std::string hex;
  for (const std::uint8_t byte : made) {
    constexpr const char* kDigits = "0123456789abcdef";
    hex += kDigits[byte >> 4U];
    hex += kDigits[byte & 15U];
  }
  EXPECT_EQ(hex, "2472a8c25845a57d6c00c22f61bb8d61e8ab91c474ed1ec90960e258a71eaaa4");
}

TEST(Authentication, HoldsForOneKeyChallengeNumberAndCodeOnly) {
  const Authentication made = authentication_of(kKey, kChallenge, 7, 0x5D0278);
  EXPECT_TRUE(is_authentic(kKey, kChallenge, 7, 0x5D0278, made));
  EXPECT_FALSE(is_authentic(CommandKey(32, 0x0C), kChallenge, 7, 0x5D0278, made));
  EXPECT_FALSE(is_authentic(kKey, Challenge{1, 2, 4}, 7, 0x5D0278, made));
  EXPECT_FALSE(is_authentic(kKey, kChallenge, 8, 0x5D0278, made));
  EXPECT_FALSE(is_authentic(kKey, kChallenge, 7, 0xFFFFFF, made));
  Authentication changed = made;
  changed.back() ^= 1U;
  EXPECT_FALSE(is_authentic(kKey, kChallenge, 7, 0x5D0278, changed));
}

TEST(Authentication, WithoutAKeyNobodyMayCommand) {
  EXPECT_FALSE(is_authentic({}, kChallenge, 7, 1, authentication_of({}, kChallenge, 7, 1)));
}

TEST(Authentication, ChallengesDiffer) {
  EXPECT_NE(new_challenge(), new_challenge());
}

class KeyFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string problem_with(const fs::path& file) const {
    std::string problem;
    const CommandKey key = read_command_key(file, problem);
    EXPECT_EQ(key.empty(), !problem.empty());
    if (!problem.empty()) {
      EXPECT_NE(problem.find(file.string()), std::string::npos) << problem;
    }
    return problem;
  }
  [[nodiscard]] fs::path made(std::size_t bytes, mode_t mode) const {
    fs::path file = folder_ / "key";
    fs::remove(file);
    std::ofstream(file) << std::string(bytes, 'k');
    chmod(file.c_str(), mode);
    return file;
  }
  const fs::path folder_ = fs::path(testing::TempDir()) / ("boresight_key_" + std::to_string(getpid()));
};

TEST_F(KeyFile, IsRefusedWithItsReasonIfItIsNoSecret) {
  EXPECT_EQ(problem_with(made(32, 0640)), "");
  EXPECT_EQ(problem_with(made(4096, 0600)), "");
  EXPECT_NE(problem_with(made(31, 0600)).find("32 to 4096 are allowed"), std::string::npos);
  EXPECT_NE(problem_with(made(4097, 0600)).find("32 to 4096 are allowed"), std::string::npos);
  EXPECT_NE(problem_with(made(32, 0644)).find("others have access"), std::string::npos);
  EXPECT_NE(problem_with(folder_), "");
  EXPECT_NE(problem_with(folder_ / "absent"), "");
  EXPECT_NE(problem_with("/dev/zero"), "");
  ASSERT_EQ(mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  EXPECT_NE(problem_with(folder_ / "fifo").find("no regular file"), std::string::npos);
}

}  // namespace
}  // namespace boresight::dds
