#include "services/alignment_estimator/store/memory_writer.hpp"

#include <csignal>
#include <utility>

namespace boresight::alignment {

MemoryWriter::MemoryWriter(std::filesystem::path file, const Identity& identity)
    : file_(std::move(file)), identity_(identity) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  thread_ = std::thread([this] { run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

MemoryWriter::~MemoryWriter() {
  end();
}

bool MemoryWriter::offer(const Memory& memory) {
  if (order_.load() != Order::kNone) return false;
  handed_over_ = memory;
  order_.store(Order::kWrite);
  order_.notify_one();
  return true;
}

std::string MemoryWriter::finish(const Memory& memory) {
  end();
  return write(memory);
}

void MemoryWriter::run() {
  while (true) {
    order_.wait(Order::kNone);
    if (order_.load() == Order::kWrite) static_cast<void>(write(handed_over_));
    // A write ordered just before the end is still done; the end is stored apart from the order.
    order_.store(Order::kNone);
    if (ends_.load()) return;
  }
}

std::string MemoryWriter::write(const Memory& memory) {
  const std::size_t size = encode_memory(memory, identity_, bytes_);
  const std::string problem =
      size == 0 ? "not a memory of this vehicle" : write_memory_file(file_, std::span(bytes_.data(), size));
  ++(problem.empty() ? written_ : failed_);
  return problem;
}

void MemoryWriter::end() {
  if (!thread_.joinable()) return;
  ends_.store(true);
  // Wakes a waiting thread; a writing thread reads `ends_` afterwards.
  Order none = Order::kNone;
  order_.compare_exchange_strong(none, Order::kEnd);
  order_.notify_one();
  thread_.join();
}

}  // namespace boresight::alignment
