// Writes memories on a thread of its own: fsync may take a second on a worn flash chip, and scans do not wait for it.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <thread>

#include "services/alignment_estimator/store/memory_file.hpp"

namespace boresight::alignment {

/// offer() and finish() belong to one thread, the node's.
class MemoryWriter {
 public:
  /// Starts the thread, in which all signals are blocked: they are the main thread's.
  MemoryWriter(std::filesystem::path file, const Identity& identity);
  ~MemoryWriter();
  MemoryWriter(const MemoryWriter&) = delete;
  MemoryWriter& operator=(const MemoryWriter&) = delete;

  /// Copies the memory and leaves the rest to the thread; false, and nothing happens, while it still writes the one
  /// before. Neither blocks nor allocates: a flag hands the copy over.
  bool offer(const Memory& memory);
  /// Ends the thread and writes the last memory itself; empty if it worked, else what failed.
  [[nodiscard]] std::string finish(const Memory& memory);

  /// Files written and writes that failed, so far.
  [[nodiscard]] std::uint64_t written() const { return written_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  enum class Order : std::uint8_t { kNone, kWrite, kEnd };
  void run();
  [[nodiscard]] std::string write(const Memory& memory);
  void end();

  std::filesystem::path file_;
  Identity identity_;
  Memory handed_over_;  ///< the node's while the order is kNone, else the thread's
  MemoryBytes bytes_;
  std::atomic<Order> order_{Order::kNone};
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> written_{0}, failed_{0};
  std::thread thread_;
};

}  // namespace boresight::alignment
