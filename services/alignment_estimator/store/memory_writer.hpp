// Writes memories on a separate thread: fsync may take a second on a worn flash chip, and scans must not wait for it.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <thread>

#include "services/alignment_estimator/store/memory_file.hpp"

namespace boresight::alignment {

/// Call offer() and finish() from one thread, the node's.
class MemoryWriter {
 public:
  /// Starts the thread. It blocks all signals, which the main thread handles.
  MemoryWriter(std::filesystem::path file, const Identity& identity);
  ~MemoryWriter();
  MemoryWriter(const MemoryWriter&) = delete;
  MemoryWriter& operator=(const MemoryWriter&) = delete;

  /// Copies the memory and passes it to the thread by a flag. Returns false and does nothing while the thread still
  /// writes the previous one. Neither blocks nor allocates.
  bool offer(const Memory& memory);
  /// Ends the thread and writes the last memory; returns an empty string, or the failed operation.
  [[nodiscard]] std::string finish(const Memory& memory);

  /// Numbers of written files and failed writes.
  [[nodiscard]] std::uint64_t written() const { return written_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  enum class Order : std::uint8_t { kNone, kWrite, kEnd };
  void run();
  [[nodiscard]] std::string write(const Memory& memory);
  void end();

  std::filesystem::path file_;
  Identity identity_;
  Memory handed_over_;  ///< owned by the node while the order is kNone, otherwise by the thread
  MemoryBytes bytes_;
  std::atomic<Order> order_{Order::kNone};
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> written_{0}, failed_{0};
  std::thread thread_;
};

}  // namespace boresight::alignment
