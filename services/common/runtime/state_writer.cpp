#include "services/common/runtime/state_writer.hpp"

#include <algorithm>
#include <csignal>
#include <utility>

#include "services/common/runtime/state_file.hpp"

namespace boresight::runtime {

StateWriter::StateWriter(std::filesystem::path file, std::size_t capacity)
    : file_(std::move(file)), handed_over_(capacity) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  thread_ = std::thread([this] { run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

StateWriter::~StateWriter() {
  end();
}

bool StateWriter::offer(std::span<const std::uint8_t> bytes) {
  if (order_.load() != Order::kNone || bytes.size() > handed_over_.size()) return false;
  std::copy(bytes.begin(), bytes.end(), handed_over_.begin());
  size_ = bytes.size();
  order_.store(Order::kWrite);
  order_.notify_one();
  return true;
}

std::string StateWriter::finish(std::span<const std::uint8_t> bytes) {
  end();
  return write(bytes);
}

void StateWriter::run() {
  while (true) {
    order_.wait(Order::kNone);
    if (order_.load() == Order::kWrite) static_cast<void>(write(std::span(handed_over_).first(size_)));
    // A write ordered just before the end is still done; the end is stored apart from the order.
    order_.store(Order::kNone);
    if (ends_.load()) return;
  }
}

std::string StateWriter::write(std::span<const std::uint8_t> bytes) {
  std::string problem = write_state_file(file_, bytes);
  ++(problem.empty() ? written_ : failed_);
  return problem;
}

void StateWriter::end() {
  if (!thread_.joinable()) return;
  ends_.store(true);
  // Wakes a waiting thread; a writing thread reads `ends_` afterwards.
  Order none = Order::kNone;
  order_.compare_exchange_strong(none, Order::kEnd);
  order_.notify_one();
  thread_.join();
}

}  // namespace boresight::runtime
