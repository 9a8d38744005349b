// Writes states to a file on a separate thread: fsync may take a second on a worn flash chip, and scans must not wait
// for it.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace boresight::runtime {

/// Call offer() and finish() from one thread, the node's.
class StateWriter {
 public:
  /// Starts the thread. It blocks all signals, which the main thread handles. `capacity` is the largest state in bytes.
  StateWriter(std::filesystem::path file, std::size_t capacity);
  ~StateWriter();
  StateWriter(const StateWriter&) = delete;
  StateWriter& operator=(const StateWriter&) = delete;

  /// Copies the bytes and passes them to the thread by a flag. Returns false and does nothing while the thread still
  /// writes the previous ones, or if there are too many. Neither blocks nor allocates.
  bool offer(std::span<const std::uint8_t> bytes);
  /// Ends the thread and writes the last state; returns an empty string, or the failed operation.
  [[nodiscard]] std::string finish(std::span<const std::uint8_t> bytes);

  /// Numbers of written files and failed writes.
  [[nodiscard]] std::uint64_t written() const { return written_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  enum class Order : std::uint8_t { kNone, kWrite, kEnd };
  void run();
  std::string write(std::span<const std::uint8_t> bytes);
  void end();

  std::filesystem::path file_;
  std::vector<std::uint8_t> handed_over_;  ///< owned by the node while the order is kNone, otherwise by the thread
  std::size_t size_ = 0;                   ///< of the state in it
  std::atomic<Order> order_{Order::kNone};
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> written_{0}, failed_{0};
  std::thread thread_;
};

}  // namespace boresight::runtime
