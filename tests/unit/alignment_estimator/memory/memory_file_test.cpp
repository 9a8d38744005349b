#include "services/alignment_estimator/store/memory_file.hpp"

#include <csignal>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "services/alignment_estimator/store/memory_writer.hpp"
#include "tests/unit/alignment_estimator/memory/example.hpp"

namespace boresight::alignment {
namespace {

namespace fs = std::filesystem;

class MemoryFile : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string write(double mark) const {
    MemoryBytes bytes;
    const std::size_t size = encode_memory(example_memory(4, mark), identity_, bytes);
    return write_memory_file(file_, std::span(bytes.data(), size));
  }
  [[nodiscard]] double mark() const {
    const LoadedMemory loaded = load_memory(file_, identity_);
    EXPECT_EQ(loaded.kind, LoadedMemory::Kind::kTaken) << loaded.reason;
    return loaded.memory.yaw_rate_bias_radps * 1e6;
  }
  void put(const std::string& content) const { std::ofstream(file_, std::ios::binary) << content; }

  const Identity identity_ = identity_of(example_vehicle());
  const fs::path folder_ = fs::path(testing::TempDir()) / ("boresight_memory_" + std::to_string(getpid()));
  const fs::path file_ = folder_ / "memory";
};

TEST_F(MemoryFile, AFirstStartFindsNothing) {
  EXPECT_EQ(load_memory(file_, identity_).kind, LoadedMemory::Kind::kMissing);
  EXPECT_EQ(load_memory(folder_ / "no folder" / "memory", identity_).kind, LoadedMemory::Kind::kMissing);
}

TEST_F(MemoryFile, IsReplacedAsAWhole) {
  ASSERT_EQ(write(1.0), "");
  EXPECT_NEAR(mark(), 1.0, 1e-9);
  ASSERT_EQ(write(2.0), "");
  EXPECT_NEAR(mark(), 2.0, 1e-9);
  EXPECT_FALSE(fs::exists(folder_ / "memory.tmp"));
}

TEST_F(MemoryFile, TheTemporaryFileOfAKilledWriterIsRemovedAndNotRead) {
  ASSERT_EQ(write(1.0), "");
  std::ofstream(folder_ / "memory.tmp") << "half of it";
  EXPECT_NEAR(mark(), 1.0, 1e-9);
  EXPECT_FALSE(fs::exists(folder_ / "memory.tmp"));
  ASSERT_EQ(write(2.0), "") << "the temporary file of a killed writer does no harm";
}

TEST_F(MemoryFile, ARejectedFileIsRenamed) {
  for (const std::string& content : {std::string(), std::string("BORALIGN"), std::string(100'000, 'x')}) {
    put(content);
    const LoadedMemory loaded = load_memory(file_, identity_);
    EXPECT_EQ(loaded.kind, LoadedMemory::Kind::kRejected);
    EXPECT_EQ(loaded.verdict, MemoryVerdict::kCorrupt);
    EXPECT_EQ(loaded.reason, "corrupt");
    EXPECT_FALSE(fs::exists(file_));
    EXPECT_EQ(fs::file_size(folder_ / "memory.rejected"), content.size());
    EXPECT_EQ(load_memory(file_, identity_).kind, LoadedMemory::Kind::kMissing) << "reported once";
  }
}

TEST_F(MemoryFile, AnUnreadableFileStaysInPlace) {
  fs::create_directories(file_);
  const LoadedMemory loaded = load_memory(file_, identity_);
  EXPECT_EQ(loaded.kind, LoadedMemory::Kind::kUnreadable);
  EXPECT_FALSE(loaded.reason.empty());
  EXPECT_TRUE(fs::exists(file_));
}

TEST_F(MemoryFile, AFullMediumKeepsTheOldFile) {
  ASSERT_EQ(write(1.0), "");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string problem = write(2.0);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(problem.find("write: "), std::string::npos) << problem;
  EXPECT_NEAR(mark(), 1.0, 1e-9);
}

TEST_F(MemoryFile, AMissingFolderIsReported) {
  MemoryBytes bytes;
  const std::size_t size = encode_memory(example_memory(), identity_, bytes);
  EXPECT_NE(write_memory_file(folder_ / "none" / "memory", std::span(bytes.data(), size)).find("open: "),
            std::string::npos);
}

TEST_F(MemoryFile, TheWriterTakesOneAtATimeAndTheLastOneWins) {
  {
    MemoryWriter writer(file_, identity_);
    int taken = 0;
    for (int i = 0; i < 2000; ++i) taken += writer.offer(example_memory(4, i)) ? 1 : 0;
    EXPECT_GE(taken, 1);
    EXPECT_EQ(writer.finish(example_memory(4, 5000.0)), "");
    EXPECT_EQ(writer.written(), static_cast<std::uint64_t>(taken) + 1) << "no accepted memory is lost";
    EXPECT_EQ(writer.failed(), 0u);
  }
  EXPECT_NEAR(mark(), 5000.0, 1e-6);
}

TEST_F(MemoryFile, TheWriterCountsFailures) {
  MemoryWriter writer(folder_ / "none" / "memory", identity_);
  EXPECT_NE(writer.finish(example_memory()), "");
  EXPECT_EQ(writer.failed(), 1u);
}

}  // namespace
}  // namespace boresight::alignment
