#include "services/common/runtime/state_file.hpp"

#include <array>
#include <csignal>
#include <fstream>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "services/common/runtime/state_writer.hpp"

namespace boresight::runtime {
namespace {

namespace fs = std::filesystem;

class StateFile : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A state of 1000 bytes that begins with `mark`.
  static std::vector<std::uint8_t> example(std::uint8_t mark) {
    std::vector<std::uint8_t> bytes(1000);
    std::iota(bytes.begin(), bytes.end(), mark);
    return bytes;
  }
  [[nodiscard]] std::vector<std::uint8_t> content() const {
    std::vector<std::uint8_t> bytes(2000);
    const StateBytes read = read_state_file(file_, bytes);
    EXPECT_EQ(read.kind, StateBytes::Kind::kRead) << read.reason;
    bytes.resize(read.size);
    return bytes;
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("boresight_state_" + std::to_string(getpid()));
  const fs::path file_ = folder_ / "state";
};

TEST_F(StateFile, IsMissingAtAFirstStart) {
  std::array<std::uint8_t, 10> bytes{};
  EXPECT_EQ(read_state_file(file_, bytes).kind, StateBytes::Kind::kMissing);
  EXPECT_EQ(read_state_file(folder_ / "no folder" / "state", bytes).kind, StateBytes::Kind::kMissing);
}

TEST_F(StateFile, IsReplacedAsAWhole) {
  ASSERT_EQ(write_state_file(file_, example(1)), "");
  ASSERT_EQ(write_state_file(file_, example(2)), "");
  EXPECT_EQ(content(), example(2));
  EXPECT_FALSE(fs::exists(folder_ / "state.tmp"));
}

TEST_F(StateFile, AFileThatIsTooLongFillsTheBuffer) {
  ASSERT_EQ(write_state_file(file_, example(1)), "");
  std::array<std::uint8_t, 10> bytes{};
  EXPECT_EQ(read_state_file(file_, bytes).size, bytes.size());
}

TEST_F(StateFile, FifoFolderDeviceAndLoopAreUnreadableAndDoNotBlock) {
  std::array<std::uint8_t, 10> bytes{};
  ASSERT_EQ(mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  fs::create_directories(folder_ / "folder");
  fs::create_symlink("loop", folder_ / "loop");
  for (const fs::path& file : {folder_ / "fifo", folder_ / "folder", folder_ / "loop", fs::path("/dev/zero")}) {
    const StateBytes read = read_state_file(file, bytes);
    EXPECT_EQ(read.kind, StateBytes::Kind::kUnreadable) << file;
    EXPECT_NE(read.reason, "") << file;
  }
  EXPECT_TRUE(fs::exists(folder_ / "fifo")) << "what cannot be read stays in place";
}

TEST_F(StateFile, WritingReplacesAFifoAndIgnoresWhatAKilledWriterLeft) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((folder_ / "state.tmp").c_str(), 0600), 0);
  ASSERT_EQ(write_state_file(file_, example(3)), "");
  EXPECT_EQ(content(), example(3));
}

TEST_F(StateFile, AFullMediumKeepsTheOldFile) {
  ASSERT_EQ(write_state_file(file_, example(1)), "");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string problem = write_state_file(file_, example(2));
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(problem.find("write: "), std::string::npos) << problem;
  EXPECT_EQ(content(), example(1));
}

TEST_F(StateFile, AMissingFolderIsReported) {
  EXPECT_NE(write_state_file(folder_ / "none" / "state", example(1)).find("open: "), std::string::npos);
}

TEST_F(StateFile, TheWriterTakesOneAtATimeAndTheLastOneWins) {
  {
    StateWriter writer(file_, 1000);
    int taken = 0;
    for (int i = 0; i < 2000; ++i) taken += writer.offer(example(static_cast<std::uint8_t>(i))) ? 1 : 0;
    EXPECT_GE(taken, 1);
    EXPECT_EQ(writer.finish(example(77)), "");
    EXPECT_EQ(writer.written(), static_cast<std::uint64_t>(taken) + 1) << "no accepted state is lost";
    EXPECT_EQ(writer.failed(), 0u);
  }
  EXPECT_EQ(content(), example(77));
}

TEST_F(StateFile, TheWriterRefusesMoreThanItsCapacityAndCountsFailures) {
  StateWriter small(file_, 999);
  EXPECT_FALSE(small.offer(example(1)));
  StateWriter writer(folder_ / "none" / "state", 1000);
  EXPECT_NE(writer.finish(example(1)), "");
  EXPECT_EQ(writer.failed(), 1u);
}

}  // namespace
}  // namespace boresight::runtime
