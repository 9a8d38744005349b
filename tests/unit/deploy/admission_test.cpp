// The files that RouDi's clients need, given to the clients' group.
#include "deploy/broker/admission/admission.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace boresight::broker {
namespace {

using std::filesystem::path;

/// RouDi's two folders.
class AdmissionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = ::testing::TempDir() + "admission-XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    places_ = {.shared_memory = folder_ / "shm", .sockets = folder_ / "tmp"};
    std::filesystem::create_directories(places_.shared_memory);
    std::filesystem::create_directories(places_.sockets);
    for (const path& file : {places_.shared_memory / "iceoryx_mgmt", places_.shared_memory / "boresight-tracker",
                             places_.sockets / "roudi", places_.sockets / "roudi.lock"}) {
      std::ofstream(file) << "x";
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static gid_t group_of(const path& file) {
    struct stat status {};
    EXPECT_EQ(lstat(file.c_str(), &status), 0) << file;
    return status.st_gid;
  }

  path folder_;
  supervisor::Places places_;
};

TEST_F(AdmissionTest, GivesTheManagementMemoryAndTheSocketToTheGroupAndNothingElse) {
  if (geteuid() != 0) GTEST_SKIP() << "only root is sure to have a second group";
  const gid_t members = group_number("daemon");
  ASSERT_NE(members, getegid());
  admit(places_, members);
  EXPECT_EQ(group_of(places_.shared_memory / "iceoryx_mgmt"), members);
  EXPECT_EQ(group_of(places_.sockets / "roudi"), members);
  EXPECT_EQ(group_of(places_.shared_memory / "boresight-tracker"), getegid());
  EXPECT_EQ(group_of(places_.sockets / "roudi.lock"), getegid());
}

TEST_F(AdmissionTest, DoesNotFollowALinkToASegment) {
  if (geteuid() != 0) GTEST_SKIP() << "only root is sure to have a second group";
  std::filesystem::remove(places_.sockets / "roudi");
  std::filesystem::create_symlink(places_.shared_memory / "boresight-tracker", places_.sockets / "roudi");
  admit(places_, group_number("daemon"));
  EXPECT_EQ(group_of(places_.shared_memory / "boresight-tracker"), getegid());
}

TEST_F(AdmissionTest, NamesTheFileThatIsMissing) {
  std::filesystem::remove(places_.sockets / "roudi");
  try {
    admit(places_, getegid());
    FAIL();
  } catch (const std::system_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr((places_.sockets / "roudi").string()));
  }
}

TEST_F(AdmissionTest, UnknownGroupIsAnErrorThatNamesIt) {
  EXPECT_THROW(static_cast<void>(group_number("no_such_group")), std::invalid_argument);
}

}  // namespace
}  // namespace boresight::broker
