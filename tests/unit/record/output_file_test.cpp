// Files that are complete or absent.
#include "services/boresight/terminal/output_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

namespace boresight::terminal {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class OutputFileTest : public ::testing::Test {
 protected:
  OutputFileTest() {
    std::string name = (fs::temp_directory_path() / "boresight_output_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
  }
  ~OutputFileTest() override { fs::remove_all(folder_); }
  [[nodiscard]] std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(folder_), {}); }
  static std::string error_of(const fs::path& file) {
    try {
      write_file(file, "text");
    } catch (const OutputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(OutputFileTest, GetsItsNameWhenItIsComplete) {
  const fs::path file = folder_ / "table.csv";
  OutputFile output(file);
  output.write("one\n");
  output.flush();
  EXPECT_FALSE(fs::exists(file));
  output.write("two\n");
  output.commit();
  EXPECT_EQ(text_of(file), "one\ntwo\n");
  EXPECT_EQ(entries(), 1);
}

TEST_F(OutputFileTest, LeavesTheEarlierFileIfItIsNotCompleted) {
  const fs::path file = folder_ / "table.csv";
  write_file(file, "earlier");
  {
    OutputFile output(file);
    output.write("half");
  }
  EXPECT_EQ(text_of(file), "earlier");
  EXPECT_EQ(entries(), 1);
}

TEST_F(OutputFileTest, ReplacesTheFileBehindALinkAndKeepsItsPermissions) {
  write_file(folder_ / "real", "earlier");
  fs::permissions(folder_ / "real", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real", folder_ / "link");
  write_file(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(text_of(folder_ / "real"), "new");
  EXPECT_EQ(fs::status(folder_ / "real").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(OutputFileTest, ErrorsNameTheFileAndTheCause) {
  EXPECT_EQ(error_of("/dev/full"), "/dev/full: cannot be written: No space left on device");
  EXPECT_EQ(error_of(folder_), folder_.string() + ": cannot be written: Is a directory");
  EXPECT_THAT(error_of(folder_ / "absent/table.csv"), HasSubstr("table.csv: cannot be written: No such file"));
  EXPECT_EQ(entries(), 0);
}

TEST_F(OutputFileTest, FolderGetsItsFilesWhenAllAreComplete) {
  OutputFolder output(folder_ / "deep/er");
  std::ofstream(output.temporary() / "a.csv") << "a";
  EXPECT_FALSE(fs::exists(folder_ / "deep/er/a.csv"));
  EXPECT_EQ(output.with_final_places((output.temporary() / "a.csv").string() + ": full"),
            (folder_ / "deep/er/a.csv").string() + ": full");
  output.commit();
  EXPECT_EQ(text_of(folder_ / "deep/er/a.csv"), "a");
}

TEST_F(OutputFileTest, FolderThatIsNotCompletedLeavesNothing) {
  {
    OutputFolder output(folder_ / "deep/er");
    std::ofstream(output.temporary() / "a.csv") << "a";
  }
  EXPECT_EQ(entries(), 0);
  write_file(folder_ / "a.csv", "earlier");
  {
    OutputFolder output(folder_);
    std::ofstream(output.temporary() / "a.csv") << "new";
  }
  EXPECT_EQ(text_of(folder_ / "a.csv"), "earlier");
  EXPECT_EQ(entries(), 1);
  EXPECT_THROW(OutputFolder("/proc/absent"), OutputError);
}

}  // namespace
}  // namespace boresight::terminal
