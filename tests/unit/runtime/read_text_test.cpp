// Whatever a configured path names, reading ends: with the text, or with the file and the reason.
#include "services/common/runtime/config/read_text.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "services/common/runtime/config/reader.hpp"

namespace boresight::config {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ReadTextTest : public ::testing::Test {
 protected:
  ReadTextTest() {
    std::string name = (fs::temp_directory_path() / "boresight_text_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
  }
  ~ReadTextTest() override { fs::remove_all(folder_); }
  static std::string error_of(const fs::path& file) {
    try {
      static_cast<void>(read_text(file));
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(file.string() + ": cannot be read: "));
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(ReadTextTest, RegularFileIsReadWhole) {
  const std::string text = std::string(200'000, 'x') + '\0' + "\r\nend";
  std::ofstream(folder_ / "a.toml", std::ios::binary) << text;
  EXPECT_EQ(read_text(folder_ / "a.toml"), text);
  fs::create_symlink("a.toml", folder_ / "link.toml");
  EXPECT_EQ(read_text(folder_ / "link.toml"), text);
  EXPECT_FALSE(read_text("/proc/self/status").empty()) << "a file that states no size";
}

TEST_F(ReadTextTest, PipeIsRefusedWithoutWaitingForAWriter) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(error_of(folder_ / "pipe"), HasSubstr("it is a pipe; must be a regular file"));
}

TEST_F(ReadTextTest, FoldersSocketsAndDevicesAreRefused) {
  EXPECT_THAT(error_of(folder_), HasSubstr("it is a folder; must be a regular file"));
  EXPECT_THAT(error_of("/dev/zero"), HasSubstr("it is a device; must be a regular file"));
  const int made = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  (folder_ / "socket").string().copy(address.sun_path, sizeof(address.sun_path) - 1);
  ASSERT_EQ(bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  close(made);
  EXPECT_THAT(error_of(folder_ / "socket"), HasSubstr("it is a socket; must be a regular file"));
}

TEST_F(ReadTextTest, FileAboveTheLimitIsRefused) {
  std::ofstream(folder_ / "a.toml") << "x";
  fs::resize_file(folder_ / "a.toml", kMaxConfigurationBytes);
  EXPECT_EQ(read_text(folder_ / "a.toml").size(), kMaxConfigurationBytes);
  fs::resize_file(folder_ / "a.toml", kMaxConfigurationBytes + 1);
  EXPECT_THAT(error_of(folder_ / "a.toml"), HasSubstr("it is larger than 4 MiB"));
  EXPECT_EQ(read_text(folder_ / "a.toml", kMaxDatabaseBytes).size(), kMaxConfigurationBytes + 1);
}

TEST_F(ReadTextTest, AbsentFileAndLoopOfLinksAreNamedWithTheReason) {
  EXPECT_THAT(error_of(folder_ / "absent"), HasSubstr("No such file or directory"));
  fs::create_symlink("loop", folder_ / "loop");
  EXPECT_THAT(error_of(folder_ / "loop"), HasSubstr("symbolic links"));
}

}  // namespace
}  // namespace boresight::config
