#include "services/alignment_estimator/store/memory_file.hpp"

#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "services/common/runtime/state_file.hpp"
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
    return runtime::write_state_file(file_, std::span(bytes.data(), size));
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

}  // namespace
}  // namespace boresight::alignment
