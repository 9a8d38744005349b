// A process that writes its memory repeatedly is killed at a random time: the next process finds the old or the new
// memory, complete. The test kills the process only; fsync, which protects against a loss of power, is not tested.
#include <atomic>
#include <csignal>
#include <random>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "services/alignment_estimator/store/memory_file.hpp"
#include "services/common/runtime/state_file.hpp"
#include "tests/unit/alignment_estimator/memory/example.hpp"

namespace boresight::alignment {
namespace {

namespace fs = std::filesystem;

/// The writer's progress, in memory that outlives it.
struct Progress {
  std::atomic<int> begun{0};
  std::atomic<int> done{0};
};

[[noreturn]] void write_for_ever(const fs::path& file, const Identity& identity, Progress& progress) {
  MemoryBytes bytes;
  for (int i = progress.begun + 1;; ++i) {
    progress.begun = i;
    const std::size_t size = encode_memory(example_memory(4, i), identity, bytes);
    if (!runtime::write_state_file(file, std::span(bytes.data(), size)).empty()) _exit(3);
    progress.done = i;
  }
}

TEST(MemoryKilled, NeverLosesBothTheOldAndTheNew) {
  constexpr int kKills = 500;
  const fs::path folder = fs::path(testing::TempDir()) / ("boresight_memory_killed_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const fs::path file = folder / "memory";
  const Identity identity = identity_of(example_vehicle());
  void* const shared = mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  Progress& progress = *new (shared) Progress;
  std::mt19937 random(1);
  std::uniform_int_distribution<long> delay_ns(0, 3'000'000);
  int interrupted = 0, leftovers = 0;
  for (int kill_number = 0; kill_number < kKills; ++kill_number) {
    const pid_t writer = fork();
    ASSERT_GE(writer, 0);
    if (writer == 0) write_for_ever(file, identity, progress);
    const timespec wait{0, delay_ns(random)};
    nanosleep(&wait, nullptr);
    ASSERT_EQ(kill(writer, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(waitpid(writer, &status, 0), writer);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself";
    const int begun = progress.begun, done = progress.done;
    if (begun != done) ++interrupted;
    if (fs::exists(folder / "memory.tmp")) ++leftovers;
    const LoadedMemory loaded = load_memory(file, identity);
    if (loaded.kind == LoadedMemory::Kind::kMissing) {
      ASSERT_EQ(done, 0) << "lost";
      continue;
    }
    ASSERT_EQ(loaded.kind, LoadedMemory::Kind::kTaken) << loaded.reason << " after kill " << kill_number;
    const int found = static_cast<int>(std::lround(loaded.memory.yaw_rate_bias_radps * 1e6));
    ASSERT_GE(found, done) << "kill " << kill_number;
    ASSERT_LE(found, begun) << "kill " << kill_number;
    progress.done = found;
  }
  std::printf("%d kills, %d amid a write, %d leftover temporary files; %d memories written\n", kKills, interrupted,
              leftovers, progress.done.load());
  EXPECT_GT(interrupted, kKills / 4) << "too few kills hit a write to prove anything";
  EXPECT_FALSE(fs::exists(folder / "memory.rejected"));
  munmap(shared, sizeof(Progress));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace boresight::alignment
